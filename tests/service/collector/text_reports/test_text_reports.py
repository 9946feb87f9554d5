"""Text reports among a relay's files: fetched over real MMS and kept, and relays that do harm with them."""

import time
from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from core.relay_reports.clock_times import DateOrder
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from ied_sim.motor.contactor import Contactor
from mms import FileAnswer, FileOperation, FileRequest
from service.plant.overrides import Overrides
from service.storage.states import LinkState, RelayEventKind, StartSource
from testing.relays.simulated import scenario_of, simulated
from testing.service.plants import motor
from testing.waiting import eventually
from tests.core.relay_reports.examples import MOT, MSR, SER
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.expectations import at, overriding
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

WRITTEN = datetime(2026, 3, 29, tzinfo=UTC)
"""The day of the examples."""
LONG_S = 90
"""For a motor that is simulated as it starts, on a busy machine."""


@pytest.fixture
def reading(bench: Bench) -> Bench:
    """The bench with a session that looks for reports all the time."""
    here = overriding(bench, Overrides(report_date_order=DateOrder.MDY))
    return replace(here, reported=motor(MOTOR)).with_settings(text_report_period_s=0.3)


def of_today(report: str, date_format: str = "%m/%d/%Y") -> str:
    """An example with the dates of today and yesterday in place of its own."""
    today = datetime.now(tz=UTC)
    for back in (0, 1):
        then, now = WRITTEN - timedelta(days=back), today - timedelta(days=back)
        report = report.replace(f"{then:%m/%d/%Y}", now.strftime(date_format))
    return report.replace("03/01/2026", (today - timedelta(days=28)).strftime(date_format))


def offer(relay: ScriptedRelay, name: str, text: str | bytes) -> None:
    """Put a report among the relay's files at once, as a whole."""
    folder = relay.root / "REPORTS"
    folder.mkdir(exist_ok=True)
    content = text.encode("latin-1") if isinstance(text, str) else text
    (relay.root / "new").write_bytes(content)
    (relay.root / "new").replace(folder / name)


def used(bench: Bench) -> Mapping[str, object]:
    findings = bench.repository.relay_findings(NAME)
    return {} if findings is None else findings.acquisition


def remarks(bench: Bench) -> str:
    found = used(bench).get("remarks", [])
    assert isinstance(found, list)
    return "\n".join(found)


def events(bench: Bench) -> list[RelayEventKind]:
    return [event.kind for event in bench.repository.relay_event_page(MOTOR, limit=50).items]


def reported_starts(bench: Bench) -> int:
    starts = bench.repository.starts(motor=MOTOR, limit=50).items
    return sum(start.source is StartSource.REPORT for start in starts)


@pytest.mark.timeout(4 * LONG_S)
def test_what_a_simulated_relay_reports_of_a_start_is_kept(reading: Bench, tmp_path: Path) -> None:
    scenario = scenario_of("sel-710-ed2")
    scenario = replace(scenario, plant=replace(scenario.plant, contactor=Contactor(open_at_first=True)))
    with simulated(tmp_path / "relays", scenario) as served:
        here = at(reading, served)
        with here.session():
            assert eventually(lambda: "MSR" in str(used(here).get("text_reports")), LONG_S)
            with served.client() as client:
                client.operate(served.reference("CON/RBGGIO1.SPCSO03"), value=True)
            assert eventually(lambda: reported_starts(here) == 1, LONG_S)
            assert eventually(lambda: RelayEventKind.START in events(here), LONG_S)
            assert eventually(lambda: here.repository.latest_relay_statistics(MOTOR) is not None, LONG_S)
    assert used(here)["text_reports"] == ["CSER", "CLDP", "MSR", "MOT"]
    assert "is not read" not in remarks(here)
    statistics = here.repository.latest_relay_statistics(MOTOR)
    assert statistics is not None
    assert abs(statistics.time_ns - time.time_ns()) < NANOSECONDS_PER_DAY
    assert here.link() is LinkState.UP
    [start] = here.repository.starts(motor=MOTOR, limit=5).items
    assert abs(start.time_ns - time.time_ns()) < 600 * NANOSECONDS_PER_SECOND


def test_reports_are_fetched_again_and_kept_once(reading: Bench, relay: ScriptedRelay) -> None:
    offer(relay, "SER.TXT", of_today(SER))
    offer(relay, "MSR.TXT", of_today(MSR))
    with reading.session():
        assert eventually(lambda: reported_starts(reading) == 1)
        assert eventually(lambda: events(reading) == [RelayEventKind.START])
        opened = relay.opened
        later = of_today(SER).replace("STARTING    Deasserted", "TRIP        Asserted")
        offer(relay, "SER.TXT", later)
        assert eventually(lambda: RelayEventKind.TRIP in events(reading))
    assert relay.opened > opened
    assert sorted(events(reading)) == [RelayEventKind.START, RelayEventKind.TRIP]
    assert reported_starts(reading) == 1


