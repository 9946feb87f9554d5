"""The history and the figures of a link, and how lost reports are told."""

import pytest

from mms import Reason, Report, ReportMember
from service.collector.session.report_continuity import ReportContinuity
from service.storage.states import LinkState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import FAULT_NUMBER, NAME, RECORD_MADE, ScriptedRelay


def changes(bench: Bench) -> list[LinkState]:
    """Oldest first."""
    return [change.state for change in bench.repository.link_changes(NAME, limit=100).items][::-1]


def test_a_link_tells_what_went_over_it(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_record("HR_1", b"x" * 5000)
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert eventually(lambda: bench.repository.link_figures(NAME).received_bytes > 0)
    figures = bench.repository.link_figures(NAME)
    assert figures.received_bytes == 5000 + len(b"configuration of HR_1")
    assert figures.connections == 1
    assert figures.reports >= 1
    assert figures.report_gaps == 0
    assert figures.round_trip_s is not None
    assert 0 < figures.round_trip_s < bench.settings.request_timeout_s


def test_a_link_s_changes_are_kept_with_their_reasons(bench: Bench) -> None:
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.DOWN)
        relay = bench.start_relay()
        assert eventually(lambda: bench.link() is LinkState.UP, within_s=15)
        relay.stop()
        assert eventually(lambda: bench.link() is LinkState.DOWN)
    history = bench.repository.link_changes(NAME, limit=100).items
    assert [state for state in changes(bench) if state is LinkState.UP] == [LinkState.UP]
    assert changes(bench)[0] is changes(bench)[-1] is LinkState.DOWN
    assert all((change.reason is None) == (change.state is LinkState.UP) for change in history)
    assert str(bench.relay.port) in (history[-1].reason or "")


def report(number: int | None, **values: object) -> Report:
    references = {"made": f"{RECORD_MADE}", "count": f"{FAULT_NUMBER}"}
    members = tuple(
        ReportMember(
            index=index,
            reference=references[name].replace(".", "$ST$"),
            value=value if isinstance(value, bool | int) else None,
            reasons=Reason.DATA_CHANGE,
        )
        for index, (name, value) in enumerate(values.items())
    )
    return Report("", "", None, number, None, buffer_overflow=False, data_set=None, members=members)


@pytest.mark.parametrize(
    ("numbers", "gaps"),
    [
        ([7, 8, 9], 0),
        ([7, 7, 8], 0),  # a report in parts
        ([65_534, 65_535, 0, 1], 0),
        ([7, 9, 10], 1),
        ([7, 0], 1),
        ([None, None], 0),
    ],
)
def test_a_gap_in_the_sequence_numbers(numbers: list[int | None], gaps: int) -> None:
    continuity = ReportContinuity(FAULT_NUMBER)
    assert [continuity.missed_before(report(number)) is None for number in numbers].count(False) == gaps


def test_another_connection_may_count_anew() -> None:
    continuity = ReportContinuity(FAULT_NUMBER)
    assert continuity.missed_before(report(40)) is None
    continuity.begin()
    assert continuity.missed_before(report(0)) is None


def test_a_gap_in_the_relay_s_count_of_records() -> None:
    continuity = ReportContinuity(FAULT_NUMBER)
    assert continuity.missed_before(report(1, made=True, count=4)) is None
    assert continuity.missed_before(report(2, made=True, count=5)) is None
    continuity.begin()
    missed = continuity.missed_before(report(1, made=True, count=9))
    assert missed == "the relay's record 9 came after 5"
    assert continuity.missed_before(report(2, count=0)) is not None, "the relay began anew"
