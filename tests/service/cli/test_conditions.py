"""The commands about conditions, against the API on a real port."""

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import get_args

import httpx
import pytest
from rich.console import Console

from core.condition.events import EventKind
from core.condition.forecast.outcome import Forecast
from core.condition.kinds import Kind
from core.condition.verdict.condition import Condition
from core.time_stamps import rfc3339
from service.api import ApiContext, create_app
from service.cli.app import main
from service.cli.commands.service import NoteKind
from service.cli.motors import motors_table
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.storage import Repository
from service.storage.states import LinkState
from testing.service.accounts import TESTER
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, tell
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.links import set_link_state
from testing.service.observations import HOUR_NS
from testing.service.plants import NOW_NS, fault
from testing.service.rotor_and_supply import BROKEN_ROTOR, ExaminedRecordings
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

Mcc = Callable[..., str]


@pytest.fixture
def client(repository: Repository, tmp_path: Path) -> Iterator[httpx.Client]:
    context = ApiContext(Settings(data_directory=tmp_path), repository, FolderStore(tmp_path / "recordings"))
    with serving(create_app(context)) as client:
        yield client


@pytest.fixture
def mcc(client: httpx.Client, capsys: pytest.CaptureFixture[str]) -> Mcc:
    """Run a command that succeeds; returns what it prints."""

    def run(*words: str) -> str:
        assert main([*words, "--url", str(client.base_url)]) == 0
        return capsys.readouterr().out

    return run


def unframed(shown: str) -> str:
    """The words of a table."""
    return " ".join(shown.translate({0x2502: " "}).split())


def test_the_motors_lead_with_their_condition(mcc: Mcc, repository: Repository) -> None:
    tell(repository, FAULT)
    shown = mcc("motors")
    row = next(line for line in shown.splitlines() if "PUMP-A1" in line)
    assert " ".join(row.split()) == (
        "PUMP-A1 fault: shorted turns b 1.21 [0.90..2.25] 2025-10-06 2025-10-09 08:53 UTC stale unknown"
    )
    idle = next(line for line in shown.splitlines() if "FAN-A2" in line)
    assert idle.split() == ["FAN-A2", "unknown", "-", "-", "-", "unknown"]
    listed = json.loads(mcc("motors", "--json"))["motors"]
    assert listed[1]["health"]["condition"].items() >= {**FAULT.as_dict(), "stale": True}.items()


@pytest.mark.parametrize("condition", [FAULT, DRIFTING, HEALTHY])
def test_80_columns_hold_the_list_of_motors(
    client: httpx.Client, repository: Repository, condition: Condition
) -> None:
    tell(repository, condition)
    set_link_state(repository, "A1_SEL710", LinkState.QUARANTINED, "it lied " * 20, now_ns=NOW_NS)
    motors = client.get("/api/v1/motors", params={"health": "true"}).json()["items"]
    healths = [{**motor["health"], "motor": f"COMPRESSOR-{motor['ied'][:2]}"} for motor in motors]
    console = Console(file=StringIO(), width=80)
    console.print(motors_table(healths))
    assert isinstance(console.file, StringIO)
    lines = console.file.getvalue().splitlines()
    assert max(len(line.rstrip()) for line in lines) <= 80
    shown = " ".join(lines)
    for words in ("COMPRESSOR-A1", str(condition.state), "08:53 UTC", "stale", "no room for: link"):
        assert words in shown
    assert condition.mu_f_ci95 is not None
    assert f"..{100 * condition.mu_f_ci95[1]:.2f}]" in shown


def test_health_says_what_to_do_then_why_then_what_the_latest_recording_says(
    mcc: Mcc, repository: Repository, tmp_path: Path
) -> None:
    stored = FolderStore(tmp_path / "recordings").store({"E.CFF": b"samples"})
    repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS)
    claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault(0.05)), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    tell(repository, FAULT)
    shown = unframed(mcc("health", "PUMP-A1"))
    in_order = [
        "condition fault: shorted turns b",
        "what to do Check the winding of phase b.",
        "fault level 1.21 % [0.90..2.25]",
        "since 2025-10-06 08:53:20 UTC",
        "change of the level 1.20 % [0.90..1.50]",
        "growth 0.04 % a day; 2.00 % in about 20 days, in eight of ten cases 12 to 41",
        "why shorted turns in phase b: 1.20 %",
        "reference learnt from 64 records; detection limit 0.45 % within ten records",
        "as of 2025-10-09 08:53:20 UTC; stale",
        "latest verdict fault",
        "equivalent fault level 5.00 % [4.60..5.40]",
    ]
    places = [shown.index(words) for words in in_order]
    assert places == sorted(places)


