"""Reports of a whole plant: what they say, in both formats, the same each time, whatever names it has."""

import hashlib
from dataclasses import replace
from pathlib import Path
from threading import BoundedSemaphore

import pytest

from service.recording_store.store import RecordingStore
from service.reports.contents import alarms as alarms_report
from service.reports.errors import ReportError, ReportRequestError
from service.reports.making import document_of, make_report
from service.reports.source import ReportSource
from service.reports.times import month_at, month_before
from service.reports.typesetting import pdf as typesetting
from service.reports.wanted import AlarmsReport, FleetReport, MotorReport, ReportFormat
from service.storage import NotFoundError, Repository
from service.storage.records import Actor, AlarmPlace, AlarmSpec, Role
from service.storage.states import AlarmKind
from testing.service.conditions import FAULT, tell
from testing.service.diagnosed import add_diagnosed
from testing.service.observations import OBSERVATION
from testing.service.plants import NOW_NS, SECOND_NS, fault, two_motor_plant
from testing.service.starts import START, RecordedStarts
from tests.service.reports.conftest import UNTIL_NS
from tests.service.reports.reading import pages_of, sheets_of, text_of

PDF, XLSX = ReportFormat.PDF, ReportFormat.XLSX
HOUR_NS = 3600 * SECOND_NS
ANN = Actor("ann", "command line", frozenset({Role.OPERATOR}))
HOSTILE = (
    '#panic("x") #read("/etc/passwd") $x^2$ *b* _i_ `raw` <label> @ref // \\ "} \u202e\x00\x1b[31m</title>'
    "<script>alert(1)</script>=HYPERLINK()"
)


def test_the_fleet_says_what_needs_attention_worst_first(seeded: ReportSource) -> None:
    made = make_report(seeded, FleetReport("weekly", UNTIL_NS), PDF)
    text = text_of(made.content)
    assert "Fleet, weekly report of" in text
    assert "6: 3 healthy, 1 watch, 1 fault, 1 unknown" in text
    assert "2 no recent record, 1 not running" in text
    assert "B2_SEL710" in text, "the relay that is down"
    attention = text[text.index("What needs attention") :]
    assert attention.index("PUMP-A1") < attention.index("MILL-A3") < attention.index("COMPRESSOR-B2")
    assert "Check the winding of phase b." in attention, "what to do"
    assert "What changed" in text
    assert f"Data until {made.title[-10:]}" in text


def test_the_fleet_of_one_site(seeded: ReportSource) -> None:
    text = text_of(make_report(seeded, FleetReport("daily", UNTIL_NS, ["FACTORY_B"]), PDF).content)
    assert "CONVEYOR-B1" in text
    assert "PUMP-A1" not in text
    with pytest.raises(ReportRequestError, match="did you mean FACTORY_B"):
        make_report(seeded, FleetReport("daily", UNTIL_NS, ["FACTRY_B"]), PDF)


def test_a_motor_on_a4_with_its_pictures(seeded: ReportSource) -> None:
    made = make_report(seeded, MotorReport("PUMP-A1", UNTIL_NS), PDF)
    assert made.name.startswith("motor_PUMP-A1_")
    text = text_of(made.content)
    assert "PUMP-A1: fault. Shorted turns in phase b, since 2025-10-10 09:53 UTC." in text
    for told in (
        "What to do: Check the winding",
        "limit 0.5 %",  # in the trend
        "arrow: mean of the dots",
        "NEMA: less load",
        "load (torque over rated)",
        "rated voltage",
        "given in the motors file",
        "bearings greased",
    ):
        assert told in text, told
    document = document_of(seeded, MotorReport("PUMP-A1", UNTIL_NS))
    pictures = [one for block in document.blocks for one in block.contents if hasattr(one, "svg")]
    assert len(pictures) == 6


def test_a_motor_with_a_recorded_start(repository: Repository, store: RecordingStore) -> None:
    RecordedStarts(repository, store).add(START, "FAN-A2", at_ns=NOW_NS)
    sheets = sheets_of(make_report(ReportSource(repository), MotorReport("FAN-A2", NOW_NS), XLSX).content)
    heading, row = sheets["starts"]
    assert heading[0] == "time (UTC)"
    assert row[1:] == (1.25, 94.6, 371.5, 333.5, "in full")


def test_a_motor_of_which_nothing_is_known(repository: Repository) -> None:
    made = make_report(ReportSource(repository), MotorReport("FAN-A2", NOW_NS), PDF)
    text = text_of(made.content)
    assert "FAN-A2: unknown" in text
    assert "No recent record." in text
    assert "The motors file has not told its figures yet." in text
    assert "no record yet" in text
    with pytest.raises(NotFoundError):
        make_report(ReportSource(repository), MotorReport("NOBODY", NOW_NS), PDF)


