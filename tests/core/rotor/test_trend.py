"""The rotor over a few records; the tests of the storage have it over many."""

from core.rotor.finding import RotorState
from core.rotor.trend import JudgedRecord, LoadBin, RotorCondition, baseline_dB, rotor_condition, state_after

HEALTHY, WATCH, FAULT = RotorState.HEALTHY, RotorState.WATCH, RotorState.FAULT


def _record(
    state: RotorState, severity_dB: float, baseline_dB: float | None = None, *, load_swings: bool = False
) -> JudgedRecord:
    return JudgedRecord(state, severity_dB, (severity_dB - 1.0, severity_dB + 1.0), baseline_dB, load_swings)


def _condition(*latest: JudgedRecord) -> RotorCondition:
    return rotor_condition(latest, 7, [LoadBin(6, 3, -49.0)])


def test_without_a_record_that_could_tell_there_is_no_condition() -> None:
    condition = rotor_condition([], None, [])
    assert condition.state is state_after([]) is RotorState.UNSUPPORTED
    assert condition.severity_dB is None
    assert condition.since_ns is None


def test_a_single_fault_is_watched_and_a_second_one_believed() -> None:
    sound = _record(HEALTHY, -60.0)
    one = _condition(sound, sound, _record(FAULT, -30.0))
    assert one.state is WATCH
    assert "not believed" in one.reasons[0]
    two = _condition(sound, _record(FAULT, -30.0), _record(FAULT, -29.0))
    assert two.state is FAULT
    assert two.severity_dB == -30.0
    assert two.severity_dB_ci95 == (-31.0, -29.0)
    assert two.since_ns == 7


def test_a_single_watch_is_no_condition_and_a_second_one_is() -> None:
    sound, uneven = _record(HEALTHY, -60.0), _record(WATCH, -40.0)
    assert state_after([sound, uneven, sound]) is HEALTHY
    assert state_after([uneven, sound, uneven]) is WATCH


def test_a_load_that_swings_is_told_beside_a_sound_rotor() -> None:
    condition = _condition(*[_record(HEALTHY, -60.0, load_swings=True)] * 3)
    assert condition.state is HEALTHY
    assert condition.reasons[-1].startswith("load oscillation in 3 of the latest 3 records")


def test_a_rise_against_the_baseline_of_its_load_is_watched_below_all_limits() -> None:
    steady = _condition(_record(HEALTHY, -48.0, -49.0), _record(HEALTHY, -45.0, -45.0))
    assert steady.state is HEALTHY
    assert steady.change_dB == 0.5
    risen = [_record(HEALTHY, -44.5, -49.0), _record(HEALTHY, -45.0, -45.0), _record(HEALTHY, -44.0, -49.0)]
    condition = _condition(*risen)
    assert condition.state is WATCH
    assert condition.change_dB == 4.5
    assert "above the baseline" in condition.reasons[0]


def test_noise_far_below_any_cage_is_no_rise() -> None:
    baseline = baseline_dB([-90.0, -80.0, -70.0])
    assert baseline == -50.0
    condition = _condition(*[_record(HEALTHY, -60.0, baseline)] * 3)
    assert condition.state is HEALTHY
    assert condition.change_dB == 0.0


def test_a_baseline_is_the_median_of_the_first_three_records() -> None:
    assert baseline_dB([-40.0, -45.0]) is None
    assert baseline_dB([-40.0, -45.0, -41.0, -10.0]) == -41.0


def test_the_document_names_the_bins() -> None:
    document = _condition(_record(HEALTHY, -49.0)).as_dict()
    assert document["bins"] == [{"bin": 6, "records": 3, "baseline_dB": -49.0}]
    assert document["change_dB"] is None
