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
    with pytest.raises(RecordingError, match=r"record.cfg: current of phase b, c: .* found 'IA' \[A\]"):
        terminals(recording((CURRENTS[:1], I_ABC[:1])))
    with pytest.raises(RecordingError, match=r"voltages: expected three phase voltages.*'VA'"):
        terminals(recording((CURRENTS, I_ABC), (PHASE_VOLTAGES[:2], V_ABC[:2])))
    with pytest.raises(RecordingError, match="channel 'IX': expected exactly one"):
        terminals(recording((CURRENTS, I_ABC)), currents=("IX", "IB", "IC"))
    with pytest.raises(RecordingError, match="phase voltage in V, found unit 'A'"):
        terminals(recording((CURRENTS, I_ABC)), phase_voltages=("IA", "IB", "IC"))


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
