"""Tasks that stand in for the diagnosis: the content of the recording's file says what happens."""

import os
import signal
import time
from dataclasses import replace

from service.jobs import Diagnosed, DiagnosisTask, Outcome, Rejected
from tests.service.plants import NOW_NS, fault


def act_as_told(task: DiagnosisTask) -> Outcome:
    told = task.entry.read_text()
    first_time = task.entry.with_suffix(".tried")
    if told == "reject":
        return Rejected("E.CEV: line 1: expected a FID, found nothing")
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


def fail_to_start() -> None:
    raise RuntimeError("this worker cannot start")
