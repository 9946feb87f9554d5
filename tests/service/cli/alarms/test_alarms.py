"""`mcc alarms`: against the API on a real port."""

import csv
import io
import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.api import ApiContext, create_app
from service.api.times import nanoseconds
from service.cli.app import main
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import SERVICE, Alarm, AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind, AlarmState
from testing.service.conditions import FAULT, tell
from testing.service.plants import NOW_NS, SECOND_NS
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

Mcc = Callable[..., str]
FORMULA = "=1+1 the relay's"
RELAY = "A1_SEL710"


@pytest.fixture
def client(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        yield client


@pytest.fixture
def mcc(client: httpx.Client, capsys: pytest.CaptureFixture[str]) -> Mcc:
    """Run a command against the service; returns what it prints."""

    def run(*words: str, ends: int = 0) -> str:
        assert main(["alarms", *words, "--url", str(client.base_url)]) == ends
        output = capsys.readouterr()
        return output.err if ends else output.out

    return run


@pytest.fixture
def alarm(repository: Repository) -> Alarm:
    return repository.raise_alarm(RELAY, AlarmKind.FILE_REFUSED, "X.CFG", FORMULA, now_ns=NOW_NS)


@pytest.fixture
def growing(repository: Repository) -> Alarm:
    spec = AlarmSpec(AlarmKind.CONDITION_FAULT, "shorted turns", one_of_kind=True, value=0.01)
    return repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), spec, now_ns=NOW_NS)


def test_what_to_act_on_first_is_at_the_top(mcc: Mcc, repository: Repository, alarm: Alarm) -> None:
    tell(repository, FAULT)
    over = repository.raise_alarm("A2_SEL710", AlarmKind.RELAY_DIFFERS, "trigger", "none", now_ns=NOW_NS)
    repository.clear_alarms("A2_SEL710", [over.id], now_ns=NOW_NS + SECOND_NS)
    first, second, third = (line for line in mcc().splitlines() if not line.startswith(" "))
    since = "since 2025-10-09 08:53:20 UTC"
    assert first == f"critical, unacknowledged  PUMP-A1: condition-fault, {since}"
    assert second == f"low, unacknowledged  {RELAY}: file-refused, {since}"
    until = "until 2025-10-09 08:53:21 UTC"
    assert third.startswith("low, returned-unacknowledged  A2_SEL710: relay-differs, since")
    assert until in " ".join(mcc().split())
    shown = mcc("--relay", RELAY, "--state", "unacknowledged")
    assert f"    X.CFG: {FORMULA}" in shown.splitlines()
    assert f"    id {alarm.id}" in shown.splitlines()
    assert mcc("FAN-A2") == mcc("--site", "ELSEWHERE") == "no alarms\n"
    assert mcc("list", "PUMP-A1").startswith(first)
    mcc("acknowledge", over.id)
    assert over.id not in mcc()
    assert over.id in mcc("--all", "--relay", "A2_SEL710")
    assert "expected neither --site nor --state" in mcc("--all", "--state", "shelved", ends=2)


def test_a_flood_leads_to_its_members(mcc: Mcc, repository: Repository) -> None:
    for number in range(12):
        repository.raise_alarm(RELAY, AlarmKind.FILE_REFUSED, f"file {number}", "outside", now_ns=NOW_NS)
    repository.gather_floods(10, now_ns=NOW_NS)
    first, *_ = mcc().splitlines()
    assert first.startswith("low, unacknowledged  FACTORY_A: alarm-flood")
    [flood] = [one for one in json.loads(mcc("--json"))["alarms"] if one["kind"] == "alarm-flood"]
    members = json.loads(mcc("--part-of", flood["id"][:8], "--json"))["alarms"]
    assert {one["subject"] for one in members} == {f"file {number}" for number in range(12)}
    assert "expected neither --site" in mcc("--part-of", flood["id"], "--site", "FACTORY_A", ends=2)


def test_rows_for_spreadsheets_and_programs(mcc: Mcc, alarm: Alarm) -> None:
    [row] = csv.DictReader(io.StringIO(mcc("--csv")))
    assert (row["ied"], row["kind"], row["cleared_time"], row["state"], row["id"]) == (
        (RELAY, "file-refused", "", "unacknowledged", alarm.id)
    )
    assert row["reason"] == f"'{FORMULA}", "a spreadsheet would compute it"
    assert json.loads(mcc("--json"))["alarms"][0]["reason"] == FORMULA


