"""A whole diagnosis: gate, HCPA, refinement of every hypothesis, verdict, for a 10 kHz record."""

from collections.abc import Iterator
from functools import partial

from benchmarks.stopwatch import best_of
from core.diagnosis.stator import diagnose
from tests.core.motors import ALL
from tests.core.phase_circuits import Fault, recording, running

THESIS_SECONDS = 106.0
"""The improved HCPA's 524 evaluations in Table 6.1."""


def measure() -> Iterator[str]:
    for seconds in (0.5, 1.0):
        for motor in ALL:
            record = recording(running(motor, 0.5, fault=Fault(0.05, 1)), seconds=seconds, noise=0.005)
            result = diagnose(record, motor)
            taken = best_of(5, partial(diagnose, record, motor))
            yield (
                f"{seconds:.1f} s record, {motor.name:10s}: {taken * 1e3:7.1f} ms, "
                f"{result.evaluations} evaluations, {result.verdict} {result.phase} {result.mu_f:.4f} "
                f"(truth 0.0500), {THESIS_SECONDS / taken:.0f} times faster than the thesis"
            )
