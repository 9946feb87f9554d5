"""`mcc demo --once`: what a newcomer sees first."""

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from service.exclusive import exclusive
from tests.integration.processes import MOTOR_NAMES, descendants, eventually, is_alive


@pytest.fixture(autouse=True)
def _one_demo_at_a_time(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Two demos that start at the same moment both find the plant's own ports free."""
    with exclusive(tmp_path_factory.getbasetemp().parent / "demo.lock", wait=True):
        yield


def test_the_demo_finds_the_truth_and_leaves_nothing_running(tmp_path: Path) -> None:
    results = tmp_path / "results.json"
    command = [sys.executable, "-m", "service.cli", "demo", "--once", "--json", str(results)]
    with subprocess.Popen(
        [*command, "--data", str(tmp_path / "data")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as demo:
        seen: set[int] = set()
        while demo.poll() is None:
            seen |= set(descendants(demo.pid))
            eventually(lambda: demo.poll() is not None, 0.5)
        assert demo.stdout is not None
        assert demo.stderr is not None
        table, progress = demo.stdout.read(), demo.stderr.read()
    assert demo.returncode == 0, progress
    document = json.loads(results.read_text())
    assert document["seconds"] <= 60
    assert [motor["motor"] for motor in document["motors"]] == sorted(MOTOR_NAMES)
    for motor in document["motors"]:
        assert motor["motor"] in table
        assert len(motor["diagnoses"]) == 2
        for diagnosis in motor["diagnoses"]:
            agrees_with_truth(motor["truth"], diagnosis)
            assert 0 < diagnosis["trigger_to_diagnosis_seconds"] < 20
    assert len(seen) >= 4, "a simulator, a service, a collector, workers"
    assert eventually(lambda: not any(is_alive(process_id) for process_id in seen), 5)


def agrees_with_truth(truth: dict[str, float | None], diagnosis: dict[str, object]) -> None:
    """Same verdict, phase, level within a point, load within a few."""
    assert diagnosis["theta_f"] == truth["theta_f"]
    assert diagnosis["verdict"] == ("healthy" if truth["theta_f"] is None else "fault")
    mu_f, load_level = diagnosis["mu_f"], diagnosis["load_level"]
    assert isinstance(mu_f, float)
    assert isinstance(load_level, float)
    assert truth["mu_f"] is not None
    assert truth["load_level"] is not None
    assert abs(mu_f - truth["mu_f"]) < 0.01
    assert abs(load_level - truth["load_level"]) < 0.08


def test_the_demo_can_be_interrupted_on_its_way_up(tmp_path: Path) -> None:
    with endless_demo(tmp_path) as demo:
        assert eventually(lambda: len(descendants(demo.pid)) >= 2, 30), "the simulator and the service"
        below = descendants(demo.pid)
        demo.send_signal(signal.SIGTERM)
        assert demo.stderr is not None
        assert "mcc: interrupted" in demo.stderr.read()
    assert demo.returncode == 1
    assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 5)


def test_ctrl_c_ends_the_endless_demo(tmp_path: Path) -> None:
    with endless_demo(tmp_path) as demo:
        assert demo.stdout is not None
        assert any("s in all" in line for line in demo.stdout), "the first round's table"
        below = descendants(demo.pid)
        demo.send_signal(signal.SIGINT)
        assert demo.stderr is not None
        words = demo.stderr.read()
    assert demo.returncode == 0, words
    assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 5)


def endless_demo(data: Path) -> "subprocess.Popen[str]":
    command = [sys.executable, "-m", "service.cli", "demo", "--data", str(data)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
