"""`mcc commission --from-service`: starts that the service recorded become parameters in the motors file."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

from core.machines.parameters import ParametersSource
from core.operation import Operation
from core.recordings import Recording, comtrade
from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.problems import Problems
from service.configuration.settings import Settings
from service.jobs.task import Diagnosed, DiagnosisTask
from service.jobs.worker import diagnose_recording
from service.plant.motors_file import read_motors_file
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running
from testing.machines.starts import StartRecord
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

MOTOR = "PUMP-A1"
MOTORS = """# The motors of the plant.
[[motor]]
name = "FAN-A2"  # the spare one
[motor.nameplate]
rated_power_W = 800
rated_voltage_V = 380
rated_frequency_Hz = 50
pole_pairs = 2

# The feed pump.
[[motor]]
name = "PUMP-A1"
schedule = "30 6 * * MON"  # before the shift

[motor.nameplate]  # as on the plate
rated_power_W = 800
rated_voltage_V = 380
rated_frequency_Hz = 50
pole_pairs = 2

# One bus.
[[bus]]
name = "FACTORY_A/LV"
"""


@dataclass
class Here:
    """A service that is told of recordings and diagnoses them at once."""

    url: str
    repository: Repository
    store: RecordingStore
    folder: Path
    number: int = 0

    def add(self, record: Recording) -> str:
        self.number += 1
        now_ns = NOW_NS + self.number * SECOND_NS
        path = comtrade.write(
            self.folder / f"E{self.number}.CFG",
            replace(record, start_time_ns=now_ns),
            revision=2013,
            data_format="FLOAT32",
        )
        files = {each.name: each.read_bytes() for each in (path, path.with_suffix(".DAT"))}
        stored = self.store.store(files)
        added = self.repository.add_recording(stored, motor=MOTOR, now_ns=now_ns).recording
        claimed = self.repository.claim_job(now_ns=now_ns, runner=RUNNER)
        assert claimed is not None
        motor = replace(REFERENCE, name=MOTOR, parameters_source=ParametersSource.TYPICAL)
        done = diagnose_recording(
            DiagnosisTask(self.store.source(stored.digest), motor, "hybrid", "split-winding")
        )
        assert isinstance(done, Diagnosed)
        self.repository.finish_job(
            claimed.job.id,
            done.findings,
            recorded_ns=done.recorded_ns,
            now_ns=now_ns,
            runner=RUNNER,
        )
        return added.id

    def has_parameters(self, source: ParametersSource) -> None:
        plant = two_motor_plant()
        motors = (replace(one, motor=replace(one.motor, parameters_source=source)) for one in plant.motors)
        self.repository.sync_plant(replace(plant, motors=tuple(motors)))


@pytest.fixture
def here(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[Here]:
    app = create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))
    records = tmp_path / "records"
    records.mkdir()
    with serving(app) as client:
        yield Here(str(client.base_url), repository, store, records)


@pytest.fixture
def motors(tmp_path: Path) -> Path:
    path = tmp_path / "motors.toml"
    path.write_text(MOTORS, "utf-8")
    return path


def start(**how: float) -> Recording:
    return StartRecord(duration_s=0.4, snr_db=45.0, **how).of(REFERENCE)  # type: ignore[arg-type]


def commission(here: Here, motors: Path, *more: str) -> int:
    return main(["commission", "--from-service", MOTOR, "--write", str(motors), "--url", here.url, *more])


def test_recorded_starts_become_parameters_and_all_else_stays(
    here: Here, motors: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    usable = [here.add(start(load_level=0.6)), here.add(start(load_level=0.2))]
    late = here.add(cut(start(load_level=0.4), 0.06))
    here.add(recording(running(REFERENCE, 0.5), noise=0.003))
    health = main(["health", MOTOR, "--url", here.url])
    assert health == 0
    shown = " ".join(capsys.readouterr().out.replace("\N{BOX DRAWINGS LIGHT VERTICAL}", " ").split())
    assert f"2 starts were recorded: mcc commission --from-service {MOTOR} --write motors.toml" in shown

    offer = f"{MOTOR}: 2 starts were recorded: mcc commission --from-service {MOTOR}"
    for source, offered in ((ParametersSource.TYPICAL, True), (ParametersSource.GIVEN, False)):
        here.has_parameters(source)
        assert main(["motors", "--url", here.url]) == 0
        assert (offer in capsys.readouterr().out) is offered

    assert commission(here, motors, "--json") == 0
    printed = capsys.readouterr()
    document = json.loads(printed.out)
    assert document["recordings"] == usable[::-1]
    assert len(document["left_out"]) == 1
    assert late in document["left_out"][0]
    assert "began before the record" in printed.err
    motor = read_motors_file(motors, Problems()).motors[MOTOR]
    parameters, intervals = motor.data["parameters"], motor.data["intervals"]
    assert isinstance(parameters, dict)
    assert isinstance(intervals, dict)
    assert parameters["source"] == "commissioned"
    assert parameters["stator_resistance_ohm"] == pytest.approx(8.4, rel=0.01)
    low, high = intervals["stator_resistance_ohm"]
    assert low < parameters["stator_resistance_ohm"] < high
    assert motors.with_name("motors.toml.bak").read_text("utf-8") == MOTORS
    text = motors.read_text("utf-8")
    before, _, after = text.partition("[motor.parameters]")
    assert before == MOTORS.partition("\n# One bus.")[0] + "\n"
    assert after.endswith(MOTORS.partition("pole_pairs = 2\n\n# One bus.")[2])
    assert [line for line in document["diff"].splitlines()[2:] if line.startswith("-")] == []


def cut(record: Recording, first_s: float) -> Recording:
    first = round(first_s * record.sample_rate_hz)
    return replace(record, samples=record.samples[:, first:], trigger_index=None)


def test_one_recording_may_be_chosen(here: Here, motors: Path, capsys: pytest.CaptureFixture[str]) -> None:
    chosen, _ = here.add(start(load_level=0.6)), here.add(start(load_level=0.2))
    assert commission(here, motors, "--recording", chosen) == 0
    shown = capsys.readouterr().out
    assert "restart mcc serve" in shown
    assert "+[motor.parameters]" in shown.splitlines()
    assert chosen in motors.read_text("utf-8")


def test_what_cannot_be_used_leaves_the_file_as_it_is(
    here: Here, motors: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert commission(here, motors) == 1
    assert "no start of it was recorded yet" in capsys.readouterr().err
    ran = here.add(recording(running(REFERENCE, 0.5), noise=0.003))
    assert commission(here, motors, "--recording", ran) == 1
    assert "a motor already running" in capsys.readouterr().err
    assert main(["commission", "--from-service", "PUMP-A2", "--write", str(motors), "--url", here.url]) == 2
    assert "did you mean PUMP-A1?" in capsys.readouterr().err
    assert motors.read_text("utf-8") == MOTORS
    assert not motors.with_name("motors.toml.bak").exists()


def test_parameters_that_no_such_motor_has_are_not_written(
    here: Here, motors: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The currents are half of what they are: the file's parameters are not met."""
    given = REFERENCE.parameters
    known = "\n".join(
        ["[motor.parameters]", *(f"{name} = {getattr(given, name)}" for name in given.__dataclass_fields__)]
    )
    text = MOTORS.replace("pole_pairs = 2\n\n# One bus.", f"pole_pairs = 2\n{known}\n\n# One bus.")
    motors.write_text(text, "utf-8")
    record = start(load_level=0.6)
    small = replace(record, samples=np.vstack([0.5 * record.samples[:3], record.samples[3:]]))
    here.add(small)
    assert commission(here, motors) == 1
    assert "the parameters are not written" in capsys.readouterr().err
    assert motors.read_text("utf-8") == text
    assert commission(here, motors, "--despite-warnings") == 0
    assert 'source = "commissioned"' in motors.read_text("utf-8")


