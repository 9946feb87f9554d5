"""Samples, states, phasors, spectrum and the model's currents over REST, of real recordings."""

import csv
import io
import json
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import replace
from typing import Any

import httpx
import numpy as np
import pytest
from numpy.typing import NDArray

from core.recordings import Channel, Quantity
from service.api import ApiContext, create_app
from service.storage import Repository
from service.waveforms.computing import NoAnswerError
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault
from testing.service.plants import NOW_NS
from testing.service.real_recordings import BREAKER, PICKED_UP, add_recording, running_record
from tests.service.api.serving import serving

MISSING = "00000000-0000-0000-0000-000000000000"


@pytest.fixture
def motors_known(context: ApiContext) -> ApiContext:
    """A context that knows the motors' parameters, as the service's has."""
    return replace(context, motors={"PUMP-A1": REFERENCE})


@pytest.fixture
def looking(motors_known: ApiContext) -> Iterator[httpx.Client]:
    with serving(create_app(motors_known)) as client:
        yield client


@pytest.fixture
def faulty(context: ApiContext) -> str:
    """A diagnosed recording with shorted turns in phase b."""
    record = running_record(fault=Fault(0.05, 1))
    return add_recording(context.repository, context.store, record)


def decoded(content: bytes) -> tuple[dict[str, Any], NDArray[np.float32]]:
    """Read what the browser reads."""
    length = int.from_bytes(content[:4], "little")
    head = json.loads(content[4 : 4 + length])
    return head, np.frombuffer(content[4 + length :], "<f4").reshape(len(head["columns"]), head["count"])


def get(client: httpx.Client, recording: str, what: str, **query: Any) -> httpx.Response:
    return client.get(f"/api/v1/recordings/{recording}/{what}", params=query)


def test_a_part_is_given_to_the_sample(looking: httpx.Client, faulty: str) -> None:
    answer = get(looking, faulty, "samples", from_s=0.2, to_s=0.24)
    head, figures = decoded(answer.content)
    assert answer.headers["content-type"] == "application/octet-stream"
    assert (head["count"], head["samples"], head["recording_samples"]) == (161, 161, 2400)
    assert (head["first_s"], head["trigger_s"]) == (0.2, 0.1)
    assert head["start_time"].startswith("2025-10-09T08:53:20")
    named = [(one["name"], one["group"], one["phase"], one["unit"]) for one in head["columns"][1:]]
    assert named[0] == ("IA", "currents", "a", "A")
    assert named[4] == ("VB", "voltages", "b", "V")
    record = running_record(fault=Fault(0.05, 1))
    for row in range(6):
        np.testing.assert_allclose(figures[1 + row], record.samples[row, 800:961], atol=0.02)


def test_a_long_recording_comes_as_extremes(looking: httpx.Client, faulty: str) -> None:
    head, figures = decoded(get(looking, faulty, "samples", points=100).content)
    assert (head["count"], head["samples"]) == (100, 2400)
    assert {one["of"] for one in head["columns"]} == {"time", "minimum", "maximum"}
    assert (figures[1] <= figures[2]).all()


def test_the_model_s_currents_leave_what_the_diagnosis_says(looking: httpx.Client, faulty: str) -> None:
    head, figures = decoded(get(looking, faulty, "model", points=20_000).content)
    diagnosis = looking.get(f"/api/v1/recordings/{faulty}").json()["diagnosis"]
    assert diagnosis["verdict"] == "fault"
    assert diagnosis["fit"]["theta_f"] == 1
    assert head["residual_rms_A"] == pytest.approx(diagnosis["residual_rms_A"], rel=1e-9)
    names = [(one["name"], one["phase"]) for one in head["columns"][1:]]
    assert names == [(kind, p) for kind in ("measured", "modelled", "residual") for p in "abc"]
    measured, modelled, residual = figures[1:].reshape(3, 3, -1)
    np.testing.assert_allclose(measured - modelled, residual, atol=1e-5)
    assert np.abs(residual[:, 100:]).max() < 0.1 * np.abs(measured).max()
    head, _ = decoded(get(looking, faulty, "model", from_s=0.3, to_s=0.32).content)
    assert head["samples"] == 81


def test_phasors_at_a_cursor(looking: httpx.Client, faulty: str) -> None:
    found = get(looking, faulty, "phasors", at_s=0.3).json()
    assert found["frequency_hz"] == pytest.approx(50.0, abs=0.01)
    assert (found["sequence"], found["reference"]) == ("abc", "V1")
    names = [one["name"] for one in found["phases"]]
    assert names == ["Va", "Vb", "Vc", "Ia", "Ib", "Ic"]
    components = {one["name"]: one for one in found["components"]}
    assert components["V1"]["angle_deg"] == pytest.approx(0.0, abs=1e-9)
    assert components["V1"]["magnitude"] == pytest.approx(380 / 3**0.5, rel=0.01)
    assert found["current_unbalance"] > 0.02, "shorted turns unbalance the currents"
    assert found["voltage_unbalance"] < 0.001


