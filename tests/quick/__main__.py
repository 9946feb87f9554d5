"""`python -m tests.quick [--seconds 60] [--since COMMIT]`: the tests that a change can break most directly.

Beside them run ruff and mypy on the files that changed. It ends with 1 where one of all these fails.
"""

import argparse
import os
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import grimp

from tests.quick.budget import END, FAILED, NO_TIME, SECONDS, read_seconds, within
from tests.quick.changes import changed_files, changed_modules, module_of, texts_of
from tests.quick.reach import Reached, imports_of, reached_tests

ROOT: Final = Path(__file__).parents[2]
KEPT: Final = ".quick"
TAKEN: Final = "seconds.json"
"""Folder and file: what tests took, and the imports of modules that did not change; git does not know it."""
END_S: Final = 15.0
"""No test begins that would end later than so long before the end."""
STOP_S: Final = 10.0
"""Tests that take longer than was known are stopped so long before the end."""
SHOWN: Final = 12
STYLES: Final = (["check"], ["format", "--check"])
NO_TESTS: Final = 5
"""Exit code of pytest where all of them are campaigns."""


def main(budget_s: float, since: str | None) -> int:
    """Return the exit code: 0 where nothing failed."""
    end_s = time.time() + budget_s
    files = changed_files(ROOT, since)
    python = [file for file in files if "/" in file and module_of(file) and (ROOT / file).exists()]
    types = _start("mypy", *python) if python else None
    styles = [_start("ruff", *words, *python).wait() for words in STYLES if python]
    reached = reached_by(files)
    chosen = within(reached, read_seconds(ROOT / KEPT / TAKEN), end_s - END_S - time.time())
    _say(f"{len(files)} files changed; {len(reached)} test files reach them by imports, {len(chosen)} run")
    tests = run_tests(chosen, ROOT, end_s=end_s - END_S, stop_s=end_s - STOP_S) if chosen else 0
    checked = _finished(types, end_s)
    left = [one for one in reached if one not in chosen]
    if left:
        _say(f"left out, no time: {len(left)} files; the nearest:")
    for one in left[:SHOWN]:
        _say(f"  {one.file} ({one.distance} imports away)")
    if types is not None and checked is None:
        _say("left out, no time: mypy; it keeps what it has read for the next run")
    _say(f"a test that was skipped with {NO_TIME!r} did not run either; make test and make lint run all")
    return 1 if any((*styles, tests, checked)) else 0


def reached_by(files: Sequence[str]) -> list[Reached]:
    """Return the test files that a change of files can break, nearest first."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    packages = project["tool"]["importlinter"]["root_packages"]
    graph = grimp.build_graph(*packages, cache_dir=str(ROOT / KEPT / "imports"))
    return reached_tests(sorted(changed_modules(files, graph.modules, texts_of(ROOT))), imports_of(graph))


def _say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def _start(tool: str, *arguments: str) -> "subprocess.Popen[bytes]":
    return subprocess.Popen([str(Path(sys.executable).with_name(tool)), *arguments], cwd=ROOT)


def run_tests(chosen: Sequence[Reached], root: Path, *, end_s: float, stop_s: float) -> int:
    """Run test files of a tree; return 0 where none failed.

    end_s: when the last test is to be through.  stop_s: when those are stopped that are not [s since 1970].
    """
    failed, seconds = root / KEPT / FAILED, root / KEPT / TAKEN
    command = [sys.executable, "-m", "pytest", "-q", "-m", "not campaign", "-n", "2", "-r", "fE"]
    command += ["-p", "tests.quick.budget", "-p", "no:cacheprovider", *(one.file for one in chosen)]
    environment = {**os.environ, END: str(end_s), SECONDS: str(seconds)}
    failed.unlink(missing_ok=True)
    running = subprocess.Popen(command, cwd=root, env=environment)
    try:
        ended = running.wait(max(0.0, stop_s - time.time()))
    except subprocess.TimeoutExpired:  # in a test of which it was not known that it takes so long
        running.send_signal(signal.SIGINT)
        running.wait()
        _say("stopped, no time: what had begun did not end")
        return int(failed.exists())
    return 0 if ended == NO_TESTS else ended


def _finished(types: "subprocess.Popen[bytes] | None", end_s: float) -> int | None:
    """Return the exit code of mypy; None where there is none in time, and end it."""
    if types is None:
        return None
    try:
        return types.wait(max(0.0, end_s - time.time()))
    except subprocess.TimeoutExpired:
        types.terminate()
        types.wait()
        return None


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m tests.quick", description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="all in all; 60 if not given")
    parser.add_argument("--since", help="a commit to compare with, in place of where the branch left main")
    given = parser.parse_args()
    sys.exit(main(given.seconds, given.since))
