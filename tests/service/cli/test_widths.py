"""Tables in a pipe fit 80 and 120 columns and what COLUMNS says; a column left out is named."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.settings import Settings
from service.plant import Plant, PlantMotor, Site
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.states import AlarmKind, LinkState
from testing.service.conditions import FAULT, tell
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER, register_runner
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, fault, motor, relay
from tests.service.api.serving import serving
from tests.service.fixtures import database_url

__all__ = ["database_url"]

EXAMPLES = Path(__file__).parents[3] / "examples"
SCL = Path(__file__).parents[3] / "scl" / "demo_plant.scd"
LONG = "COOLING-WATER-CIRCULATION-PUMP-101A-OF-UNIT-3-NORTH"
REASON = "the relay says a word of a hundred letters: " + "x" * 100

WITH_SERVICE = [
    ("motors",),
    ("health", LONG),
    ("condition", LONG, "--history"),
    ("notes", LONG),
    ("relay", f"{LONG}_SEL710"),
    ("trend", LONG),
    ("starts", LONG),
    ("alarms",),
    ("recordings",),
]
ALONE = [
    ("diagnose", str(EXAMPLES / "RUNNING.CFG")),
    ("import-scl", str(SCL)),
]


@pytest.fixture
def client(database_url: str, tmp_path: Path) -> Iterator[httpx.Client]:
    """A service of motors with long names, with something in every table."""
    engine = connect(database_url)
    repository, store = Repository(engine), FolderStore(tmp_path / "recordings")
    relays = (relay(f"{LONG}_SEL710", "SITE"), relay("R2", "SITE", 10_300))
    motors = (PlantMotor(motor(LONG), "", "SITE", relays[0].name), PlantMotor(motor("M2"), "", "SITE", "R2"))
    repository.sync_plant(Plant((Site("SITE", ""),), relays, motors))
    register_runner(repository)
    repository.add_recording(store.store({f"{LONG}.CFF": b"samples"}), motor=LONG, now_ns=NOW_NS)
    claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    set_link_state(repository, relays[0].name, LinkState.DOWN, REASON, now_ns=NOW_NS)
    repository.raise_alarm(relays[0].name, AlarmKind.FILE_REFUSED, "X.CFG", REASON, now_ns=NOW_NS)
    tell(repository, replace(FAULT, motor=LONG))
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        client.post(f"/api/v1/motors/{LONG}/notes", json={"text": REASON, "on_behalf_of": "ann"})
        yield client
    engine.dispose()


@pytest.mark.parametrize("columns", [None, "80", "120", "65"])
def test_tables_fit_and_nothing_is_cut_off(
    client: httpx.Client,
    columns: str | None,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for command in (*WITH_SERVICE, *ALONE):
        words = [*command, "--url", str(client.base_url)] if command in WITH_SERVICE else [*command]
        monkeypatch.setenv("COLUMNS", "1000")
        assert main(words) == 0
        whole = capsys.readouterr().out
        monkeypatch.setenv("COLUMNS", columns) if columns else monkeypatch.delenv("COLUMNS")
        assert main(words) == 0
        shown = capsys.readouterr().out
        assert "…" not in shown, command
        assert max(map(len, tables(shown))) <= int(columns or 80), (command, shown)
        if command[0] != "diagnose" and "(no room for: " not in shown:  # which says how long it took
            assert characters(shown) == characters(whole), command


def tables(shown: str) -> list[str]:
    """The lines of tables: those beside them are sentences, which a terminal wraps."""
    lines = shown.splitlines()
    return [line for line in lines if line.startswith((" ", "│", "┌", "└", "├"))] or [""]


def characters(shown: str) -> list[str]:
    """What is shown, whatever the lines."""
    return sorted(re.sub(r"[\s│┌└├┐┘┤─┬┴┼━]", "", shown))