def test_health_tells_the_rotor(mcc: Mcc, repository: Repository, tmp_path: Path) -> None:
    assert "rotor not assessed" in unframed(mcc("health", "PUMP-A1"))
    recorded = ExaminedRecordings(repository, FolderStore(tmp_path / "recordings"))
    for _ in range(2):
        recorded.add(BROKEN_ROTOR)
    shown = unframed(mcc("health", "PUMP-A1"))
    assert "rotor fault, -29.0 dB what to do Have the cage inspected" in shown
    assert "2 of the latest 2 records show a fault of the rotor" in shown
    assert json.loads(mcc("health", "PUMP-A1", "--json"))["rotor"]["state"] == "fault"


def test_a_motor_without_a_record_has_no_figures(mcc: Mcc) -> None:
    shown = unframed(mcc("condition", "FAN-A2"))
    assert "condition unknown what to do Have the motor recorded while it runs" in shown
    assert "reference none yet as of no record yet" in shown
    assert "%" not in shown


def test_a_change_of_a_channel_has_a_size_and_no_growth(mcc: Mcc, repository: Repository) -> None:
    named = replace(
        DRIFTING,
        kind=Kind.VOLTAGE_CHANNEL,
        candidates=(),
        change=0.0,
        change_ci95=None,
        size=-0.0125,
        size_ci95=(-0.015, -0.01),
    )
    tell(repository, named)
    shown = unframed(mcc("condition", "PUMP-A1"))
    assert "condition watch: voltage channel c" in shown
    assert "size of the change -1.25 % [-1.50..-1.00]" in shown
    assert "growth" not in shown


def test_what_stands_from_the_first_record_on_has_neither_a_beginning_nor_a_change(
    mcc: Mcc, repository: Repository
) -> None:
    assert FAULT.reference is not None
    first_ns = FAULT.reference.since_ns
    tell(repository, replace(FAULT, since_ns=first_ns, change=0.0, change_ci95=None))
    shown = unframed(mcc("condition", "PUMP-A1"))
    assert "since unknown: there since the first record, of 2025-08-06 08:53:20 UTC" in shown
    assert "size of the change" not in shown
    (row,) = [line for line in mcc("motors").splitlines() if "PUMP-A1" in line]
    assert "2025-08-06" not in row


def test_a_growth_that_is_not_certain_is_told_as_that(mcc: Mcc, repository: Repository) -> None:
    tell(repository, replace(FAULT, forecast=Forecast(0.02, None, 0.0004)))
    shown = unframed(mcc("condition", "PUMP-A1"))
    assert "growth not certain, 0.04 % a day at best guess; it may never reach 2.00 %" in shown


def test_a_reference_that_is_not_complete_says_so(mcc: Mcc, repository: Repository) -> None:
    reference = HEALTHY.reference
    assert reference is not None
    learning = replace(reference, records=5, complete=False, detectable=None)
    tell(repository, replace(HEALTHY, reference=learning, change=None))
    assert "learnt from 5 records so far; no change can be seen" in unframed(mcc("condition", "PUMP-A1"))


def test_the_history_of_a_condition_tells_what_changed_it(mcc: Mcc, repository: Repository) -> None:
    tell(repository, DRIFTING)
    tell(repository, FAULT, now_ns=NOW_NS + 1)
    lines = [" ".join(line.split()) for line in mcc("condition", "PUMP-A1", "--history").splitlines()]
    assert lines[-3:-1] == [
        "2025-10-09 08:53:20 UTC fault: shorted turns b 1.21 % [0.90..2.25]"
        " maintenance: new bearing (statorwatch, on behalf of ann)",
        "2025-10-09 08:53:20 UTC watch: voltage channel or shorted turns c 0.04 % [0.00..1.20]"
        " maintenance: new bearing (statorwatch, on behalf of ann)",
    ]
    found = json.loads(mcc("condition", "PUMP-A1", "--history", "--json"))
    assert [change["state"] for change in found["changes"]] == ["fault", "watch"]
    assert "changes" not in json.loads(mcc("condition", "PUMP-A1", "--json"))


def test_what_may_have_changed_is_named(mcc: Mcc, repository: Repository) -> None:
    tell(repository, DRIFTING)
    assert "watch: voltage channel or shorted turns c" in mcc("motors")


@pytest.mark.parametrize(
    ("kind", "hours", "warned"), [("maintenance", 1, True), ("maintenance", -1, False), ("note", 1, False)]
)
def test_a_note_that_waits_for_a_record_is_warned_of(
    client: httpx.Client,
    repository: Repository,
    kind: str,
    hours: int,
    warned: bool,
    capsys: pytest.CaptureFixture[str],
) -> None:
    tell(repository, HEALTHY)
    when, url = rfc3339(NOW_NS + hours * HOUR_NS), str(client.base_url)
    words = ["note", "PUMP-A1", "terminals tightened", "--on-behalf-of", "Ann", "--url", url]
    assert main([*words, "--kind", kind, "--time", when]) == 0
    assert ("PUMP-A1 has no record after that" in capsys.readouterr().err) == warned