def test_a_service_says_what_each_recording_shows(here: Here, capsys: pytest.CaptureFixture[str]) -> None:
    here.add(start(load_level=0.6))
    late = here.add(cut(start(load_level=0.4), 0.06))
    ran = here.add(recording(running(REFERENCE, 0.5), noise=0.003))
    found = {one.id: one for one in here.repository.recordings(limit=9).items}
    assert found[ran].operation is Operation.RUNNING
    assert found[late].operation is Operation.START
    assert "began before the record" in (found[late].operation_remark or "")
    command = ["recordings", "list", MOTOR, "--operation", "start", "--url", here.url, "--json"]
    assert main(command) == 0
    listed = json.loads(capsys.readouterr().out)["recordings"]
    assert [one["operation"] for one in listed] == ["start", "start"]
    assert "began before the record" in listed[0]["operation_remark"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--from-service", "M"], "needs --write MOTORS.toml"),
        (["--from-service", "M", "--write", "m.toml", "--output", "o.toml"], "takes no RECORD"),
        (["--write", "m.toml"], "go with --from-service MOTOR"),
        ([], "expected RECORD..."),
        (["START.CFG"], "expected RECORD..."),
    ],
)
def test_what_does_not_go_together_is_wrong_use(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["commission", *arguments]) == 2
    told = capsys.readouterr()
    assert message in " ".join((told.err + told.out).split())
