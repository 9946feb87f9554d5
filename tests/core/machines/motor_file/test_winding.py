"""The table [winding]: how a stator is wound, read, refused where it cannot be, and written again."""

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import motor_from_table, plate_from_table, read_motor, read_plate
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import Motor
from core.machines.stator_winding import StatorWinding, WindingError, WindingKind, check_winding
from testing.machines.motors import REFERENCE
from testing.machines.plausible_motors import plausible_motors

PLATE = """
[nameplate]
rated_power_W = 7500
rated_voltage_V = 400
rated_frequency_Hz = 50
pole_pairs = 2
"""
KEYS = ("kind", "slots", "layers", "coil_pitch_slots")
LAP = 'kind = "lap"\n'
JUNK = st.one_of(
    st.booleans(),
    st.text(max_size=8),
    st.integers(-(10**20), 10**20),
    st.floats(),
    st.lists(st.integers(), max_size=3),
    st.dictionaries(st.text(max_size=3), st.integers(), max_size=2),
)


def winding_of(text: str) -> StatorWinding | None:
    table = tomllib.loads(f"{PLATE}[winding]\n{text}")
    return motor_from_table(table, name="M1", source="M1.toml").winding


def test_a_file_without_the_table_does_not_tell_the_winding() -> None:
    table = tomllib.loads(PLATE)
    assert motor_from_table(table, name="M1", source="M1.toml").winding is None
    assert plate_from_table(table, name="M1", source="M1.toml").winding is None
    assert winding_of("") is None


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (LAP + "slots = 36", StatorWinding(WindingKind.LAP, 36, 2)),
        (LAP + "slots = 36\nlayers = 2\ncoil_pitch_slots = 8", StatorWinding(WindingKind.LAP, 36, 2, 8)),
        ('kind = "concentric"\nslots = 24\nlayers = 1', StatorWinding(WindingKind.CONCENTRIC, 24, 1)),
        (LAP + "slots = 30", StatorWinding(WindingKind.LAP, 30, 2)),
    ],
)
def test_it_is_read(text: str, expected: StatorWinding) -> None:
    assert winding_of(text) == expected


@pytest.mark.parametrize(
    ("text", "field", "words"),
    [
        ("slots = 36", "kind", '"lap" or "concentric"'),
        ('kind = "wave"\nslots = 36', "kind", '"lap" or "concentric"'),
        (LAP, "slots", "a whole number of 1 to 1000"),
        (LAP + "slots = 36.0", "slots", "a whole number"),
        (LAP + "slots = 35", "slots", "a multiple of 3"),
        (LAP + "slots = 6", "slots", "at least 12 for 4 poles"),
        (LAP + "slots = 27\nlayers = 1", "slots", "a multiple of 6 in a winding of one layer, or layers = 2"),
        (LAP + "slots = 36\nlayers = 3", "layers", "a whole number of 1 to 2"),
        (LAP + "slots = 36\ncoil_pitch_slots = 20", "coil_pitch_slots", "1 to 18 slots"),
        (LAP + "slots = 36\ncoil_pitch_slots = true", "coil_pitch_slots", "a whole number"),
        (LAP + "slots = 36\npitch = 8", "pitch", "one of coil_pitch_slots, kind, layers, slots"),
        (LAP + "slot = 36", "slot", "one of coil_pitch_slots"),
    ],
)
def test_what_cannot_be_wound_is_refused(text: str, field: str, words: str) -> None:
    with pytest.raises(MotorFileError) as refused:
        winding_of(text)
    assert refused.value.field == f"[winding] {field}"
    assert words in refused.value.expected
    assert "M1.toml" in str(refused.value)
    assert refused.value.others == ()


def test_a_winding_that_three_phases_cannot_share_names_the_pole_pairs() -> None:
    text = PLATE.replace("pole_pairs = 2", "pole_pairs = 3") + "[winding]\n" + LAP + "slots = 30"
    with pytest.raises(MotorFileError, match=r"\[winding\] slots: .* such as 18 or 36; is pole_pairs right"):
        motor_from_table(tomllib.loads(text), name="M1", source="M1.toml")


def test_slots_are_not_compared_with_pole_pairs_that_were_refused() -> None:
    text = PLATE.replace("pole_pairs = 2", "pole_pairs = 1000") + "[winding]\n" + LAP + "slots = 35"
    with pytest.raises(MotorFileError) as refused:
        motor_from_table(tomllib.loads(text), name="M1", source="M1.toml")
    assert [one.field for one in (refused.value, *refused.value.others)] == ["[nameplate] pole_pairs"]


def test_a_table_that_is_none_is_refused() -> None:
    with pytest.raises(MotorFileError, match=r"\[winding\]: expected a table, found str"):
        motor_from_table(tomllib.loads("winding = 'lap'\n" + PLATE), name="M1", source="M1.toml")


@given(junk=st.dictionaries(st.sampled_from(KEYS), JUNK, min_size=1))
def test_junk_is_refused_and_names_a_field(junk: dict[str, object]) -> None:
    table = {**tomllib.loads(PLATE), "winding": junk}
    try:
        winding = motor_from_table(table, name="M1", source="M1.toml").winding
    except MotorFileError as error:
        for one in (error, *error.others):
            assert one.field.removeprefix("[winding] ") in KEYS
            assert len(str(one)) < 300
    else:
        assert winding is not None
        assert {"kind": winding.kind, "slots": winding.slots}.items() <= junk.items()


@st.composite
def motors_with_a_winding(draw: st.DrawFn) -> Motor:
    """Motors of any rating with any winding that they can have."""
    motor = draw(plausible_motors())
    pole_pairs = motor.nameplate.pole_pairs
    slots = 3 * draw(st.integers(2 * pole_pairs, min(40 * pole_pairs, 333)))
    layers = draw(st.sampled_from([1, 2]))
    pitch = draw(st.one_of(st.none(), st.integers(1, slots // pole_pairs)))
    winding = StatorWinding(draw(st.sampled_from(WindingKind)), slots, layers, pitch)
    try:
        check_winding(winding, pole_pairs)
    except WindingError:
        winding = StatorWinding(winding.kind, 6 * pole_pairs, layers)
    return replace(motor, winding=winding)


@given(motor=motors_with_a_winding())
def test_what_is_written_is_read_again(tmp_path_factory: pytest.TempPathFactory, motor: Motor) -> None:
    path = write_motor(tmp_path_factory.mktemp("motor") / "PUMP-7.toml", motor)
    assert read_motor(path).winding == read_plate(path).winding == motor.winding


def test_an_unknown_winding_is_not_written(tmp_path: Path) -> None:
    assert "[winding]" not in write_motor(tmp_path / "M1.toml", REFERENCE).read_text("utf-8")
