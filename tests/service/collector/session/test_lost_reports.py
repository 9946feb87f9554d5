"""However reports are lost, the directory tells: every record comes, and the link says what was lost."""

import pytest

from mms import Reason, Report, ReportMember
from service.collector.session.report_subscription import ReportContinuity
from service.storage.states import LinkState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import FAULT_NUMBER, NAME, RECORD_MADE, ScriptedRelay


def gaps(bench: Bench) -> int:
    return bench.repository.link_figures(NAME).report_gaps


def test_a_gap_in_the_relay_s_count_of_records(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.with_settings(poll_period_s=2.0).session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_record("HR_1")
        assert eventually(lambda: bench.is_stored("HR_1"))
        relay.write_record("HR_2", report=False)
        relay.write_record("HR_3")
        assert eventually(lambda: bench.is_stored("HR_2") and bench.is_stored("HR_3"))
        assert eventually(lambda: gaps(bench) == 1)


def test_a_buffer_that_overflowed_while_nobody_listened(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        relay.write_record("HR_1")
        assert eventually(lambda: bench.repository.entry_id(NAME) is not None)
    for number in range(2, 5):
        relay.write_record(f"HR_{number}")
    for _ in range(1500):
        relay.server.update_many({f"{RECORD_MADE}.stVal": False})
        relay.server.update_many({f"{RECORD_MADE}.stVal": True})
    with bench.session():
        assert eventually(lambda: all(bench.is_stored(f"HR_{number}") for number in range(2, 5)))
        assert eventually(lambda: gaps(bench) >= 1)


def test_a_relay_that_restarted_with_a_record_made_meanwhile(bench: Bench) -> None:
    relay = bench.start_relay()
    try:
        with bench.session():
            relay.write_record("HR_1")
            assert eventually(lambda: bench.repository.entry_id(NAME) is not None)
            relay.stop()
            relay.write_file("HR_2.DAT", b"while it was off")
            relay.write_file("HR_2.CFG", b"or before anybody listened")
            relay = bench.start_relay()
            assert eventually(lambda: bench.is_stored("HR_2"))
            assert eventually(lambda: gaps(bench) == 1), "its buffer began anew"
    finally:
        relay.stop()


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


def test_records_that_the_relay_counted_and_never_reported() -> None:
    continuity = ReportContinuity(FAULT_NUMBER)
    assert continuity.missed_before(report(1, made=True, count=4)) is None
    assert continuity.missed_before(report(2, made=True, count=5)) is None
    continuity.begin()
    missed = continuity.missed_before(report(1, made=True, count=9))
    assert missed == "the relay's record 9 came after 5"
    assert continuity.missed_before(report(2, count=0)) is not None, "the relay began anew"
