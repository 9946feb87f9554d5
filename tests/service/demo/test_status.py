"""`mcc demo-status` and `mcc demo --url`: a demo plant somebody else runs."""

import json
import time
from dataclasses import replace
from pathlib import Path

import pytest
from fastapi import FastAPI
from sqlalchemy import Engine

from core.units import NANOSECONDS_PER_DAY
from service.api import ApiContext, create_app
from service.api.limits.connections import ConnectionLimits
from service.cli import main
from service.client.rest_client import Document, ServiceClient
from service.configuration.settings import Settings
from service.demo.plant import START_LIMIT_S, NotReadyError, plant_elsewhere, wait_until_ready
from service.demo.status import MotorStatus, ask_status
from service.demo.truth import Truth, TruthError
from service.plant import Plant, PlantMotor, Site
from service.recording_store.folder import FolderStore
from service.storage import Repository
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER, register_runner
from testing.service.plants import NOW_NS, fault, motor, relay
from testing.service.processes import MOTOR_NAMES, running_service, simulated_plant
from tests.service.api.serving import listening, serving
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

FAULT_B = Truth(mu_f=0.05, theta_f=1, load_level=0.65)


def health(verdict: str | None, phase: str | None) -> Document:
    learning = {"state": "healthy", "phase": None, "reference": {"complete": False}}
    return {"verdict": verdict, "phase": phase, "condition": learning}


@pytest.mark.parametrize(
    ("found", "truth", "right"),
    [
        (health("fault", "b"), FAULT_B, True),
        (health("fault", "c"), FAULT_B, False),
        (health("watch", "b"), FAULT_B, False),
        (health(None, None), FAULT_B, None),
        (health("healthy", None), Truth(mu_f=0.0, theta_f=None, load_level=0.8), True),
    ],
)
def test_right_is_verdict_and_phase_while_the_reference_is_learnt(
    found: Document, truth: Truth, right: bool | None
) -> None:
    assert MotorStatus(found, truth).is_right is right


@pytest.mark.parametrize(
    ("state", "broken_bars", "right"),
    [
        ("fault", 1.0, True),
        ("fault", 0.0, False),
        ("watch", 1.0, None),
        ("healthy", 0.4, None),
        ("healthy", 0.0, True),
        ("unsupported", 0.0, None),
    ],
)
def test_a_rotor_is_right_where_bars_are_broken(state: str, broken_bars: float, right: bool | None) -> None:
    truth = Truth(mu_f=0.0, theta_f=None, load_level=0.8, broken_bars=broken_bars)
    assert MotorStatus(health("healthy", None), truth, rotor={"state": state}).is_rotor_right is right


@pytest.mark.campaign
@pytest.mark.timeout(300)
def test_a_demo_elsewhere_is_played_and_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with simulated_plant(tmp_path) as plant, running_service(tmp_path, plant.scd) as service:
        assert main(["demo-status", "--url", service.url, "--json"]) == 0
        before = json.loads(capsys.readouterr().out)
        assert [motor["verdict"] for motor in before["motors"]] == [None] * len(MOTOR_NAMES)
        assert (before["right"], before["judged"]) == (0, 0)
        assert main(["demo-status", "--url", service.url]) == 0
        assert f"0 of 0 motors are judged right; {len(MOTOR_NAMES)} not judged yet" in capsys.readouterr().out
        assert main(["demo", "--once", "--url", service.url]) == 0
        assert "at most" in capsys.readouterr().out
        assert main(["demo-status", "--url", service.url, "--json"]) == 0
        after = json.loads(capsys.readouterr().out)
        assert after["right"] == len(MOTOR_NAMES), after
        assert {motor["motor"]: motor["phase"] for motor in after["motors"]}["FAN-A2"] == "b"
        assert main(["demo-status", "--url", service.url]) == 0
        shown = capsys.readouterr().out
        assert "6 of 6 motors are judged right" in shown
        assert "5 % b" in shown


