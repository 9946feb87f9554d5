from dataclasses import replace

import numpy as np
import pytest

from core.recordings import Channel, Quantity, Recording, RecordingError
from core.signals import clarke, terminals
from tests.core.signals.waveforms import three_phase

CURRENTS = [Channel(f"I{p.upper()}", Quantity.CURRENT, p, "A") for p in "abc"]
PHASE_VOLTAGES = [Channel(f"V{p.upper()}", Quantity.PHASE_VOLTAGE, p, "V") for p in "abc"]
LINE_VOLTAGES = [Channel(f"V{p.upper()}", Quantity.LINE_VOLTAGE, p, "V") for p in ("ab", "bc", "ca")]
I_ABC = three_phase(10, 1)
V_ABC = three_phase(230, 5)
V_LINE = V_ABC - np.roll(V_ABC, -1, axis=0)


def recording(*parts: tuple[list[Channel], np.ndarray]) -> Recording:
    return Recording(
        samples=np.concatenate([samples for _, samples in parts]),
        sample_rate_hz=10_000,
        start_time_ns=0,
        channels=tuple(channel for channels, _ in parts for channel in channels),
        source="record.cfg",
    )


def test_phases_are_found_wherever_they_stand() -> None:
    shuffled = [2, 0, 1]
    found = terminals(
        recording(
            (LINE_VOLTAGES, V_LINE),
            ([CURRENTS[k] for k in shuffled], I_ABC[shuffled]),
            ([Channel("Speed", Quantity.OTHER, None, "rpm")], np.ones((1, 5_000))),
            ([PHASE_VOLTAGES[k] for k in shuffled], V_ABC[shuffled]),
        )
    )
    np.testing.assert_array_equal(found.current_abc, I_ABC)
    assert found.voltage_ab == pytest.approx(clarke(V_ABC))
    assert [c.name for c in found.current_channels] == ["IA", "IB", "IC"]
    assert [c.name for c in found.voltage_channels] == ["VA", "VB", "VC"]
    assert found.sample_rate_hz == 10_000


@pytest.mark.parametrize("kept", [[0, 1, 2], [0, 1], [1, 2], [2, 0]])
def test_two_line_voltages_are_as_good_as_three(kept: list[int]) -> None:
    found = terminals(recording((CURRENTS, I_ABC), ([LINE_VOLTAGES[k] for k in kept], V_LINE[kept])))
    assert found.voltage_ab == pytest.approx(clarke(V_ABC))
    assert len(found.voltage_channels) == len(kept)


def test_currents_alone_are_a_recording_too() -> None:
    found = terminals(recording((CURRENTS, I_ABC)))
    assert found.voltage_ab is None
    assert found.voltage_channels == ()


def test_names_choose_among_several_motors() -> None:
    other = [Channel(f"M2_{c.name}", c.quantity, c.phase, c.unit) for c in CURRENTS]
    unnamed = [Channel(f"U{k}", Quantity.OTHER, None, "V") for k in range(3)]
    record = recording((CURRENTS, I_ABC), (other, 2 * I_ABC), (unnamed, V_LINE))
    with pytest.raises(RecordingError, match="'IA' \\[A\\], 'M2_IA' \\[A\\]"):
        terminals(record)
    found = terminals(record, currents=("M2_IA", "M2_IB", "M2_IC"), line_voltages=("U0", "U1", "U2"))
    np.testing.assert_array_equal(found.current_abc, 2 * I_ABC)
    assert found.voltage_ab == pytest.approx(clarke(V_ABC))


def test_named_phase_voltages_are_taken() -> None:
    unnamed = [Channel(f"U{k}", Quantity.OTHER, None, "V") for k in range(3)]
    found = terminals(recording((CURRENTS, I_ABC), (unnamed, V_ABC)), phase_voltages=("U0", "U1", "U2"))
    assert found.voltage_ab == pytest.approx(clarke(V_ABC))


def test_what_is_missing_is_named() -> None:
    with pytest.raises(RecordingError, match=r"current of phase b, c: .* found 'IA' \[A\]: phase a$"):
        terminals(recording((CURRENTS[:1], I_ABC[:1])))
    with pytest.raises(
        RecordingError, match=r"voltages: expected three phase voltages.*'VA' \[V\]: phase a;"
    ):
        terminals(recording((CURRENTS, I_ABC), (PHASE_VOLTAGES[:2], V_ABC[:2])))
    with pytest.raises(RecordingError, match="channel 'IX': expected exactly one"):
        terminals(recording((CURRENTS, I_ABC)), currents=("IX", "IB", "IC"))
    with pytest.raises(RecordingError, match="phase voltage in V, found unit 'A'"):
        terminals(recording((CURRENTS, I_ABC)), phase_voltages=("IA", "IB", "IC"))


