"""What holds for all tests: their order, and how many processes run them."""

import os
from collections.abc import Sequence
from pathlib import PurePath

import pytest
from hypothesis import settings

# How long an example takes says more about what else the machine is doing: times are benchmarks' business.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")

LONGEST_FIRST = (
    "tests/integration",
    "tests/service/demo",
    "tests/hostile",
    "tests/service/collector",
    "tests/service",
    "tests/ied_sim",
)
"""Files with long tests come first, so that no process is left alone with one at the end."""

PROCESSES_OF_A_CORE = 2
"""Tests of relays and services wait for half of their time."""


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    del config
    return PROCESSES_OF_A_CORE * len(os.sched_getaffinity(0))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    items.sort(key=lambda item: _rank(PurePath(item.nodeid.partition("::")[0]), LONGEST_FIRST))


def _rank(file: PurePath, folders: Sequence[str]) -> int:
    """Place of the first folder that holds the file; behind all of them where none does."""
    return next((k for k, folder in enumerate(folders) if file.is_relative_to(folder)), len(folders))