def test_no_service_is_one_line_and_one_document(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["demo-status", "--url", "http://127.0.0.1:1", "--json"]) == 1
    output = capsys.readouterr()
    assert "no service answers" in json.loads(output.out)["error"]["message"]
    assert output.err.count("\n") == 1


def test_where_nobody_listens_a_demo_does_not_wait_as_for_one_that_starts() -> None:
    """Elsewhere it gives up after a few seconds, here at once; a plant that starts has a minute and more."""
    plant = plant_elsewhere("http://127.0.0.1:1", time.sleep)
    assert plant.answer_limit_s <= 10.0 < START_LIMIT_S
    with (
        ServiceClient(plant.url) as service,
        pytest.raises(NotReadyError, match=r"no service answers at http://127.0.0.1:1; waited 0 s"),
    ):
        wait_until_ready(replace(plant, answer_limit_s=0.0), service)


def test_data_of_a_demo_elsewhere_is_wrong_use(tmp_path: Path) -> None:
    assert main(["demo", "--url", "http://127.0.0.1:1", "--data", str(tmp_path)]) == 2


def test_the_plant_of_somebody_else_is_no_demo(repository: Repository, tmp_path: Path) -> None:
    store = FolderStore(tmp_path / "recordings")
    app = create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))
    with (
        serving(app) as client,
        ServiceClient(str(client.base_url)) as service,
        pytest.raises(TruthError, match="watches the demo plant, found one with the relay A"),
    ):
        ask_status(service, lambda healths: [{"B1_SEL710": FAULT_B}] * len(healths))


@pytest.mark.parametrize("motors", [[], ["P-101A"], ["FAN-A2", "P-101A", "P-101B", "P-102"]])
def test_another_plant_is_one_line_and_no_traceback(
    engine: Engine, tmp_path: Path, capsys: pytest.CaptureFixture[str], motors: list[str]
) -> None:
    """Also where a relay has a name of the demo's, and where records are of years ago."""
    repository, store = Repository(engine), FolderStore(tmp_path / "recordings")
    names = ["A2_SEL710", "R1", "R2", "R3"][: len(motors)]
    relays = tuple(relay(name, "SITE", 10300 + number) for number, name in enumerate(names))
    bound = tuple(
        PlantMotor(motor(name), "", "SITE", one.name) for name, one in zip(motors, relays, strict=True)
    )
    repository.sync_plant(Plant((Site("SITE", ""),), relays, bound))
    register_runner(repository)
    for name in motors[-1:]:
        repository.add_recording(store.store({"E.CFF": b"samples"}), motor=name, now_ns=NOW_NS)
        claimed = repository.claim_job(now_ns=NOW_NS, runner=RUNNER)
        assert claimed is not None
        years_ago_ns = NOW_NS - 10 * 365 * NANOSECONDS_PER_DAY
        job = claimed.job.id
        repository.finish_job(
            job, findings_of(fault()), recorded_ns=years_ago_ns, now_ns=NOW_NS, runner=RUNNER
        )
    app = create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))
    with serving(app) as client:
        assert main(["demo-status", "--url", str(client.base_url), "--json"]) == 1
    output = capsys.readouterr()
    message = json.loads(output.out)["error"]["message"]
    assert f"found one with {'P-101A' if motors else 'no motor'}" in message
    assert "mcc motors" in message
    assert [line for line in output.err.splitlines() if line.startswith("mcc:")] == [f"mcc: {message}"]


def test_another_service_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    """It answers 200 to everything, with a document that is not ours."""
    app = FastAPI()

    @app.get("/{path:path}")
    async def answer(path: str) -> dict[str, str]:
        return {"path": path}

    limits = ConnectionLimits(400, 10.0, 20.0, 5.0)
    with listening(app, limits) as port:
        assert main(["demo-status", "--url", f"http://127.0.0.1:{port}"]) == 1
    told = [line for line in capsys.readouterr().err.splitlines() if line.startswith("mcc:")]
    assert len(told) == 1
    assert told[0].endswith("/api/v1/motors: expected a list of items")