def test_notes_are_taken_and_shown(mcc: Mcc, repository: Repository) -> None:
    when = "2025-10-09T08:00:00Z"
    told = mcc(
        "note",
        "PUMP-A1",
        "new winding\nby Miller",
        "--kind",
        "rewound",
        "--time",
        when,
        "--on-behalf-of",
        "Ann",
    )
    assert told == "PUMP-A1: rewound of 2025-10-09 08:00:00 UTC is noted\n"
    kept = json.loads(mcc("note", "PUMP-A1", "hums", "--json"))
    assert kept["kind"] == "note"
    assert (kept["by"], kept["on_behalf_of"]) == (TESTER, None), "who is logged in says it"
    restarted = mcc("restart-reference", "PUMP-A1", "--reason", "surge test passed", "--on-behalf-of", "Ann")
    assert restarted.startswith("PUMP-A1: reference-restarted of 20")
    rows = [" ".join(line.split()) for line in mcc("notes", "PUMP-A1").splitlines()]
    (rewound,) = [row for row in rows if "rewound" in row]
    assert rewound.startswith(
        "2025-10-09 08:00:00 UTC rewound tester, on behalf of Ann new winding by Miller "
    )
    withdrawn = mcc(
        "withdraw-note", "PUMP-A1", rewound.split()[-1], "--reason", "not yet", "--on-behalf-of", "Bob"
    )
    assert withdrawn == "PUMP-A1: rewound of 2025-10-09 08:00:00 UTC is withdrawn\n"
    assert "new winding by Miller (withdrawn by tester, on behalf of Bob: not yet)" in " ".join(
        mcc("notes", "PUMP-A1").split()
    )
    notes = json.loads(mcc("notes", "PUMP-A1", "--json"))["notes"]
    assert [note["kind"] for note in notes] == ["reference-restarted", "note", "rewound"]
    assert notes[-1]["time"] == rfc3339(NOW_NS - 3200 * 10**9)


def test_every_kind_of_note_that_is_offered_is_accepted(mcc: Mcc) -> None:
    for kind in get_args(NoteKind):
        assert json.loads(mcc("note", "PUMP-A1", "told", "--kind", kind, "--json"))["kind"] == kind
    assert set(EventKind) - set(get_args(NoteKind)) == {EventKind.PARAMETERS_EDITED}


@pytest.mark.parametrize(
    ("words", "status", "message"),
    [
        (("note", "NOPE", "hums"), 1, "there is no motor 'NOPE'"),
        (("note", "PUMP-A1", " "), 1, "TEXT: expected a few words, found none"),
        (("note", "PUMP-A1", "x" * 501), 1, "at most 500 characters"),
        (("note", "PUMP-A1", "hums", "--time", "yesterday"), 1, "time: expected an RFC 3339 time"),
        (("note", "PUMP-A1", "hums", "--kind", "exploded"), 2, "exploded"),
        (("note", "PUMP-A1", "hums", "--kind", "parameters-edited"), 2, "reference-restarted"),
        (("restart-reference", "PUMP-A1"), 2, "--reason"),
        (("restart-reference", "PUMP-A1", "--reason", " "), 1, "--reason: expected a few words, found none"),
        (("withdraw-note", "PUMP-A1", "1", "--reason", "wrong"), 1, "note_id"),
        (("condition", "NOPE"), 1, "there is no motor 'NOPE'"),
        (("notes", "NOPE"), 1, "there is no motor 'NOPE'"),
    ],
)
def test_what_is_wrong_is_said(
    client: httpx.Client,
    capsys: pytest.CaptureFixture[str],
    words: tuple[str, ...],
    status: int,
    message: str,
) -> None:
    assert main([*words, "--url", str(client.base_url)]) == status
    assert message in capsys.readouterr().err


def test_a_stop_is_planned_and_the_condition_answers(
    client: httpx.Client, repository: Repository, capsys: pytest.CaptureFixture[str]
) -> None:
    url = str(client.base_url)
    assert main(["plan-stop", "PUMP-A1", "2090-12-24", "--url", url]) == 0
    assert "PUMP-A1: stops 2090-12-24" in capsys.readouterr().out
    assert main(["plan-stop", "FACTORY_A", "2080-12-24", "--site", "--json", "--url", url]) == 0
    assert json.loads(capsys.readouterr().out)["of"] == "site"
    assert main(["condition", "PUMP-A1", "--url", url]) == 0
    words = capsys.readouterr().out
    assert "planned stop" in words
    assert "2080-12-24" in words
    assert "not assessed: the latest record is too old" in words
    assert main(["plan-stop", "FACTORY_A", "--site", "--cancel", "--url", url]) == 0
    assert "no stop is planned" in capsys.readouterr().out
    assert main(["plan-stop", "PUMP-A1", "--url", url]) == 2
