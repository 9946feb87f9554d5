"""docs/first-plant.md, followed literally in a fresh folder, ends with the verdicts that it promises."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import pytest

from service.demo.addresses import free_ports
from tests.docs.pages import ROOT

PAGE = (ROOT / "docs" / "first-plant.md").read_text(encoding="utf-8")
PORTS = ("10500", "10501", "10502", "10503", "10504")
"""Of the service and of the relays."""
LIMIT_S = 240

TRUTH = {
    "P-101A": "healthy",
    "P-101B": r"fault: shorted turns (b|in phase b \(9\d %\) or \w \(\d %\))",
    "K-201": "healthy",
    "M-202": "healthy",
}
"""Two records may leave the phase just short of the 95 % from which on it is named alone."""


def script() -> str:
    """The page's commands, in their order: all that is changed is the ports, which may be taken here."""
    blocks: list[str] = re.findall(r"^```sh\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    text = "\n".join(blocks)
    for port, free in zip(PORTS, free_ports(len(PORTS)), strict=True):
        assert port in text
        text = text.replace(port, str(free))
    return text


def programs(folder: Path) -> None:
    """Put the page's programs into a folder, as an installation puts them beside its Python."""
    for name, module in (("mcc", "service.cli"), ("ied-sim", "ied_sim"), ("python", None)):
        command = f'exec "{sys.executable}" ' + (f'-m {module} "$@"' if module else '"$@"')
        (folder / name).write_text(f"#!/bin/sh\n{command}\n", encoding="ascii")
        (folder / name).chmod(0o755)


def followed(folder: Path, environment: Mapping[str, str]) -> tuple[int | None, str]:
    """Run the page's commands; returns the exit code, None after too long, and what they print."""
    printed = folder.with_name("printed")
    with (
        printed.open("wb") as output,
        subprocess.Popen(
            ["bash", "-e", "-c", script()],
            cwd=folder,
            env=environment,
            stdout=output,
            stderr=output,
            start_new_session=True,
        ) as shell,
    ):
        try:
            shell.wait(LIMIT_S)
        except subprocess.TimeoutExpired:
            pass
        finally:
            with suppress(ProcessLookupError):  # what a failed page leaves running
                os.killpg(shell.pid, signal.SIGKILL)
    return shell.poll() if shell.returncode != -signal.SIGKILL else None, printed.read_text()


WAITING = re.findall(r"^until .*\n(?:kill -0 .*\n)?", PAGE, re.MULTILINE)


@pytest.mark.parametrize("lines", WAITING)
def test_waiting_ends_with_the_process_waited_for(tmp_path: Path, lines: str) -> None:
    """A port may be taken: the process ends, and its log says why."""
    for log in ("relays.log", "service.log"):
        (tmp_path / log).write_text("address already in use", encoding="ascii")
    commands = f"false & relays=$! service=$!; wait $relays || true\n{lines}"
    told = subprocess.run(
        ["/bin/bash", "-e", "-c", commands],
        cwd=tmp_path,
        env={"PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        timeout=30,
        check=True,
    ).stdout
    assert ("address already in use" in told) is ("cat " in lines)


@pytest.mark.campaign
@pytest.mark.timeout(LIMIT_S + 60)
def test_the_page_ends_with_its_verdicts(tmp_path: Path) -> None:
    (tmp_path / "bin").mkdir()
    (tmp_path / "fresh").mkdir()
    programs(tmp_path / "bin")
    environment = {name: value for name, value in os.environ.items() if not name.startswith("MCC_")} | {
        "PATH": f"{tmp_path / 'bin'}:{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "XDG_CONFIG_HOME": str(tmp_path / "config"),
        "COLUMNS": "120",
    }
    ended, told = followed(tmp_path / "fresh", environment)
    logs = "".join(path.read_text() for path in (tmp_path / "fresh").glob("*.log"))
    assert ended == 0, f"{told}\n{logs}"
    assert "16 values to fill in" in told
    assert "16 problems: mcc serve would not start" in told
    assert "breakdown torque" in told
    assert "nothing is wrong: 4 motors, 4 relays" in told
    assert "collecting; commission me" in told
    assert re.search(r"^P-101B: fault in phase b, [5-7]\.", told, re.MULTILINE), told
    for motor in ("P-101A", "M-202", "K-201"):
        assert re.search(rf"^{motor}: healthy, ", told, re.MULTILINE), told
    rows = {motor: re.findall(rf"^ +{motor} +(\S.*?) {{2,}}", told, re.MULTILINE) for motor in TRUTH}
    for motor, truth in TRUTH.items():
        assert re.fullmatch(truth, rows[motor][-1]), told
    assert "Traceback" not in told + logs
    assert '"level": "error"' not in logs
