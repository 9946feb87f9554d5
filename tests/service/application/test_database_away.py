"""Commands that find no database: one line that says where it was looked for, and what to do."""

import subprocess
import sys
from pathlib import Path

import pytest

from testing.ports import free_port
from testing.service.processes import service_environment, switched_off_plant

LIMIT_S = 120.0
PASSWORD = "correct-horse"  # noqa: S105 - of no database


@pytest.mark.parametrize("command", ["serve", "collect", "work"])
def test_a_command_whose_database_does_not_answer_says_so_in_one_line(command: str, tmp_path: Path) -> None:
    refused = ended(tmp_path, "-m", "service.cli", command)
    assert_one_line(refused, "mcc: ")


def test_the_account_of_the_demo_says_so_too(tmp_path: Path) -> None:
    file = tmp_path / "token"
    refused = ended(tmp_path, "-m", "service.demo.account", str(file))
    assert_one_line(refused, "")
    assert not file.exists()


def ended(directory: Path, *words: str) -> "subprocess.CompletedProcess[str]":
    """Return how a command ended for which nobody listens at the database's address."""
    port = free_port()
    settings = {
        "MCC_PORT": "0",
        "MCC_SCD": str(switched_off_plant(directory)),
        "MCC_DATABASE_URL": f"postgresql+psycopg://mcc:{PASSWORD}@127.0.0.1:{port}/mcc",
    }
    environment = service_environment(directory / "data", settings)
    return subprocess.run(
        [sys.executable, *words],
        env=environment,
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
    )


def assert_one_line(refused: "subprocess.CompletedProcess[str]", prefix: str) -> None:
    assert refused.returncode == 1
    lines = [line for line in refused.stderr.splitlines() if "[info" not in line]
    (line,) = (line for line in lines if "database_url" in line)
    assert line.startswith(f"{prefix}postgresql+psycopg://mcc:***@127.0.0.1:"), refused.stderr
    assert "is its disk full, or its server down?" in line
    assert "Traceback" not in refused.stderr
    assert PASSWORD not in refused.stderr