def test_the_spectrum_has_the_supply_and_says_what_it_cannot_tell(looking: httpx.Client, faulty: str) -> None:
    found = get(looking, faulty, "spectrum", points=300).json()
    assert len(found["frequency_hz"]) == len(found["a_dB"]) <= 300
    supply = next(line for line in found["lines"] if line["label"] == "f")
    assert supply["frequency_hz"] == pytest.approx(50.0, abs=0.01)
    assert found["slip"] == pytest.approx(0.02, abs=0.02)
    assert found["last_s"] - found["first_s"] < found["seconds_for_sidebands"]


def test_states_by_their_changes(looking: httpx.Client, faulty: str) -> None:
    found = get(looking, faulty, "states").json()
    assert found["duration_s"] == pytest.approx(0.6)
    breaker, picked_up = found["states"]
    assert (breaker["name"], breaker["begins_with"], breaker["changes_s"]) == (BREAKER, True, [])
    assert (picked_up["name"], picked_up["begins_with"]) == (PICKED_UP, False)
    assert picked_up["changes_s"] == pytest.approx([0.2, 0.25])


def test_csv_has_every_sample_and_state(looking: httpx.Client, faulty: str) -> None:
    answer = get(looking, faulty, "csv")
    assert answer.headers["content-disposition"] == 'attachment; filename="PUMP-A1_2025-10-09T08-53-20Z.csv"'
    heading, *rows = csv.reader(io.StringIO(answer.text))
    assert heading[:2] + heading[-3:] == ["time_s", "IA (A)", "VC (V)", BREAKER, PICKED_UP]
    assert len(rows) == 2400
    assert [row[-1] for row in (rows[799], rows[800], rows[999], rows[1000])] == ["0", "1", "1", "0"]
    record = running_record(fault=Fault(0.05, 1))
    assert float(rows[1234][2]) == pytest.approx(record.samples[1, 1234], abs=0.02)


def test_a_channel_s_name_is_no_formula(looking: httpx.Client, context: ApiContext) -> None:
    record = running_record()
    spare = Channel("=HYPERLINK(1)", Quantity.OTHER, None, "A", 10.0)
    record = replace(
        record, channels=(*record.channels, spare), samples=np.vstack([record.samples, record.samples[:1]])
    )
    recording = add_recording(context.repository, context.store, record, diagnosed=False)
    heading = get(looking, recording, "csv").text.splitlines()[0]
    assert "'=HYPERLINK(1) (A)" in heading


@pytest.mark.parametrize("what", ["samples", "model", "csv", "phasors", "spectrum", "states"])
def test_a_recording_that_there_is_not(looking: httpx.Client, what: str) -> None:
    assert get(looking, MISSING, what).status_code == 404


def test_what_cannot_be_told_is_said(
    looking: httpx.Client, context: ApiContext, repository: Repository
) -> None:
    fetched = add_recording(repository, context.store, running_record(), diagnosed=False)
    answer = get(looking, fetched, "model")
    assert (answer.status_code, answer.json()["detail"]) == (409, "the recording is not diagnosed yet")
    bare = running_record()
    bare = replace(bare, samples=bare.samples[3:], channels=bare.channels[3:], start_time_ns=NOW_NS + 10**9)
    voltages = add_recording(repository, context.store, bare, diagnosed=False)
    for what in ("phasors", "spectrum"):
        answer = get(looking, voltages, what)
        assert answer.status_code == 409
        assert "current" in answer.json()["detail"]
    assert get(looking, voltages, "samples").is_success


def test_a_motor_that_the_plant_has_no_more(context: ApiContext, faulty: str) -> None:
    with serving(create_app(context)) as client:
        answer = get(client, faulty, "model")
        assert answer.status_code == 409
        assert "not in the plant's files" in answer.json()["detail"]
        assert get(client, faulty, "phasors").is_success


def test_workers_that_are_gone_are_told_as_busy(motors_known: ApiContext, faulty: str) -> None:
    def nobody(_function: object, _argument: object, /) -> "Future[Any]":
        future: Future[Any] = Future()
        future.set_exception(NoAnswerError("the worker processes ended and are started again"))
        return future

    with serving(create_app(replace(motors_known, compute=nobody))) as client:
        answer = get(client, faulty, "model")
    assert answer.status_code == 503
    assert "no worker has drawn" in answer.json()["detail"]


@pytest.mark.parametrize("query", [{"points": 1}, {"points": 10**9}, {"from_s": "nan"}, {"to_s": 1e300}])
def test_queries_are_bounded(looking: httpx.Client, faulty: str, query: dict[str, Any]) -> None:
    assert get(looking, faulty, "samples", **query).status_code == 422