@pytest.fixture
def called(repository: Repository) -> str:
    """An alarm that called twice in the month of NOW_NS, and once more in the next one."""
    spec = AlarmSpec(AlarmKind.FILE_REFUSED, "expected 12 channels, found 3", "EVT.CFF")
    place = AlarmPlace(relay="A1_SEL710")
    alarm = repository.raise_alarm_at(place, spec, now_ns=NOW_NS).id
    repository.acknowledge_alarm(alarm, by=ANN, now_ns=NOW_NS + HOUR_NS, comment="=1+1 looked at it")
    repository.clear_alarms_at(place, AlarmKind.FILE_REFUSED, now_ns=NOW_NS + 2 * HOUR_NS)
    repository.raise_alarm_at(place, spec, now_ns=NOW_NS + 3 * HOUR_NS)
    later = replace(spec, subject="EVT2.CFF")
    repository.raise_alarm_at(place, later, now_ns=NOW_NS + 40 * 24 * HOUR_NS)
    return alarm


MONTH, NEXT_YEAR_NS = "2025-10", NOW_NS + 365 * 24 * HOUR_NS


def test_all_alarms_of_a_month(repository: Repository, called: str) -> None:
    source = ReportSource(repository)
    sheets = sheets_of(make_report(source, AlarmsReport(MONTH, NEXT_YEAR_NS), XLSX).content)
    heading, first, second = sheets["alarms"]
    assert heading[:3] == ("time (UTC)", "priority", "about")
    assert first[2:4] == ("A1_SEL710", "file refused: expected 12 channels, found 3")
    assert first[5] == "ann"
    assert first[7] == "=1+1 looked at it", "a text, which is never calculated"
    assert first[6] is not None
    assert first[8] == "normal"
    assert second[4] is None
    assert second[8] == "unacknowledged"
    assert ("calls", "2: 2 low") in sheets["report"]
    assert ("acknowledged", "1 of 2; half of them within 60 minutes") in sheets["report"]
    text = text_of(make_report(source, AlarmsReport(MONTH, NEXT_YEAR_NS), PDF).content)
    assert "Alarms of 2025-10" in text
    assert "looked at it" in text


def test_a_month_tells_the_same_whatever_comes_later(repository: Repository, called: str) -> None:
    wanted = AlarmsReport(MONTH, NEXT_YEAR_NS)
    before = make_report(ReportSource(repository), wanted, XLSX).content
    for alarm in repository.open_alarms(limit=10).items:
        repository.acknowledge_alarm(alarm.id, by=ANN, now_ns=NEXT_YEAR_NS)
    assert make_report(ReportSource(repository), wanted, XLSX).content == before


def test_a_month_that_is_not_over_is_told_until_now(repository: Repository, called: str) -> None:
    until_ns = NOW_NS + 2 * HOUR_NS
    document = document_of(ReportSource(repository), AlarmsReport(MONTH, until_ns))
    assert document.until_ns == until_ns
    with pytest.raises(ReportRequestError, match="has not begun"):
        document_of(ReportSource(repository), AlarmsReport("2025-11", until_ns))


@pytest.mark.parametrize(
    "month", ["", "2025", "2025-13", "2025-00", "25-10", "2025-1O", "9999-12", "٢٠٢٥-١٠"]
)
def test_what_is_no_month_is_refused(repository: Repository, month: str) -> None:
    with pytest.raises(ReportRequestError, match="expected a month such as"):
        make_report(ReportSource(repository), AlarmsReport(month, NOW_NS), PDF)


