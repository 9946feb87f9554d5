"""The diagnosis's refinement beside scipy.optimize.least_squares: accuracy, linearisations, time."""

import subprocess
import sys
from collections.abc import Iterator
from math import log1p, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from benchmarks.stopwatch import best_of
from core.diagnosis.case import Case, case_of
from core.diagnosis.fundamental import fundamental_of
from core.diagnosis.methods import Method
from core.diagnosis.refinement import (
    FAULT_LEVEL,
    LOAD_LEVEL,
    OFFSET_SCALE_S,
    TIME_OFFSET,
    Refinement,
    unknown,
)
from core.diagnosis.search import search
from core.machines.candidates import Candidates
from core.machines.parameters import Motor
from core.machines.split_winding import SplitWinding
from core.recordings import Recording
from core.signals.sequence import PhaseSequence
from core.signals.terminals import terminals
from testing.machines.motors import ALL
from testing.machines.phase_circuits import Fault, recording, running

Array = NDArray[np.float64]

RECORDS = 24
NAMES = (FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET)
TOLERANCE = 1e-8
IMPORT = """
from time import perf_counter
import core.diagnosis.stator, numba
begun = perf_counter()
import scipy.optimize
print(perf_counter() - begun)
"""


class ScipyRefinement(Refinement):
    """The same misfit and derivatives, minimised by scipy's trust-region reflective algorithm."""

    def minimise(self, start: Candidates) -> tuple[Array, float, int]:
        """Unknowns, misfit and number of linearisations at the end."""
        unknowns = tuple(unknown(name, self._case, self.running.model) for name in NAMES)
        steps = np.array([one.step for one in unknowns])
        points: dict[bytes, tuple[Array, Array]] = {}

        def linearised(x: Array) -> tuple[Array, Array]:
            key = x.tobytes()
            if key not in points:
                values = dict(zip(NAMES, (x * steps)[:, np.newaxis], strict=True))
                candidate = Candidates(
                    values[FAULT_LEVEL], start.winding, values[LOAD_LEVEL], values[TIME_OFFSET],
                    leakage=start.leakage,
                )  # fmt: skip
                point = self._linearise(candidate, unknowns)
                rows, slopes = point.rows.copy(), point.slopes.copy()
                # Cauchy's prior as one residual: its square is 2 log(1 + offset^2).
                offset = float(candidate.time_offset_s[0]) / OFFSET_SCALE_S
                rows[4] = np.copysign(sqrt(2.0 * log1p(offset**2)), offset)
                slope = 2.0 * offset / (1.0 + offset**2) / rows[4] if offset else sqrt(2.0)
                slopes[4] = [slope / OFFSET_SCALE_S if name == TIME_OFFSET else 0.0 for name in NAMES]
                points[key] = rows, slopes * steps
            return points[key]

        def residual(x: Array) -> Array:
            return linearised(x)[0]

        def jacobian(x: Array) -> Array:
            return linearised(x)[1]

        found = least_squares(
            residual,
            np.clip(
                [getattr(start, one.name)[0] / one.step for one in unknowns],
                [one.lower / one.step for one in unknowns],
                [one.upper / one.step for one in unknowns],
            ),
            jacobian,
            bounds=(
                [one.lower / one.step for one in unknowns],
                [one.upper / one.step for one in unknowns],
            ),
            x_scale="jac",
            xtol=TOLERANCE,
            ftol=TOLERANCE,
            gtol=TOLERANCE,
        )
        return found.x * steps, 2.0 * float(found.cost), len(points)


def _records() -> Iterator[tuple[Recording, Motor]]:
    random = np.random.default_rng(11)
    for number in range(RECORDS):
        motor = ALL[number % len(ALL)]
        level = float(random.choice([0.0, 0.005, 0.02, 0.05, 0.15]))
        operation = running(
            motor,
            float(random.uniform(0.1, 1.0)),
            fault=Fault(level, int(random.integers(3))) if level else None,
            unbalance=complex(*random.normal(scale=0.008, size=2)),
        )
        yield (
            recording(
                operation,
                seconds=0.5,
                noise=0.005,
                current_delay_s=float(random.uniform(0.0, 2e-4)),
                seed=number,
            ),
            motor,
        )


def _case(record: Recording, motor: Motor) -> Case:
    measured = terminals(record)
    if measured.voltage_ab is None:
        raise ValueError("the record has no voltages")
    frequency = motor.nameplate.rated_frequency_Hz
    return case_of(
        motor, measured.current_abc, measured.voltage_ab, record.sample_rate_hz, frequency, PhaseSequence.ABC
    )


def _compared(refinement: ScipyRefinement, start: Candidates) -> tuple[float, float, float, float, float]:
    """Misfits, how far apart the fault levels are, linearisations; ours before scipy's."""
    ours = refinement.fit(start, NAMES)
    values, misfit, rounds = refinement.minimise(start)
    apart = abs(ours.value(FAULT_LEVEL) - float(values[0]))
    return ours.misfit, misfit, apart, ours.evaluations / (1 + 2 * len(NAMES)), float(rounds)


def measure() -> Iterator[str]:
    """Lines of figures, ours beside scipy's in one run."""
    model = SplitWinding()
    prepared = []
    for record, motor in _records():
        case = _case(record, motor)
        starts = search(case, model, Method.HYBRID)
        prepared.append((ScipyRefinement(case, fundamental_of(case), model, starts.best), starts))
    begins = [(refinement, start) for refinement, found in prepared for start in found.by_winding]
    pairs = np.array([_compared(refinement, start) for refinement, start in begins])
    fits, levels = len(pairs), pairs[:, 2]
    better = pairs[:, 1] - pairs[:, 0]
    equal = np.abs(better) <= 1e-3 * (1.0 + pairs[:, 0])
    ours = best_of(5, lambda: [refinement.fit(start, NAMES) for refinement, start in begins])
    theirs = best_of(5, lambda: [refinement.minimise(start) for refinement, start in begins])
    yield (
        f"{fits} fits: the same minimum {int(equal.sum())}, ours lower {int((better[~equal] > 0).sum())}, "
        f"scipy's lower {int((better[~equal] < 0).sum())}; where the same, fault levels apart by "
        f"{levels[equal].max():.1e} at most"
    )
    yield (
        f"linearisations, mean and most: ours {pairs[:, 3].mean():.1f}, {pairs[:, 3].max():.0f}; "
        f"scipy's {pairs[:, 4].mean():.1f}, {pairs[:, 4].max():.0f}"
    )
    yield f"a fit: ours {ours / fits * 1e3:.2f} ms, scipy's {theirs / fits * 1e3:.2f} ms"
    taken = min(_import_seconds() for _ in range(3))
    yield f"import of scipy.optimize in a process that diagnoses: {taken * 1e3:.0f} ms"


def _import_seconds() -> float:
    command = [sys.executable, "-c", IMPORT]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