def test_the_order_of_dates_is_that_in_which_the_heading_shows_the_present(
    reading: Bench, relay: ScriptedRelay
) -> None:
    here = overriding(reading, Overrides())
    offer(relay, "MSR.TXT", of_today(MSR, "%Y-%m-%d"))
    with here.session():
        assert eventually(lambda: reported_starts(here) == 1)


def test_a_report_of_another_time_is_refused_with_the_reason(reading: Bench, relay: ScriptedRelay) -> None:
    offer(relay, "MOT.TXT", MOT)
    with reading.session():
        assert eventually(
            lambda: "expected the relay's clock within a day of the present" in remarks(reading)
        )
    assert reading.repository.latest_relay_statistics(MOTOR) is None


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (of_today(MSR).replace("8.62 A", "much"), "MSR is not read: line "),
        (b"\x00\xff" * 1000, "MSR is not read: "),
        (b"x" * (3 << 20), "MSR is not read: expected at most 2097152 bytes, found 3145728"),
        (b"", "MSR is not read: "),
    ],
    ids=["a word for a figure", "no text", "too long", "empty"],
)
def test_a_report_that_cannot_be_read_costs_no_record(
    reading: Bench, relay: ScriptedRelay, text: str | bytes, reason: str
) -> None:
    offer(relay, "MSR.TXT", text)
    relay.write_record("HR_1")
    with reading.session():
        assert eventually(lambda: reading.is_stored("HR_1"))
        assert eventually(lambda: reason in remarks(reading))
        relay.write_record("HR_2")
        assert eventually(lambda: reading.is_stored("HR_2"))
        offer(relay, "MSR.TXT", of_today(MSR))
        assert eventually(lambda: reported_starts(reading) == 1)
        assert eventually(lambda: remarks(reading) == "")
    assert reading.link() is LinkState.UP


def test_only_reports_are_asked_for_by_their_names(reading: Bench, relay: ScriptedRelay) -> None:
    asked: list[str] = []

    def listen(request: FileRequest) -> FileAnswer | None:
        if request.operation is FileOperation.OPEN:
            asked.append(request.name)
        return None

    relay.on_file_request = listen
    for name in ("HISTORY.TXT", "MSR.EXE", "MSR.TXT.BAK", "XMSR.TXT", "SER.TXT"):
        offer(relay, name, of_today(SER))
    with reading.session():
        assert eventually(lambda: events(reading) == [RelayEventKind.START])
        offer(relay, "SER.TXT", of_today(SER).replace("STARTING    Deasserted", "TRIP        Asserted"))
        assert eventually(lambda: RelayEventKind.TRIP in events(reading))
    assert used(reading)["text_reports"] == ["SER"]
    assert {name.rpartition("/")[2] for name in asked} == {"SER.TXT"}


def test_a_relay_whose_reports_end_the_visit_still_has_its_records_fetched(
    reading: Bench, relay: ScriptedRelay
) -> None:
    reading.with_settings(text_report_period_s=1.0)
    relay.stuck.add("MSR")
    offer(relay, "MSR.TXT", of_today(MSR))
    with reading.session():
        assert eventually(lambda: reading.link() is LinkState.DOWN, 60), "it answers nobody for a while"
        relay.write_record("HR_1")
        assert eventually(lambda: reading.is_stored("HR_1"), 60)


def test_nothing_is_fetched_where_nobody_wants_it(reading: Bench, relay: ScriptedRelay) -> None:
    offer(relay, "MSR.TXT", of_today(MSR))
    relay.write_record("HR_1")
    for here in (
        replace(reading, settings=reading.settings.model_copy(update={"text_report_period_s": 0.0})),
        overriding(reading, Overrides(reports_directory="none")),
    ):
        with here.session():
            assert eventually(lambda: reading.is_stored("HR_1"))
            assert eventually(lambda: bool(used(reading)))
    assert used(reading)["text_reports"] == []
    assert reported_starts(reading) == 0


def test_a_relay_that_has_sent_enough_today_is_not_asked(reading: Bench, relay: ScriptedRelay) -> None:
    reading.with_settings(max_relay_bytes_per_day=1)
    relay.write_record("HR_1")
    with reading.session():
        assert eventually(lambda: reading.is_stored("HR_1"))
        offer(relay, "MSR.TXT", of_today(MSR))
        assert eventually(lambda: "as much as it may in a day" in remarks(reading))
    assert reported_starts(reading) == 0
