"""A signal ends a start between two of its steps, and no process that loads is hit by one."""

import signal
import subprocess
import sys

import pytest

START = """
import os, signal, sys, time
from service.process import termination

termination.LONGEST_STEP_S = float(sys.argv[1])
ending = termination.Termination()
try:
    with ending.heeded():
        ending.step()
        try:
            os.kill(os.getpid(), signal.{number})
            time.sleep(float(sys.argv[2]))
        except Exception:
            print("an error in a library")
        print("the step is done")
        ending.step()
        print("the next step")
finally:
    print("everything is closed")
"""

SWALLOWED = START.replace("except Exception", "except BaseException")
"""A library that swallows what comes out of a handler must not keep the service running."""

CHILD = """
import os, signal
from service.process.termination import leave_to_parent
print(sorted(number.name for number in signal.pthread_sigmask(signal.SIG_BLOCK, ())))
os.kill(os.getpid(), signal.SIGTERM)
leave_to_parent(signal.SIGTERM, signal.SIGINT)
os.kill(os.getpid(), signal.SIGINT)
print(sorted(number.name for number in signal.pthread_sigmask(signal.SIG_BLOCK, ())))
"""

PARENT = f"""
import signal, subprocess, sys
from service.process.termination import held_back
with held_back(signal.SIGTERM, signal.SIGINT):
    child = subprocess.Popen([sys.executable, "-c", {CHILD!r}])
sys.exit(child.wait() or len(signal.pthread_sigmask(signal.SIG_BLOCK, ())))
"""


@pytest.mark.parametrize("number", ["SIGTERM", "SIGINT"])
@pytest.mark.parametrize("program", [START, SWALLOWED])
def test_the_step_is_done_and_no_other_begins(program: str, number: str) -> None:
    ended = python(program.replace("{number}", number), "5", "0")
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout == "the step is done\neverything is closed\n"


def test_a_step_that_takes_long_is_interrupted() -> None:
    ended = python(START.replace("{number}", "SIGTERM"), "0.05", "60")
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout == "everything is closed\n"


def test_a_process_that_loads_is_hit_by_no_signal() -> None:
    ended = python(PARENT)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout == f"{[signal.SIGINT.name, signal.SIGTERM.name]}\n[]\n"


def python(program: str, *arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-c", program, *arguments], capture_output=True, text=True, timeout=60, check=False
    )
