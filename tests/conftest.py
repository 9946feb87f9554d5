"""What holds for all tests: their order, how many processes run them, and where their files lie."""

import os
import shutil
from pathlib import PurePath

import pytest
from hypothesis import settings

from testing.memory_folder import memory_folder
from testing.service.accounts import keep_apart

# How long an example takes says more about what else the machine is doing: times are benchmarks' business.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

BUSY = ("tests/integration", "tests/service/demo", "tests/service/jobs")
WAITING = ("tests/service/collector", "tests/hostile")
"""Folders of long tests: those that start services keep a core busy, those of relays mostly wait."""

LAST = "tests/web"
"""Tests in a browser: Playwright leaves a running event loop in its process, in which `asyncio.run` fails."""

PROCESSES_OF_A_CORE = 2


FILES_BYTES = 4 * 1024**3
"""More than the files of all tests need."""


def pytest_configure(config: pytest.Config) -> None:
    """Have the tests' files lie in memory where there is room: commits of databases wait for a disk.

    What tests log in with is kept apart.
    """
    del config
    keep_apart()
    folder = memory_folder()
    if folder is not None and shutil.disk_usage(folder).free >= FILES_BYTES:
        os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", str(folder))


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """Half of the tests' time is waiting."""
    del config
    return PROCESSES_OF_A_CORE * len(os.sched_getaffinity(0))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run long tests first, busy files and waiting ones in turns, so that no core is idle, browsers last."""
    files = dict.fromkeys(_file(item) for item in items)
    places = {file: float(len(files)) for file in files}
    for folders in (BUSY, WAITING):
        group = [file for file in files if any(file.is_relative_to(folder) for folder in folders)]
        places |= {file: number / len(group) for number, file in enumerate(group)}
    places |= {file: len(files) + 1.0 for file in files if file.is_relative_to(LAST)}
    items.sort(key=lambda item: places[_file(item)])


def _file(item: pytest.Item) -> PurePath:
    return PurePath(item.nodeid.partition("::")[0])
