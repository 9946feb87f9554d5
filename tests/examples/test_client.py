"""The examples of the Python client, against a service in a process of its own and a simulated relay."""

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from service.client.credentials import headers_for
from testing.service.processes import running_service, simulated_plant
from tests.docs.pages import ROOT

MOTOR, RELAY = "PUMP-A1", "A1_SEL710"

pytestmark = pytest.mark.timeout(300)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, str]]:
    """The address of a service, and a file with a token for it."""
    folder = tmp_path_factory.mktemp("plant")
    with (
        simulated_plant(folder, [RELAY]) as plant,
        running_service(folder, plant.scd, MCC_POLL_PERIOD_S="1") as service,
    ):
        token = folder / "statorwatch.token"
        token.write_text(headers_for(service.url)["Authorization"].removeprefix("Bearer "))
        yield service.url, str(token)


def run(example: str, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-W", "error", str(ROOT / "examples" / example), *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)


def test_a_recording_is_triggered_and_its_trend_read(place: tuple[str, str]) -> None:
    url, token = place
    before = run("trend_to_pandas.py", url, MOTOR, token)
    assert before.stdout == f"{MOTOR}: no recordings yet\n", before.stderr
    done = run("trigger_and_wait.py", url, MOTOR, token)
    assert done.returncode == 0, done.stderr
    verdict, archive = done.stdout.splitlines()
    assert re.fullmatch(rf"{MOTOR}: healthy, -?\d\.\d{{3}}% of the turns", verdict)
    assert re.fullmatch(r"\S+\.zip: \d{4,} bytes", archive)
    after = run("trend_to_pandas.py", url, MOTOR, token)
    assert after.returncode == 0, after.stderr
    heading, _index, *rows, median = after.stdout.splitlines()
    assert heading.split() == ["level_percent", "verdict"]
    assert [row.split()[-1] for row in rows] == ["healthy"]
    assert re.fullmatch(r"median of a day: -?\d\.\d{3} %", median)


def test_a_motor_that_is_not_there_is_told(place: tuple[str, str]) -> None:
    url, token = place
    done = run("trigger_and_wait.py", url, "NONE", token)
    assert done.returncode == 1
    assert done.stderr.startswith("refused with HTTP status 404: ")


def test_a_wrong_token_is_told(place: tuple[str, str], tmp_path: Path) -> None:
    token = tmp_path / "token"
    token.write_text("nobody-has-this-token\n")
    done = run("trigger_and_wait.py", place[0], MOTOR, str(token))
    assert done.stderr.startswith("refused with HTTP status 401: ")
