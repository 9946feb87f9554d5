"""A whole diagnosis, from gate to verdict, for a 10 kHz record: by its evidence, and by searches."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from time import perf_counter, process_time
from typing import ParamSpec, TypeVar
from unittest.mock import patch

import numpy as np

from benchmarks.stopwatch import best_of, processor_time_of
from core.diagnosis.stator import diagnose
from core.findings.examining import examine
from core.machines.parameters import Motor
from core.machines.playback import Playback
from core.machines.running import SteadyRunning
from core.recordings import Recording
from testing.machines.motors import ALL
from testing.machines.phase_circuits import Fault, recording, running

P = ParamSpec("P")
T = TypeVar("T")
THESIS_SECONDS = 106.0
"""The improved HCPA's 524 evaluations in Table 6.1."""
FIRST_CALL = """
from time import perf_counter
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
record = recording(running(REFERENCE, 0.5, fault=Fault(0.05, 1)), seconds=0.5, noise=0.005)
begun = perf_counter()
from core.diagnosis.stator import diagnose
diagnose(record, REFERENCE)
print(perf_counter() - begun)
"""


def measure() -> Iterator[str]:
    yield from by_evidence()
    for method in ("hybrid", "hcpa"):
        for seconds in (0.5, 1.0):
            for motor in ALL:
                record = recording(running(motor, 0.5, fault=Fault(0.05, 1)), seconds=seconds, noise=0.005)
                result = diagnose(record, motor, method=method)
                taken = best_of(7, partial(diagnose, record, motor, method=method))
                yield (
                    f"{method:6s} {seconds:.1f} s record, {motor.name:10s}: {taken * 1e3:6.1f} ms, "
                    f"{_share_in_model(record, motor, method):4.0%} of it in the model, "
                    f"{result.evaluations} evaluations, {result.verdict} {result.phase} {result.mu_f:.4f} "
                    f"(truth 0.0500), {THESIS_SECONDS / taken:.0f} times faster than the thesis"
                )
    for motor in ALL:
        record = recording(running(motor, 0.5, fault=Fault(0.05, 1)), seconds=0.5, noise=0.005)
        parts = {
            "one pass over its samples": partial(np.add.reduce, record.samples, axis=1),
            "diagnosis": partial(diagnose, record, motor),
            "examination of it all": partial(examine, record, motor),
        }
        spent = (f"{name} {1e3 * processor_time_of(25, part):.2f} ms" for name, part in parts.items())
        yield f"processor time, 0.5 s record, {motor.name:10s}: {', '.join(spent)}"
    first = best_of(3, _first_call)
    yield f"a fresh process, machine code cached: {first:.2f} s from its start to its end"


def by_evidence() -> Iterator[str]:
    """Yield the processor time of a diagnosis as it is by default, without shorted turns and with them."""
    for motor in ALL:
        for words, fault in (("healthy", None), ("5 % of the turns", Fault(0.05, 1))):
            record = recording(running(motor, 0.5, fault=fault), seconds=0.5, noise=0.005)
            taken = _processor_time(partial(diagnose, record, motor))
            yield f"evidence, {motor.name:10s}, {words}: {taken * 1e3:.1f} ms of processor"


def _processor_time(work: Callable[[], object]) -> float:
    """Least processor time of some calls [s]; all threads count."""
    work()
    taken = []
    for _ in range(30):
        begun = process_time()
        work()
        taken.append(process_time() - begun)
    return min(taken)


def _share_in_model(record: Recording, motor: Motor, method: str) -> float:
    """Time inside the machine models over that of the whole diagnosis, median of several."""
    shares = []
    for _ in range(7):
        inside, depth = [0.0], [0]

        def timed(
            function: Callable[P, T], spent: list[float] = inside, depth: list[int] = depth
        ) -> Callable[P, T]:
            def call(*args: P.args, **kwargs: P.kwargs) -> T:
                depth[0] += 1
                begun = perf_counter()
                try:
                    return function(*args, **kwargs)
                finally:
                    depth[0] -= 1
                    # Playback asks SteadyRunning for its beginning: only the outer call counts.
                    spent[0] += perf_counter() - begun if depth[0] == 0 else 0.0

            return call

        with (
            patch.object(Playback, "squared_error", timed(Playback.squared_error)),
            patch.object(Playback, "trajectories", timed(Playback.trajectories)),
            patch.object(SteadyRunning, "state", timed(SteadyRunning.state)),
        ):
            begun = perf_counter()
            diagnose(record, motor, method=method)
            shares.append(inside[0] / (perf_counter() - begun))
    return sorted(shares)[len(shares) // 2]


def _first_call() -> None:
    subprocess.run([sys.executable, "-c", FIRST_CALL], check=True, capture_output=True)