def test_too_many_calls_are_counted_and_not_listed(
    repository: Repository, called: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(alarms_report, "MOST_CALLS", 1)
    sheets = sheets_of(make_report(ReportSource(repository), AlarmsReport(MONTH, NEXT_YEAR_NS), XLSX).content)
    assert len(sheets["alarms"]) == 2
    assert ("sheet alarms", "1 rows; 1 further ones are left out") in sheets["report"]


@pytest.mark.parametrize("wanted_format", list(ReportFormat))
def test_the_same_data_has_the_same_bytes(seeded: ReportSource, wanted_format: ReportFormat) -> None:
    wanted = (
        FleetReport("daily", UNTIL_NS),
        MotorReport("PUMP-A1", UNTIL_NS),
        AlarmsReport(month_at(UNTIL_NS, "UTC"), UNTIL_NS),
    )
    for one in wanted:
        digests = {
            hashlib.sha256(make_report(seeded, one, wanted_format).content).hexdigest() for _ in range(2)
        }
        assert len(digests) == 1, one


@pytest.mark.parametrize("wanted_format", list(ReportFormat))
def test_hostile_names_are_words_and_nothing_else(
    repository: Repository, store: RecordingStore, wanted_format: ReportFormat
) -> None:
    plant = two_motor_plant()
    name = HOSTILE.replace("\x00", "")
    evil = replace(
        plant.motors[0], motor=replace(plant.motors[0].motor, name=name), description=f"{name} {'W' * 500}"
    )
    repository.sync_plant(replace(plant, motors=(evil, *plant.motors[1:])))
    told = replace(OBSERVATION, time_ns=NOW_NS)
    add_diagnosed(repository, store, fault(), NOW_NS, motor=name, observed=told)
    tell(repository, replace(FAULT, motor=name, advice=HOSTILE, reasons=(HOSTILE,)))
    spec = AlarmSpec(AlarmKind.FILE_REFUSED, HOSTILE, "EVT")
    repository.raise_alarm_at(AlarmPlace(motor=name), spec, now_ns=NOW_NS)
    until_ns = NOW_NS + HOUR_NS
    for wanted in (
        FleetReport("daily", until_ns),
        MotorReport(name, until_ns),
        AlarmsReport(MONTH, until_ns),
    ):
        made = make_report(ReportSource(repository), wanted, wanted_format)
        assert set(made.name) <= set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-")
        if wanted_format is PDF:
            text = "".join(text_of(made.content).split())
            assert '#panic("x")' in text
            assert "root:" not in text
            assert b"/JavaScript" not in made.content
            assert b"/URI" not in made.content
        else:
            cells = [cell for rows in sheets_of(made.content).values() for row in rows for cell in row]
            assert any(isinstance(cell, str) and "#panic" in cell for cell in cells)


def test_a_report_of_the_past_tells_what_was_known_then(
    repository: Repository, store: RecordingStore
) -> None:
    add_diagnosed(repository, store, fault(), NOW_NS, observed=replace(OBSERVATION, time_ns=NOW_NS))
    tell(repository, FAULT)
    before, after = (
        {
            row[0]: row
            for row in sheets_of(make_report(ReportSource(repository), wanted, XLSX).content)["motors"]
        }
        for wanted in (FleetReport("daily", NOW_NS - 1), FleetReport("daily", NOW_NS))
    )
    assert before["PUMP-A1"][2:5] == ("unknown", None, None)
    assert after["PUMP-A1"][2:5] == ("fault", "shorted turns, phase b", pytest.approx(0.0121))


def test_five_hundred_motors_take_a_bearable_time_and_size(repository: Repository) -> None:
    plant = two_motor_plant()
    many = tuple(
        replace(plant.motors[0], motor=replace(plant.motors[0].motor, name=f"MOTOR-{number:03}"))
        for number in range(500)
    )
    repository.sync_plant(replace(plant, motors=many))
    made = make_report(ReportSource(repository), FleetReport("daily", NOW_NS), PDF)
    assert pages_of(made.content) < 40
    assert len(made.content) < 2_000_000


def test_a_report_that_takes_too_long_or_fails_says_so(
    repository: Repository, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    slow = tmp_path / "slow"
    slow.write_text("#!/bin/sh\nexec sleep 60\n")
    slow.chmod(0o755)
    monkeypatch.setattr(typesetting, "LONGEST_S", 0.2)
    monkeypatch.setattr(typesetting, "COMMAND", (str(slow),))
    wanted = FleetReport("daily", NOW_NS)
    with pytest.raises(ReportError, match=r"not set within 0\.2 s"):
        make_report(ReportSource(repository), wanted, PDF)
    slow.write_text("#!/bin/sh\necho no room >&2\nexit 1\n")
    monkeypatch.setattr(typesetting, "LONGEST_S", 60.0)
    with pytest.raises(ReportError, match="no room"):
        make_report(ReportSource(repository), wanted, PDF)


def test_so_many_reports_are_set_at_a_time(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(typesetting, "LONGEST_S", 0.05)
    monkeypatch.setattr(typesetting, "_TURNS", BoundedSemaphore(1))
    typesetting._TURNS.acquire()
    with pytest.raises(ReportError, match="other reports have been set"):
        make_report(ReportSource(repository), FleetReport("daily", NOW_NS), PDF)


def test_months_before() -> None:
    assert month_before("2025-01") == "2024-12"
    assert month_before("2024-03") == "2024-02"
