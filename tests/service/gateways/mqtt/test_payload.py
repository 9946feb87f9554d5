"""Payloads of Sparkplug are what Google's protoc reads, and garbled commands do nothing."""

from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.gateways.mqtt.sparkplug.payload import (
    MOST_BYTES,
    DataType,
    Metric,
    PayloadError,
    Quality,
    Value,
    encode,
    is_ordered,
)
from testing.service import sparkplug

REBIRTH = "Node Control/Rebirth"
FIELDS = {
    DataType.INT32: "int_value",
    DataType.INT64: "long_value",
    DataType.DOUBLE: "double_value",
    DataType.BOOLEAN: "boolean_value",
    DataType.STRING: "string_value",
    DataType.DATE_TIME: "long_value",
}
VALUES: dict[DataType, st.SearchStrategy[Value]] = {
    DataType.INT32: st.integers(0, 2**31 - 1),
    DataType.INT64: st.integers(0, 2**63 - 1),
    DataType.DOUBLE: st.floats(allow_nan=False, allow_infinity=False),
    DataType.BOOLEAN: st.booleans(),
    DataType.STRING: st.text(st.characters(exclude_categories=["Cs"])),
    DataType.DATE_TIME: st.integers(0, 2**53),
}
TIMES = st.integers(0, 2**53)


@st.composite
def metrics(draw: st.DrawFn) -> Metric:
    data_type = draw(st.sampled_from(list(VALUES)))
    return Metric(
        draw(st.text(st.characters(exclude_categories=["Cs"]))),
        data_type,
        draw(st.none() | VALUES[data_type]),
        draw(TIMES),
        draw(st.none() | st.sampled_from(Quality)),
    )


@settings(max_examples=60, deadline=None)
@given(st.lists(metrics(), max_size=5), TIMES, st.none() | st.integers(0, 255))
def test_what_is_encoded_is_decoded(told: list[Metric], timestamp_ms: int, sequence: int | None) -> None:
    found = sparkplug.decode(encode(told, timestamp_ms=timestamp_ms, sequence=sequence))
    assert found["timestamp"] == [timestamp_ms]
    assert found.get("seq") == (None if sequence is None else [sequence])
    for metric, fields in zip(told, found.get("metrics", []), strict=True):
        assert fields["name"] == [metric.name]
        assert fields["timestamp"] == [metric.timestamp_ms]
        assert fields["datatype"] == [metric.type]
        assert fields.get("is_null") == ([True] if metric.value is None else None)
        field = FIELDS[metric.type]
        if metric.value is None:
            assert field not in fields
        else:
            assert fields[field] == [metric.value]
        if metric.quality is not None:
            (properties,) = fields["properties"]
            assert properties["keys"] == ["Quality"]
            assert properties["values"] == [{"type": [3], "int_value": [metric.quality]}]


def test_a_double_keeps_all_its_digits() -> None:
    payload = encode([Metric("x", DataType.DOUBLE, 0.1, 0)], timestamp_ms=0, sequence=0)
    assert b"\x9a\x99\x99\x99\x99\x99\xb9\x3f" in payload


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (f'metrics {{ name: "{REBIRTH}" datatype: 11 boolean_value: true }}', True),
        (f'seq: 3 metrics {{ boolean_value: true name: "{REBIRTH}" }} uuid: "x"', True),
        (f'metrics {{ name: "{REBIRTH}" boolean_value: false }}', False),
        (f'metrics {{ name: "{REBIRTH}" }}', False),
        ('metrics { name: "Node Control/Reboot" boolean_value: true }', False),
        (f'metrics {{ name: "x" float_value: 1 }} metrics {{ name: "{REBIRTH}" boolean_value: true }}', True),
        ("", False),
    ],
)
def test_orders(text: str, *, expected: bool) -> None:
    assert is_ordered(sparkplug.encode(text), REBIRTH) is expected


@settings(max_examples=500, deadline=None)
@given(
    st.binary(max_size=400)
    | st.binary(max_size=60).map(lambda end: encode([], timestamp_ms=1, sequence=1) + end)
)
def test_garbled_commands_are_told_as_such(command: bytes) -> None:
    with suppress(PayloadError):
        assert is_ordered(command, REBIRTH) in (True, False)


@pytest.mark.parametrize("command", [b"\x12\xff\xff\xff\xff\x0f", b"\x80" * 40, b"\x0b\x0c", b"\x02\x00"])
def test_lengths_and_numbers_without_end_are_refused(command: bytes) -> None:
    with pytest.raises(PayloadError):
        is_ordered(command, REBIRTH)
    with pytest.raises(PayloadError, match="expected at most"):
        is_ordered(bytes(MOST_BYTES + 1), REBIRTH)