def test_an_alarm_has_its_advice(mcc: Mcc, repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    tell(repository, FAULT)
    shown = mcc()
    [alarm] = json.loads(mcc("--json"))["alarms"]
    assert alarm["advice"]
    assert " ".join(alarm["advice"].split()) in " ".join(shown.split())
    assert max(map(len, shown.splitlines())) <= 80


def test_acknowledge_by_the_beginning_of_an_id(mcc: Mcc, alarm: Alarm) -> None:
    shown = mcc("acknowledge", alarm.id[:6].upper(), "--comment", "ordered a new card")
    assert shown.startswith(f"low, acknowledged  {RELAY}: file-refused")
    who = json.loads(mcc("show", alarm.id, "--json"))["changed_by"]
    assert f"    acknowledged by {who} " in shown
    assert ": ordered a new card\n" in shown
    error = mcc("acknowledge", alarm.id[:6], ends=1)
    assert f"cannot be acknowledged: it is acknowledged (by {who}: ordered a new card)" in error
    assert "possible now: shelve, take out of service" in error
    assert "at least its first 4 characters" in mcc("acknowledge", "abc", ends=1)
    assert "no open alarm has an id that begins with 'zzzz'" in mcc("acknowledge", "zzzz", ends=1)
    assert "expected ids of alarms, or --motor" in mcc("acknowledge", ends=2)
    assert "expected ids of alarms, or --motor" in mcc("acknowledge", "abcd", "--motor", "M", ends=2)


def test_acknowledge_several_of_which_one_cannot_be(
    mcc: Mcc, repository: Repository, alarm: Alarm, growing: Alarm
) -> None:
    repository.acknowledge_alarms([growing.id], by=SERVICE, now_ns=NOW_NS)
    error = mcc("acknowledge", alarm.id, growing.id, ends=1)
    assert f"warning: alarm {growing.id} cannot be acknowledged" in error
    assert "1 of 2 alarms were not acknowledged" in error
    assert repository.alarm(alarm.id).state is AlarmState.ACKNOWLEDGED


def test_acknowledge_all_of_a_motor(mcc: Mcc, repository: Repository, alarm: Alarm, growing: Alarm) -> None:
    assert growing.id in mcc("acknowledge", "--motor", "PUMP-A1")
    assert mcc("acknowledge", "--motor", "PUMP-A1") == "no alarm of PUMP-A1 waits to be acknowledged\n"
    assert repository.alarm(alarm.id).state is AlarmState.UNACKNOWLEDGED
    assert "did you mean 'PUMP-A1'?" in mcc("acknowledge", "--motor", "pump-a1", ends=1)


def test_shelve_until_a_time_and_unshelve(mcc: Mcc, repository: Repository, alarm: Alarm) -> None:
    before_ns = time.time_ns()
    shown = mcc("shelve", alarm.id, "--for", "8h", "--comment", "Friday")
    assert shown.startswith("low, shelved  ")
    until_ns = repository.alarm(alarm.id).shelved_until_ns
    assert until_ns is not None
    assert abs(until_ns - before_ns - NANOSECONDS_PER_DAY // 3) < 60 * NANOSECONDS_PER_SECOND
    tomorrow = f"{time.strftime('%Y-%m-%dT%H:%M:%SZ', time.gmtime(time.time() + 86400))}"
    assert json.loads(mcc("shelve", alarm.id, "--until", tomorrow, "--json"))["shelved_until"]
    assert repository.alarm(alarm.id).shelved_until_ns == nanoseconds(tomorrow)
    assert mcc("unshelve", alarm.id, "--comment", "here already").startswith("low, unacknowledged")


def test_shelve_until_it_grows(mcc: Mcc, repository: Repository, growing: Alarm) -> None:
    shown = mcc("shelve", growing.id, "--growth", "0.5%")
    assert "shelved until its level is above 1.50 % by " in " ".join(shown.split())
    assert repository.alarm(growing.id).shelved_above == pytest.approx(0.015)
    assert " until its level is above 1.50 % " in " ".join(
        mcc("show", growing.id).split("until", 1)[1].split()
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "expected an end of the shelving: --until, --for or --growth"),
        (("--until", "2030-01-01", "--for", "8h"), "found both"),
        (("--for", "8"), "expected a time such as 30min, 8h or 3d, found '8'"),
        (("--for", "0h"), "expected a time such as"),
        (("--growth", "nan"), "expected an amount above 0"),
        (("--growth", "-1%"), "expected an amount above 0"),
        (("--growth", "much"), "expected an amount above 0"),
    ],
)
def test_an_end_that_is_none(mcc: Mcc, growing: Alarm, words: tuple[str, ...], said: str) -> None:
    assert said in mcc("shelve", growing.id, *words, ends=2)


def test_out_of_service_and_back_with_the_history(mcc: Mcc, alarm: Alarm) -> None:
    shown = mcc("out-of-service", alarm.id, "--comment", "replaced on Monday")
    assert "taken out of service by " in shown
    assert mcc("back-in-service", alarm.id).startswith("low, unacknowledged")
    history = mcc("show", alarm.id)
    events = [line.split()[3] for line in history.splitlines() if line.strip().startswith("20")]
    assert events == ["put-back-in-service", "taken-out-of-service", "raised"]
    assert "replaced on Monday" in " ".join(history.split())
    assert len(json.loads(mcc("show", alarm.id, "--json"))["changes"]) == 3


def test_key_figures(mcc: Mcc, repository: Repository) -> None:
    assert mcc("figures").startswith("0.0 alarms a day since ")
    now_ns = time.time_ns()
    for number in range(4):
        found = repository.raise_alarm(RELAY, AlarmKind.DAILY_LIMIT, "", "full", now_ns=now_ns + number)
        repository.clear_alarms(RELAY, [found.id], now_ns=now_ns + number)
    repository.raise_alarm(RELAY, AlarmKind.TIME_ZONE, "", "off", now_ns=now_ns - 2 * NANOSECONDS_PER_DAY)
    shown = mcc("figures", "--days", "7")
    assert "open: 1 returned-unacknowledged, 1 unacknowledged" in shown
    for words in ("alarms of each day", "most frequent", "chattering", "standing for longer than a day (1"):
        assert words in shown
    assert json.loads(mcc("figures", "--json"))["standing_long_in_all"] == 1


def test_no_service_and_no_such_alarm(mcc: Mcc, capsys: pytest.CaptureFixture[str]) -> None:
    unknown = "0" * 8 + "-0000-4000-8000-" + "0" * 12
    assert f"there is no alarm '{unknown}'" in mcc("show", unknown, ends=1)
    assert main(["alarms", "--url", "http://127.0.0.1:9"]) == 1
    assert "no service answers" in capsys.readouterr().err
