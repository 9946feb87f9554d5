"""A database that another version made: commands refuse it in one line, and leave it as it is."""

import sqlite3
import subprocess
import sys
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

import pytest

from service.storage import migrate
from testing.service.processes import service_environment, switched_off_plant

LIMIT_S = 120.0
FOUND = (
    ", found 0058: another version made them; start that one to export what you need, and this one with a "
    "new, empty database"
)


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """The data of a service whose database has the tables of a revision that nobody knows."""
    directory = tmp_path / "data"
    directory.mkdir()
    migrate(f"sqlite:///{directory / 'statorwatch.sqlite'}")
    with closing(sqlite3.connect(directory / "statorwatch.sqlite")) as database:
        database.execute("UPDATE alembic_version SET version_num = '0058'")
        database.execute("DROP TABLE record_figures")
        database.commit()
    return directory


@pytest.mark.parametrize("command", [["serve"], ["retention", "--dry-run"], ["backup", "list"]], ids=" ".join)
def test_a_database_of_another_version_is_refused_and_left_alone(
    command: Sequence[str], data: Path, tmp_path: Path
) -> None:
    before = contents(data)
    settings = {"MCC_PORT": "0", "MCC_SCD": str(switched_off_plant(tmp_path))}
    refused = subprocess.run(
        [sys.executable, "-m", "service.cli", *command],
        env=service_environment(data, settings),
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
    )
    assert refused.returncode == 1
    (line,) = (line for line in refused.stderr.splitlines() if "database_url" in line)
    assert line.startswith("mcc: database_url: expected tables of revision 0001_"), refused.stderr
    assert line.endswith(FOUND), refused.stderr
    assert "Traceback" not in refused.stderr
    assert contents(data) == before


def contents(data: Path) -> Sequence[str]:
    """All that the database holds, as statements."""
    with closing(sqlite3.connect(data / "statorwatch.sqlite")) as database:
        return list(database.iterdump())
