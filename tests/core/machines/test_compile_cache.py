"""Machine code of an earlier version of a program is not taken for that of the present one."""

import os
import subprocess
import sys
from pathlib import Path

from tests.docs.pages import ROOT

CALLER = """
from core.machines.compiled import compiled
from program.called import called

@compiled
def caller(x: float) -> float:
    return 10.0 * called(x)
"""
CALLED = """
from core.machines.compiled import compiled
from program.figures import FIGURE

@compiled
def called(x: float) -> float:
    return x + FIGURE
"""
RUN = """
from program.caller import caller
print(caller(1.0), sum(caller.stats.cache_hits.values()))
"""


def run(folder: Path) -> tuple[float, int]:
    """The result of the program in a process of its own, and how often the cache had it."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join((str(folder), str(ROOT)))}
    done = subprocess.run(
        [sys.executable, "-c", RUN], env=environment, capture_output=True, text=True, check=True
    )
    result, hits = done.stdout.split()
    return float(result), int(hits)


def test_a_change_in_what_is_called_or_read_is_noticed(tmp_path: Path) -> None:
    program = tmp_path / "program"
    program.mkdir()
    (program / "__init__.py").write_text("")
    (program / "caller.py").write_text(CALLER)
    (program / "called.py").write_text(CALLED)
    (program / "figures.py").write_text("FIGURE = 1.0\n")
    assert run(tmp_path) == (20.0, 0)
    assert run(tmp_path) == (20.0, 1)
    (program / "called.py").write_text(CALLED.replace("x + FIGURE", "x - FIGURE"))
    assert run(tmp_path) == (0.0, 0)
    (program / "figures.py").write_text("FIGURE = 3.0\n")
    assert run(tmp_path) == (-20.0, 0)
    assert run(tmp_path) == (-20.0, 1)