def test_a_refusal_lists_every_channel_with_the_reason() -> None:
    others = [
        Channel("IA RMS", Quantity.OTHER, None, "A"),
        Channel("Input 7", Quantity.CURRENT, None, "A"),
        Channel("SPARE", Quantity.CURRENT, "b", "A", is_constant=True),
        Channel("IN", Quantity.CURRENT, "n", "A"),
        Channel("Speed", Quantity.OTHER, None, "rpm"),
    ]
    with pytest.raises(RecordingError) as refused:
        terminals(recording((others, np.ones((5, 100))), (PHASE_VOLTAGES, V_ABC[:, :100])))
    assert refused.value.found == (
        "'IA RMS' [A]: computed, by its name; "
        "'Input 7' [A]: no phase in its name and phase field, or two that contradict each other; "
        "'SPARE' [A]: constant; 'IN' [A]: of the neutral; 'Speed' [rpm]: not in A; "
        "'VA' [V]: not in A; 'VB' [V]: not in A; 'VC' [V]: not in A"
    )
    many = [Channel(f"X{k}", Quantity.OTHER, None, "") for k in range(60)]
    with pytest.raises(RecordingError, match=r"'X39' .*; and 20 more$"):
        terminals(recording((many, np.ones((60, 100)))))


@pytest.mark.parametrize("missing", [0, 1, 2])
@pytest.mark.parametrize("beside", [None, "IG", "3I0", "I_RES", "GROUND"])
def test_of_two_current_transformers_the_third_current_is_minus_their_sum(
    missing: int, beside: str | None
) -> None:
    kept = [k for k in range(3) if k != missing]
    parts = [([CURRENTS[k] for k in kept], I_ABC[kept])]
    if beside is not None:
        parts.append(([Channel(beside, Quantity.CURRENT, None, "A")], I_ABC[:1]))
    found = terminals(recording(*parts))
    np.testing.assert_allclose(found.current_abc, I_ABC, atol=1e-12)
    assert found.computed_current == "abc"[missing]
    assert found.current_channels[missing].name == "-(" + " + ".join(CURRENTS[k].name for k in kept) + ")"
    assert terminals(recording((CURRENTS, I_ABC))).computed_current is None


def test_two_currents_beside_one_of_unknown_phase_are_refused() -> None:
    unknown = Channel("Input 3", Quantity.CURRENT, None, "A")
    with pytest.raises(RecordingError, match=r"current of phase c.*'Input 3' \[A\]: no phase"):
        terminals(recording(([*CURRENTS[:2], unknown], I_ABC)))


@pytest.mark.parametrize("count", [2, 3])
def test_line_voltages_the_other_way_round_count_with_their_sign(count: int) -> None:
    turned = [Channel(f"V{p.upper()}", Quantity.LINE_VOLTAGE, p, "V") for p in ("ab", "cb", "ac")]
    signs = np.array([[1.0], [-1.0], [-1.0]])
    record = recording((CURRENTS, I_ABC), (turned[:count], (signs * V_LINE)[:count]))
    assert terminals(record).voltage_ab == pytest.approx(clarke(V_ABC))
    np.testing.assert_array_equal(terminals(record).voltages, V_LINE[:count])
    if count == 3:
        assert terminals(record, line_voltages=("VAB", "VCB", "VAC")).voltage_ab == pytest.approx(
            clarke(V_ABC)
        )


def test_currents_inside_the_delta_become_those_of_the_lines() -> None:
    circling = 0.3 * np.ones((3, 1)) * I_ABC[:1]
    windings = (I_ABC - np.roll(I_ABC, -1, axis=0)) / 3.0
    found = terminals(recording((CURRENTS, windings + circling)), inside_delta=True)
    np.testing.assert_allclose(found.current_abc, I_ABC - I_ABC.mean(axis=0), atol=1e-12)
    with pytest.raises(RecordingError, match="all three windings, as the transformers are inside the delta"):
        terminals(recording((CURRENTS[:2], windings[:2])), inside_delta=True)


def test_the_motors_ratios_replace_those_of_the_recording() -> None:
    """Samples of a file that says S 10:1 are ten times what is written; of one that says P, just that."""
    said = [replace(c, full_scale=50.0, transformer_ratio=10.0, applied_ratio=10.0) for c in CURRENTS]
    record = recording((said, I_ABC), (PHASE_VOLTAGES, V_ABC))
    plain = terminals(record)
    found = terminals(record, voltage_ratio=30.0, current_ratio=80.0)
    np.testing.assert_allclose(found.current_abc, 8.0 * plain.current_abc)
    np.testing.assert_allclose(found.voltages, 30.0 * plain.voltages)
    assert [c.full_scale for c in found.current_channels] == pytest.approx([400.0] * 3)
    assert {c.transformer_ratio for c in found.voltage_channels} == {30.0}
    primary_already = terminals(record, current_ratio=1.0)
    np.testing.assert_allclose(primary_already.current_abc, 0.1 * plain.current_abc)
    np.testing.assert_array_equal(primary_already.voltages, plain.voltages)


def test_a_constant_channel_measures_nothing() -> None:
    spare = replace(CURRENTS[0], name="IA spare", is_constant=True)
    record = recording((CURRENTS, I_ABC), ([spare], 0.0 * I_ABC[:1]))
    np.testing.assert_array_equal(terminals(record).current_abc, I_ABC)
    with pytest.raises(RecordingError, match="channel 'IA spare': expected a channel that was sampled"):
        terminals(record, currents=("IA spare", "IB", "IC"))
