"""What is loaded before it is known which command is meant."""

import subprocess
import sys

SLOW = {"alembic", "fastapi", "httpx", "lxml", "numba", "numpy", "pandas", "scipy", "sqlalchemy"}
"""Each takes longer to load than the help of a command may take."""


def test_the_names_of_the_commands_load_no_database_and_no_numbers() -> None:
    code = "import sys, service.cli.app; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert "service.cli.commands.access" in loaded.split()
    assert SLOW & set(loaded.split()) == set()
