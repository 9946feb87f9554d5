"""Tasks that stand in for the diagnosis: the content of the recording's file says what happens."""

import os
import signal
import time
from dataclasses import replace
from pathlib import Path

from service.jobs import Diagnosed, DiagnosisTask, Outcome, Rejected
from service.jobs.worker_process import follow_service
from testing.service.plants import NOW_NS, fault
from testing.waiting import wait_until

GO = "STAND_IN_GO"
"""Environment variable with the path of the file that lets a worker go on."""


def act_as_told(task: DiagnosisTask) -> Outcome:
    told = task.entry.read_text()
    first_time = task.entry.with_suffix(".tried")
    if told == "reject":
        return Rejected("E.CFF: line 1: expected a FID, found nothing")
    if told == "raise":
        raise ArithmeticError("no such number")
    if told == "not a number":
        return Diagnosed(replace(fault(), mu_f=float("nan"), residual_rms_A=float("nan")), NOW_NS)
    if told == "die" or (told == "die once" and not first_time.exists()):
        first_time.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if told == "hang" or (told == "hang once" and not first_time.exists()):
        first_time.write_text(str(os.getpid()))
        time.sleep(600)
    return Diagnosed(fault(), NOW_NS)


def prepare_when_told() -> None:
    """A worker that loads until the file named in the environment is there."""
    follow_service()
    wait_until(lambda: Path(os.environ[GO]).exists())


def fail_to_start() -> None:
    raise RuntimeError("this worker cannot start")
