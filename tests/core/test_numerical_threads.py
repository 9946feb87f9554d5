"""Processes of the service leave the cores to each other."""

import os
import subprocess
import sys

import pytest

PROGRAM = """
import os
from service.cli import main
main(["--version"])
import numpy
numpy.ones((9, 9)) @ numpy.ones((9, 9))
print(len(os.listdir("/proc/self/task")))
"""


@pytest.mark.parametrize(("given", "threads"), [(None, 1), ("3", 3)])
def test_mcc_has_one_thread_of_linear_algebra(given: str | None, threads: int) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    if given is not None:
        environment["OPENBLAS_NUM_THREADS"] = given
    command = [sys.executable, "-c", PROGRAM]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    # OpenBLAS starts no more threads than there are cores.
    assert int(done.stdout.splitlines()[-1]) == min(threads, max(os.cpu_count() or 1, 1))
