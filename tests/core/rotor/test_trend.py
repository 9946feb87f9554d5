"""The rotor over many records."""

from dataclasses import replace

from core.rotor.finding import RotorFinding, RotorState
from core.rotor.trend import DatedFinding, LoadBin, RotorCondition, rotor_condition

HEALTHY, WATCH, FAULT, UNSUPPORTED = (
    RotorState.HEALTHY,
    RotorState.WATCH,
    RotorState.FAULT,
    RotorState.UNSUPPORTED,
)


def _finding(state: RotorState, severity_dB: float | None, load_bin: int = 6) -> RotorFinding:
    interval = None if severity_dB is None else (severity_dB - 1.0, severity_dB + 1.0)
    return RotorFinding(
        state=state,
        lower_sideband_dB=None,
        upper_sideband_dB=None,
        severity_dB=severity_dB,
        severity_dB_ci95=interval,
        detection_limit_dB=-60.0,
        slip=0.02,
        load_level=0.1 * load_bin,
        load_bin=load_bin,
        duration_s=10.0,
        load_oscillation_dB=None,
        reasons=(),
    )


def _condition(
    *records: tuple[RotorState, float | None] | tuple[RotorState, float | None, int],
) -> RotorCondition:
    return rotor_condition([DatedFinding(k, _finding(*record)) for k, record in enumerate(records)])


def test_without_a_record_that_could_tell_there_is_no_condition() -> None:
    for condition in (_condition(), _condition((UNSUPPORTED, None), (UNSUPPORTED, -20.0))):
        assert condition.state is UNSUPPORTED
        assert condition.severity_dB is None
        assert condition.since_ns is None


def test_a_single_fault_is_watched_and_a_second_one_believed() -> None:
    healthy = [(HEALTHY, -60.0)] * 4
    one = _condition(*healthy, (FAULT, -30.0))
    assert one.state is WATCH
    assert "not believed" in one.reasons[0]
    two = _condition(*healthy, (FAULT, -30.0), (FAULT, -29.0))
    assert two.state is FAULT
    assert two.severity_dB == -30.0
    assert two.severity_dB_ci95 == (-31.0, -29.0)
    assert two.since_ns == 5


def test_a_load_that_swings_is_told_beside_a_sound_rotor() -> None:
    swinging = replace(_finding(HEALTHY, -60.0), reasons=("load oscillation: the load's torque swings",))
    condition = rotor_condition([DatedFinding(k, swinging) for k in range(3)])
    assert condition.state is HEALTHY
    assert condition.reasons[-1].startswith("load oscillation in 3 of the latest 3 records")


def test_a_record_that_cannot_tell_takes_no_condition_away() -> None:
    faulty = _condition((FAULT, -30.0), (FAULT, -30.0), (UNSUPPORTED, None), (UNSUPPORTED, None))
    assert faulty.state is FAULT
    assert faulty.since_ns == 1


def test_a_rise_against_the_baseline_of_its_load_is_watched_below_all_limits() -> None:
    low, high = [(HEALTHY, -49.0, 3)] * 3, [(HEALTHY, -45.0, 9)] * 3
    steady = _condition(*low, *high, (HEALTHY, -48.0, 3), (HEALTHY, -45.0, 9), (HEALTHY, -44.0, 9))
    assert steady.state is HEALTHY
    assert steady.change_dB == 1.0
    assert steady.bins == (LoadBin(3, 4, -49.0), LoadBin(9, 5, -45.0))
    risen = _condition(*low, *high, (HEALTHY, -44.5, 3), (HEALTHY, -45.0, 9), (HEALTHY, -44.0, 3))
    assert risen.state is WATCH
    assert risen.change_dB == 4.5
    assert "above the baseline" in risen.reasons[0]


def test_noise_far_below_any_cage_is_no_rise() -> None:
    condition = _condition(*[(HEALTHY, -90.0)] * 3, *[(HEALTHY, -60.0)] * 3)
    assert condition.state is HEALTHY
    assert condition.change_dB == 0.0


def test_a_motor_that_is_repaired_is_healthy_again() -> None:
    condition = _condition(*[(FAULT, -30.0)] * 3, *[(HEALTHY, -60.0)] * 3)
    assert condition.state is HEALTHY
    assert condition.since_ns == 5
    assert condition.change_dB == -20.0


def test_the_document_names_the_bins() -> None:
    document = _condition(*[(HEALTHY, -49.0)] * 3).as_dict()
    assert document["bins"] == [{"bin": 6, "records": 3, "baseline_dB": -49.0}]
    assert document["change_dB"] is None
