"""`mcc demo --once`: what a newcomer sees first."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import cast

import pytest

from service.client.rest_client import ServiceClient
from service.demo.addresses import free_ports
from service.demo.plant import SERVICE_PORT, running_plant
from service.process.single_instance import exclusive
from testing.service.processes import MOTOR_NAMES, descendants, is_alive
from testing.waiting import eventually

pytestmark = pytest.mark.timeout(300)
"""On a loaded machine a demo takes its time to start, and one waits for the other to end."""

RECORD_S = 1.0
"""0.2 s before the trigger, 0.8 s after it."""

SLOWNESS = 2.0
"""Of a machine that others slow down from outside; one motor after the other would take more than that."""


@pytest.fixture(autouse=True)
def _one_demo_at_a_time(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The demo's times are measured here: two at once would measure each other."""
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
    assert document["seconds"] <= 60.0 * crowding()
    assert [motor["motor"] for motor in document["motors"]] == sorted(MOTOR_NAMES)
    for motor in document["motors"]:
        assert motor["motor"] in table
        assert len(motor["diagnoses"]) == 2
        for diagnosis in motor["diagnoses"]:
            agrees_with_truth(motor["truth"], diagnosis)
        quickest = min(diagnosis["trigger_to_diagnosis_seconds"] for diagnosis in motor["diagnoses"])
        assert 0.8 < quickest <= SLOWNESS * (RECORD_S + 3.0 * crowding()), "all six at once"
    assert "at most" in table
    assert "…" not in table
    assert len(seen) >= 4, "a simulator, a service, a collector, workers"
    assert eventually(lambda: not any(is_alive(process_id) for process_id in seen), 5)


def crowding() -> float:
    """Processes that want a processor for each one there is: other tests run beside this one."""
    return max(1.0, os.getloadavg()[0] / len(os.sched_getaffinity(0)))


def agrees_with_truth(truth: dict[str, float | None], diagnosis: dict[str, object]) -> None:
    """Same verdict and phase, level within a tenth of itself and in its interval, load within 5 points."""
    assert diagnosis["theta_f"] == truth["theta_f"]
    assert diagnosis["verdict"] == ("healthy" if truth["theta_f"] is None else "fault")
    mu_f, load_level = diagnosis["mu_f"], diagnosis["load_level"]
    assert isinstance(mu_f, float)
    assert isinstance(load_level, float)
    assert truth["mu_f"] is not None
    assert truth["load_level"] is not None
    assert abs(mu_f - truth["mu_f"]) < 0.003 + 0.1 * truth["mu_f"]
    low, high = cast("list[float]", diagnosis["mu_f_ci95"])
    assert low <= truth["mu_f"] <= high
    assert abs(load_level - truth["load_level"]) < 0.05


def test_the_demo_can_be_interrupted_on_its_way_up(tmp_path: Path) -> None:
    results = tmp_path / "results.json"
    with start_demo(tmp_path, "--once", "--json", str(results)) as demo:
        assert eventually(lambda: len(descendants(demo.pid)) >= 2, 30), "the simulator and the service"
        below = descendants(demo.pid)
        demo.send_signal(signal.SIGTERM)
        assert demo.stderr is not None
        assert "mcc: interrupted" in demo.stderr.read()
    assert demo.returncode == 1
    assert json.loads(results.read_text())["error"]["message"] == "interrupted"
    assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 5)


@pytest.mark.campaign
@pytest.mark.timeout(900)
def test_a_month_has_a_short_a_broken_bar_and_a_voltage_channel_that_drifts(
    tmp_path: Path,
) -> None:
    said: dict[str, list[str]] = {motor: [] for motor in MOTOR_NAMES}
    with start_demo(tmp_path) as demo:
        assert demo.stdout is not None
        assert demo.stdout.readline().startswith("page: http://127.0.0.1:")
        for line in demo.stdout:
            if line.startswith("Conditions and truth"):
                break
            _, _, motor, text = line.split(maxsplit=3)
            said[motor].append(text)
        demo.send_signal(signal.SIGINT)
    fan, mill = said.pop("FAN-A2"), said.pop("MILL-A3")
    compressor, pump = said.pop("COMPRESSOR-B2"), said.pop("PUMP-B3")
    cage = said.pop("PUMP-A1")
    states = [text.partition(":")[0].split()[0] for text in fan]
    assert list(dict.fromkeys(states)) == ["healthy", "watch", "fault"]
    assert fan[-1].startswith("fault: shorted turns b")
    assert [text for text in mill if text.startswith("fault")] == []
    assert mill[-1].startswith("watch: voltage channel b")
    assert compressor[-1].startswith("fault: shorted turns a")
    assert cage[0].startswith("healthy")
    assert cage[-1].startswith("fault: broken rotor bars")
    assert [text for text in cage if "shorted turns" in text] == []
    assert {text.split()[0] for text in pump} <= {"unknown", "healthy"}, "it stands still from day 4 on"
    assert {text for texts in said.values() for text in texts if not text.startswith("healthy")} == set()


@pytest.mark.campaign  # plays a round, as others do, to see how the demo ends after it
def test_ctrl_c_ends_the_endless_demo(tmp_path: Path) -> None:
    with start_demo(tmp_path) as demo:
        assert demo.stdout is not None
        assert any(line.startswith("day") for line in demo.stdout), "what is said of the first motor"
        below = descendants(demo.pid)
        demo.send_signal(signal.SIGINT)
        assert demo.stderr is not None
        words = demo.stderr.read()
    assert demo.returncode == 0, words
    assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 5)


def test_a_simulator_that_dies_ends_the_demo(tmp_path: Path) -> None:
    with start_demo(tmp_path) as demo:
        assert eventually(lambda: len(descendants(demo.pid)) >= 2, 30), "the simulator and the service"
        below = descendants(demo.pid)
        os.kill(next(process_id for process_id in below if is_simulator(process_id)), signal.SIGKILL)
        assert demo.stderr is not None
        words = demo.stderr.read()
    assert demo.returncode == 1, words
    assert "mcc: ied-sim ended (exit code -9)" in words
    assert eventually(lambda: not any(is_alive(process_id) for process_id in below), 5)


@pytest.mark.campaign
def test_a_port_lost_before_the_start_is_replaced(tmp_path: Path) -> None:
    chosen = [SERVICE_PORT]
    told: list[str] = []
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]

        def too_late(wanted: int) -> int:
            chosen.append(port if len(chosen) == 1 else free_ports(1)[0])
            return chosen[-1]

        with (
            running_plant(tmp_path, time.sleep, told.append, choose_port=too_late) as plant,
            ServiceClient(plant.url) as service,
        ):
            assert len(list(service.items("/motors"))) == len(MOTOR_NAMES)
    assert chosen[1] == port
    assert len(chosen) == 3
    assert plant.url == f"http://127.0.0.1:{chosen[2]}"
    assert f"port 8710 is taken; the API answers on {plant.url} (export MCC_URL={plant.url})" in told


def is_simulator(process_id: int) -> bool:
    return b"--files" in Path(f"/proc/{process_id}/cmdline").read_bytes()


def start_demo(data: Path, *options: str) -> "subprocess.Popen[str]":
    command = [sys.executable, "-m", "service.cli", "demo", "--data", str(data), *options]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
