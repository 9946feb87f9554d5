"""Tasks that stand in for the diagnosis: the content of the recording's file says what happens."""

import os
import signal
import time
from dataclasses import replace
from pathlib import Path

from core.starts.examined import ExaminedStart, StartStress
from service.jobs.task import Diagnosed, DiagnosisTask, Outcome, Rejected
from service.jobs.worker_process import follow_service
from service.recording_store.recording import LocalFile
from testing.service.findings import findings_of
from testing.service.plants import NOW_NS, SECOND_NS, fault
from testing.service.rotor_and_supply import BROKEN_ROTOR, ECCENTRIC_ROTOR, SUPPLY, SWINGING_LOAD
from testing.service.starts import START
from testing.waiting import wait_until

STRANGE = "channel IA\0\ud800 "
"""What a channel may be called in a record: PostgreSQL cannot hold the one, UTF-8 not the other."""

LONG = "x" * 1_000_000

REJECTIONS = {
    "reject": "E.CFF: line 1: expected a FID, found nothing",
    "reject strange text": STRANGE + LONG,
}

(FINDING,) = fault().quality
RESULTS = {
    "not a number": replace(fault(), mu_f=float("nan"), residual_rms_A=float("nan")),
    "infinite": replace(fault(), mu_f_ci95=(0.0, float("inf"))),
    "minus infinite": replace(fault(), load_level=float("-inf")),
    "not a number deep inside": replace(fault(), quality=(FINDING, replace(FINDING, limit=float("nan")))),
    "huge integer": replace(fault(), evaluations=10**400),
    "huge winding": replace(fault(), theta_f=10**30),  # type: ignore[arg-type]  # no column holds it
    "no such thing": replace(fault(), residual_rms_A=object()),  # type: ignore[arg-type]
    "strange text": replace(fault(), reasons=(STRANGE,)),
    "far too much text": replace(fault(), reasons=(LONG[:3000],) * 200),
}


UNMOUNTING = ("reject as the folder goes", "raise as the folder goes")


def unmount(root: Path) -> None:
    """Take the folder of all recordings away, as a share that is lost; `mount` brings it back."""
    root.rename(root.with_suffix(".elsewhere"))


def mount(root: Path) -> None:
    root.with_suffix(".elsewhere").rename(root)


def lose_the_folder(entry: Path, told: str) -> Outcome:
    unmount(entry.parents[2])
    if told == "raise as the folder goes":
        raise FileNotFoundError(entry)
    return Rejected(f"{entry}: no such file")


def act_as_told(task: DiagnosisTask) -> Outcome:
    assert isinstance(task.recording, LocalFile)
    entry = task.recording.path
    told = entry.read_text()
    first_time = entry.with_suffix(".tried")
    if told in REJECTIONS:
        return Rejected(REJECTIONS[told])
    if told == "raise":
        raise ArithmeticError("no such number")
    if told == "raise strange text":
        raise ArithmeticError(STRANGE + LONG)
    if told in UNMOUNTING and not first_time.exists():
        first_time.touch()
        return lose_the_folder(entry, told)
    if told == "slow":
        time.sleep(0.05)
    if told in RESULTS:
        return Diagnosed(findings_of(RESULTS[told]), NOW_NS)
    if told == "broken bars":
        broken = findings_of(
            fault(),
            rotor=BROKEN_ROTOR,
            supply=SUPPLY,
            eccentricity=ECCENTRIC_ROTOR,
            pulsation=SWINGING_LOAD,
        )
        return Diagnosed(broken, NOW_NS)
    if told == "hot start":
        stress = StartStress(350.0, None, 0.95, None, "motor file", None)
        return Diagnosed(findings_of(fault(), start=ExaminedStart(START, stress=stress)), NOW_NS)
    if told == "year 9999":
        return Diagnosed(findings_of(fault()), 253_402_300_799 * SECOND_NS)
    if told == "die" or (told == "die once" and not first_time.exists()):
        first_time.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if told == "hang" or (told == "hang once" and not first_time.exists()):
        first_time.write_text(str(os.getpid()))
        time.sleep(600)
    return Diagnosed(findings_of(fault()), NOW_NS)


def prepare_when_told(go: Path) -> None:
    """A worker that loads until the file is there."""
    follow_service()
    wait_until(go.exists)


def fail_to_start() -> None:
    raise RuntimeError("this worker cannot start")
