"""The commands that ask a running service, against the API on a real port."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from fastapi import Request, Response
from starlette.middleware.base import RequestResponseEndpoint

from core.diagnosis.causes import Cause
from core.diagnosis.verdict import Hypothesis
from core.machines.parameters import ParametersSource
from service.api import ApiContext, create_app
from service.cli.app import main
from service.cli.remote import verdict_line
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.storage import Repository
from service.storage.records import RelayFindings
from service.storage.states import LinkState
from service.timing.backoff import Backoff
from testing.service.findings import findings_of
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, fault, two_motor_plant
from tests.service.api.relays.test_relays import ACQUISITION
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]


def test_the_motors_whose_relay_is_down_say_why(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    set_link_state(repository, "A1_SEL710", LinkState.DOWN, "10.0.0.7:102: connection refused", now_ns=NOW_NS)
    set_link_state(repository, "A2_SEL710", LinkState.UP, None, now_ns=NOW_NS)
    app = create_app(
        ApiContext(Settings(data_directory=tmp_path), repository, FolderStore(tmp_path / "recordings"))
    )
    with serving(app) as client:
        assert main(["motors", "--url", str(client.base_url)]) == 0
    shown = capsys.readouterr().out
    assert "A1_SEL710 (PUMP-A1): down: 10.0.0.7:102: connection refused" in shown.splitlines()
    links = {line.split()[0]: line.split()[-1] for line in shown.splitlines()[3:5]}
    assert links == {"FAN-A2": "up", "PUMP-A1": "down"}


def test_a_motor_with_nothing_but_a_nameplate_is_listed_as_collecting(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plant = two_motor_plant()
    pump, fan = plant.motors
    bare = replace(pump.motor, parameters_source=ParametersSource.TYPICAL)
    repository.sync_plant(replace(plant, motors=(replace(pump, motor=bare), fan)))
    app = create_app(
        ApiContext(Settings(data_directory=tmp_path), repository, FolderStore(tmp_path / "recordings"))
    )
    with serving(app) as client:
        assert main(["motors", "--url", str(client.base_url)]) == 0
        listed = capsys.readouterr().out
        assert main(["health", "PUMP-A1", "--url", str(client.base_url)]) == 0
        health = " ".join(capsys.readouterr().out.split())
    assert "collecting; commission me" in " ".join(listed.split())
    assert listed.count("commission") == 1
    assert "collecting; commission me: the parameters are typical of the rating" in health


def test_the_motors_are_asked_for_once(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    app = create_app(
        ApiContext(Settings(data_directory=tmp_path), repository, FolderStore(tmp_path / "recordings"))
    )
    requests: list[str] = []

    @app.middleware("http")
    async def note(request: Request, call_next: RequestResponseEndpoint) -> Response:
        requests.append(request.url.path)
        return await call_next(request)

    with serving(app) as client:
        requests.clear()  # the server has asked for what it tells of its health
        assert main(["motors", "--url", str(client.base_url), "--json"]) == 0
        assert requests == ["/api/v1/motors"]
        listed = json.loads(capsys.readouterr().out)["motors"]
        for one in listed:
            health = client.get(f"/api/v1/motors/{one['name']}/health").json()
            motor = client.get(f"/api/v1/motors/{one['name']}").json()
            assert motor.pop("winding", None) is None  # of one motor alone, not of a list
            assert one == {**motor, "health": health}
    assert [one["name"] for one in listed] == ["FAN-A2", "PUMP-A1"]


def test_a_relay_tells_what_is_used_of_it(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    app = create_app(
        ApiContext(Settings(data_directory=tmp_path), repository, FolderStore(tmp_path / "recordings"))
    )
    missing = {"kind": "logical-node", "expected": "A1_SEL710PRO/FLTRDRE1", "found": None}
    ignored = {"name": "NOTES.TXT", "reason": "no file of a recording"}
    with serving(app) as client:
        assert main(["relay", "A1_SEL710", "--url", str(client.base_url)]) == 0
        assert "not visited yet" in capsys.readouterr().out
        repository.note_findings(RelayFindings("A1_SEL710", NOW_NS, ACQUISITION, [missing], [ignored], 1))
        assert main(["relay", "A1_SEL710", "--url", str(client.base_url)]) == 0
        shown = " ".join(capsys.readouterr().out.replace("\N{BOX DRAWINGS LIGHT VERTICAL}", " ").split())
        assert main(["relay", "A1_SEL710", "--url", str(client.base_url), "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["differences"] == [missing]
        assert main(["relay", "NOPE", "--url", str(client.base_url)]) == 1
    assert "there is no relay 'NOPE'" in capsys.readouterr().err
    for words in ("direct-with-normal-security", "COMTRADE", "NOTES.TXT: no file of a recording"):
        assert words in shown
    assert "found none" in shown


def test_the_detection_limit_stands_beside_the_interval_from_all_causes(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = FolderStore(tmp_path / "recordings")
    repository.add_recording(store.store({"E.CFF": b"samples"}), motor="PUMP-A1", now_ns=NOW_NS)
    repository.register_runner("runner", installation="here", now_ns=NOW_NS, max_attempts=3)
    claimed = repository.claim_job(now_ns=NOW_NS, runner="runner")
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(fault(0.05)), recorded_ns=NOW_NS, now_ns=NOW_NS, runner="runner"
    )
    app = create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))
    with serving(app) as client:
        assert main(["health", "PUMP-A1", "--url", str(client.base_url)]) == 0
        health = capsys.readouterr().out
    assert "5.00 % [4.60..5.40]" in health
    assert "2.10 %: nine of ten such recordings show a fault of it" in health
    assert "0.480 [0.460..0.500]" in health


def test_a_key_triggers_once(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    app = create_app(
        ApiContext(Settings(data_directory=tmp_path), repository, FolderStore(tmp_path / "recordings"))
    )
    with serving(app) as client:
        for key in ("a", "a", "\N{GREEK SMALL LETTER BETA}"):
            assert main(["trigger", "PUMP-A1", "--key", key, "--url", str(client.base_url)]) == 0
    assert len(repository.recording_requests(limit=10).items) == 2


def test_a_relay_is_released(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    repository.set_aside("A1_SEL710", "it lied", backoff=Backoff(60.0, 60.0), now_ns=NOW_NS)
    app = create_app(
        ApiContext(Settings(data_directory=tmp_path), repository, FolderStore(tmp_path / "recordings"))
    )
    with serving(app) as client:
        assert main(["release", "A1_SEL710", "--url", str(client.base_url)]) == 0
        assert main(["release", "A2_SEL710", "--url", str(client.base_url)]) == 0
        assert main(["release", "NOPE", "--url", str(client.base_url)]) == 1
    shown = capsys.readouterr().out
    assert "A1_SEL710: released" in shown
    assert "A2_SEL710: was not set aside" in shown
    assert repository.quarantines() == ()


@pytest.mark.parametrize("wait", ["inf", "nan", "-1"])
def test_a_wait_without_end_is_refused(wait: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["trigger", "PUMP-A1", "--wait", wait, "--url", "http://127.0.0.1:9"]) == 2
    assert "--wait" in capsys.readouterr().err


def test_a_trigger_that_is_not_waited_for_names_what_is_next(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = FolderStore(tmp_path / "recordings")
    app = create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))
    with serving(app) as client:
        words = ["trigger", "PUMP-A1", "--url", str(client.base_url)]
        assert main(words) == 0
        assert "mcc recordings list PUMP-A1 shows what comes of it" in capsys.readouterr().out
        assert main([*words, "--wait", "0.01"]) == 1
    told = capsys.readouterr().err
    assert "PUMP-A1: no verdict within 0.01 s: its relay is not asked yet; mcc recordings list" in told


def test_a_trigger_without_a_verdict_says_what_is_not_ready(
    repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = FolderStore(tmp_path / "recordings")
    settings = Settings(data_directory=tmp_path)
    readiness = {"jobs": lambda: "2 of 2 workers are loading"}
    context = ApiContext(settings, repository, store, readiness=readiness)
    with serving(create_app(context)) as client:
        assert main(["trigger", "PUMP-A1", "--wait", "0.01", "--url", str(client.base_url)]) == 1
    told = " ".join(capsys.readouterr().err.split())
    assert "the service is not ready: jobs: 2 of 2 workers are loading; mcc recordings list" in told


@pytest.mark.parametrize(
    ("probabilities", "begins"),
    [
        ((0.717, 0.003, 0.28), "FAN-A2: fault in phase a (72 %) or c (28 %), 5.10 % ["),
        (None, "FAN-A2: fault, 5.10 % ["),
    ],
)
def test_a_phase_that_is_not_named_alone_is_told_with_the_other_one(
    probabilities: tuple[float, float, float] | None, begins: str
) -> None:
    turns = Hypothesis(Cause.SHORTED_TURNS, 0.99, 30.0, "equivalent level 5.1%")
    found = replace(fault(), theta_f=None, phase_probabilities=probabilities, hypotheses=(turns,))
    assert verdict_line("FAN-A2", found.as_dict()).plain.startswith(begins)
