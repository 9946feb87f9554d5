"""The benchmark of broken rotor bars."""

from benchmarks.rotor.cases import Subject, examined
from core.rotor.finding import RotorState


def test_an_operation_is_recorded_several_times_with_errors_of_its_own() -> None:
    subject = Subject("medium", 0.75, 1, "at 2sf", seed=3, duration_s=2.0)
    first, second = examined(subject, records=2)
    assert first.finding is not None
    assert second.finding is not None
    assert first.finding.state is second.finding.state is RotorState.FAULT
    assert first.finding.slip != second.finding.slip
    assert examined(subject)[0].finding == first.finding
