"""Other choices of the level where dead-shorted turns and paths both hold, on the records of the paths."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import product

import numpy as np

from benchmarks.accuracy.resistive_paths import (
    GOOD,
    LOADS,
    MOTORS,
    PROTECTION,
    PathDraw,
    described,
    leakage_ratio,
    record_path,
)
from benchmarks.reporting import spread, table
from core.diagnosis.case import case_of
from core.diagnosis.fundamental import fundamental_of
from core.diagnosis.methods import DEFAULT_METHOD
from core.diagnosis.paths import DEAD_SHORTED, PATH_SHARES, PathPosterior
from core.diagnosis.propagation import Known
from core.diagnosis.refinement import FAULT_LEVEL, Refinement
from core.diagnosis.search import search
from core.diagnosis.stator import diagnose
from core.machines.base import Array
from core.machines.parameters import Motor
from core.machines.split_winding import SplitWinding
from core.quality import examine
from core.recordings import Recording
from core.signals.terminals import terminals

RATIOS = (0.0, 0.25, 0.5, 1.0, 2.0)
TURNS = ((0.02, 0.04), (0.06, 0.12))
TWO_THIRDS = 2.0 / 3.0
HEADER = (
    "turns", "path", "dead-shorted: probability", "likelier hypothesis", "median", "mean",
    "dead-shorted from 2/3 on", "ampere-turns",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Choices:
    """Relative errors of the level by each choice, and of the ampere-turns by the posterior's mean; the
    probability of dead-shorted turns."""

    dead: float
    likelier: float
    median: float
    mean: float
    two_thirds: float
    ampere_turns: float


def choose(draw: PathDraw) -> Choices | None:
    """Make the record and take the level from its posterior in each way; None if it is not diagnosable."""
    motor, condition, record = record_path(draw)
    posterior = _posterior(record, motor)
    diagnosed = diagnose(record, motor).mu_f
    if posterior is None or diagnosed is None:
        return None
    levels, probability = posterior.levels, posterior.probability
    dead = float(probability[0])
    likeliest_path = float(levels[1 + int(np.argmax(probability[1:]))])
    doubtful = DEAD_SHORTED <= dead < TWO_THIRDS
    truth = condition.equivalent_level
    ratios = PATH_SHARES / (1.0 - PATH_SHARES)
    linked = float(probability @ _ampere_turns(motor, levels, ratios))
    linked_truth = float(_ampere_turns(motor, np.array([truth]), np.array([condition.path_ratio]))[0])
    return Choices(
        dead=dead,
        likelier=diagnosed / truth - 1.0,
        median=posterior.quantile(FAULT_LEVEL, 0.5) / truth - 1.0,
        mean=float(probability @ levels) / truth - 1.0,
        two_thirds=(likeliest_path if doubtful else diagnosed) / truth - 1.0,
        ampere_turns=linked / linked_truth - 1.0,
    )


def level_choices(*, records: int, pool: Executor) -> Iterator[str]:
    """A table for each group of motors and class of sensors, `records` a load."""
    for motors, sensors in product(MOTORS, (GOOD, PROTECTION)):
        cells = list(product(TURNS, RATIOS))
        draws = [
            PathDraw(ratio, loads, sensors, k, motors, turns)
            for turns, ratio in cells
            for loads in LOADS
            for k in range(records)
        ]
        title = f"{described(motors)}. Sensors: {sensors.name}."
        found = list(spread(choose, draws, f"choices, {title}", pool))
        yield title
        yield ""
        n = len(LOADS) * records
        rows = [
            [f"{turns[0]:.0%} to {turns[1]:.0%}", f"{ratio:g}", *_row(found[k * n : (k + 1) * n])]
            for k, (turns, ratio) in enumerate(cells)
        ]
        yield from table(HEADER, rows)
        yield ""


def _posterior(record: Recording, motor: Motor) -> PathPosterior | None:
    """Posterior of a record, as the diagnosis makes it; None where a check fails."""
    channels = motor.channels
    measured = terminals(
        record,
        currents=channels.currents,
        phase_voltages=channels.phase_voltages,
        line_voltages=channels.line_voltages,
    )
    _, passed = examine(measured, motor)
    if passed is None:
        return None
    case = case_of(
        motor,
        measured.current_abc,
        passed.voltage_ab,
        measured.sample_rate_hz,
        passed.frequency_hz,
        passed.sequence,
    )
    model = SplitWinding()
    starts = search(case, model, DEFAULT_METHOD)
    return PathPosterior(case, Refinement(case, fundamental_of(case), model, starts.best), Known())


def _ampere_turns(motor: Motor, level: Array, path_ratio: Array) -> Array:
    """Ampere-turns of bridged turns, but for a constant: mu / |R_s (1 + p) + j X_ls|."""
    impedance = np.abs(1.0 + path_ratio + 1j * leakage_ratio(motor))
    return np.asarray(level * (1.0 + path_ratio) / impedance)


def _row(found: list[Choices | None]) -> list[str]:
    seen = [one for one in found if one is not None]
    low, high = np.quantile([one.dead for one in seen], [0.1, 0.9])
    errors = [
        np.array([getattr(one, name) for one in seen])
        for name in ("likelier", "median", "mean", "two_thirds", "ampere_turns")
    ]
    return [
        f"{low:.2f} to {high:.2f}",
        *(f"{np.median(error):+.0%}, {np.quantile(np.abs(error), 0.9):.0%}" for error in errors),
    ]
