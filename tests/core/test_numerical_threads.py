"""The library of linear algebra has one thread in what computes, whatever the process has that calls it."""

import os
import subprocess
import sys

import pytest

SCRIPT = """
import numpy
from threadpoolctl import threadpool_info
from core.commissioning.commissioning import commission
from core.diagnosis.stator import diagnose
from core.findings.examining import examine


def threads():
    return {one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"}


class Looked(Exception):
    pass


class Recording:
    def __getattr__(self, name):
        raise Looked(threads())


for compute in (commission, diagnose, examine):
    try:
        compute(Recording(), Recording())
    except Looked as looked:
        print(compute.__name__, *looked.args, threads())
"""


@pytest.mark.skipif((os.cpu_count() or 1) < 2, reason="one thread a processor is one here")
def test_a_caller_without_a_setting_computes_on_one_thread_and_has_its_own_back() -> None:
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "2"}
    found = subprocess.run(
        [sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=True
    )
    names = ("commission", "diagnose", "examine")
    assert found.stdout.splitlines() == [f"{name} {{1}} {{2}}" for name in names]
