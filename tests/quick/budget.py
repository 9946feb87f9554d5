"""A budget of time for tests, from what each of them took before; and the pytest plugin that keeps to it."""

import json
import os
import time
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from tests.quick.reach import Reached

PROCESSES = 2
START_S = 8.0
"""Processes and their imports take so long before the first test."""
COLLECT_S = 0.2
"""Each process imports each test file."""
UNKNOWN_S = 3.0
"""A test file of which nothing is known takes about so long, on average."""
UNKNOWN_TEST_S = 6.0
"""Hardly a test takes longer."""

END = "STATORWATCH_QUICK_END"
SECONDS = "STATORWATCH_QUICK_SECONDS"
"""Environment: when the last test is to be through [s since 1970], and the file of what each test took."""

FAILED = "failed"
"""A file beside that, where a test failed: pytest does not say so of a run that was stopped."""

NO_TIME = "no time for it"


def read_seconds(path: Path) -> dict[str, float]:
    """Return what each test took [s] when it last ran."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def within(tests: Sequence[Reached], seconds: Mapping[str, float], budget_s: float) -> list[Reached]:
    """Return the tests to run, from the first on, without those that would take longer than what is left."""
    taken: defaultdict[str, float] = defaultdict(float)
    for test, second in seconds.items():
        taken[test.partition("::")[0]] += second
    left = (budget_s - START_S) * PROCESSES
    chosen = []
    for one in tests:
        needed = PROCESSES * COLLECT_S + taken.get(one.file, UNKNOWN_S)
        if needed <= left:
            left -= needed
            chosen.append(one)
    return chosen


class Budget:
    """Runs files in the order of the command line, begins no test too late, notes what each took."""

    def __init__(self, path: Path, end_s: float) -> None:
        self._path = path
        self._end_s = end_s
        self._before = read_seconds(path)
        self._taken: defaultdict[str, float] = defaultdict(float)
        self._skipped: set[str] = set()

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, config: pytest.Config, items: list[pytest.Item]) -> None:
        """Nearest first; those in a browser last (tests/conftest.py says why)."""
        order = {config.rootpath / name: place for place, name in enumerate(config.args)}
        items.sort(key=lambda item: ("tests/web/" in item.nodeid, order[item.path]))

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        if time.time() + self._before.get(item.nodeid, UNKNOWN_TEST_S) > self._end_s:
            pytest.skip(NO_TIME)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self._path.with_name(FAILED).touch()
        if report.skipped:
            self._skipped.add(report.nodeid)
        elif report.nodeid not in self._skipped:
            self._taken[report.nodeid] += report.duration

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        if not hasattr(session.config, "workerinput"):
            kept = {**self._before, **{test: round(second, 3) for test, second in self._taken.items()}}
            self._path.parent.mkdir(exist_ok=True)
            self._path.write_text(json.dumps(kept, indent=0, sort_keys=True), encoding="utf-8")


def pytest_configure(config: pytest.Config) -> None:
    """Take the budget that `python -m tests.quick` gives."""
    config.pluginmanager.register(Budget(Path(os.environ[SECONDS]), float(os.environ[END])))
