"""Chapter 5 by the Hyperbolic Cross Point Algorithm alone: as the thesis has it, and what brings it to 10 %.

The cost of a start has narrow valleys along which the unknowns trade against each other; steps along single
coordinates do not follow them. `in_principal_axes` searches along the valleys instead: no local method, the
same algorithm in boxes whose axes are those of the residuals' slopes.
"""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult

from benchmarks.optimisers.start_problems import LOWER, TRUTH, UPPER, Box
from benchmarks.reporting import spread, table
from core.commissioning.start import Start
from core.commissioning.start_detection import start_of
from core.optimisers import hcpa
from testing.machines.motors import REFERENCE
from testing.machines.starts import StartRecord, plate_of

Array = NDArray[np.float64]

OFFSET_REACH_S = 5e-4
"""Either side of the T_d that is seen between the onsets of voltage and current."""
FEW = 1_000
"""Evaluations of the variants, where they do not say otherwise."""
BOXES, SHRINKING = 10, 0.75
SLOPE_STEP = 1e-3
"""Of the difference quotients, of the box."""
WITHIN = 0.1


@dataclass(frozen=True, slots=True)
class Hcpa:
    """Settings of a search: adaptiveness, fineness, exclusion, budgets."""

    adaptiveness: float
    fineness: int
    exclusion: float
    max_global: int
    max_local: int


FIG_5_2 = Hcpa(1.0, 15, 0.0, 500, 500)
FIG_5_3 = Hcpa(0.2, 10, 0.15, 200, 300)
SECTION_5_4 = Hcpa(0.2, 10, 0.3, 200, 100)
DEEP = Hcpa(0.4, 40, 0.0, FEW // 2, FEW // 2)


def search(
    cost: Callable[[Array], Array], bounds: list[tuple[float, float]], settings: Hcpa
) -> OptimizeResult:
    """HCPA alone."""
    return hcpa.minimise(
        cost, bounds, batch=True,
        adaptiveness=settings.adaptiveness, fineness=settings.fineness, exclusion=settings.exclusion,
        max_global=settings.max_global, max_local=settings.max_local,
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Problem:
    """A start's cost and the box that is searched, lower and upper (7,)."""

    box: Box
    lower: Array
    upper: Array

    def at(self, unit: Array) -> Array:
        """Points of the box from points of the unit cube, (m, 7); those outside it are put on its face."""
        return np.asarray(self.lower + np.clip(unit, 0.0, 1.0) * (self.upper - self.lower))


Found = tuple[Array, int]
"""A point (7,) and the simulations it took."""
UNIT = [(0.0, 1.0)] * 7


def plain(problem: Problem, settings: Hcpa) -> Found:
    """Over the box as it is."""
    result = search(lambda unit: problem.box.cost(problem.at(unit)), UNIT, settings)
    return problem.at(result.x), result.nfev


def in_combinations(problem: Problem) -> Found:
    """Over R_s + R_r', which limits the inrush, and R_s's share of it in place of the two."""

    def at(unit: Array) -> Array:
        points = problem.at(unit)
        least, most = (problem.lower[:2].sum(), problem.upper[:2].sum())
        share = problem.lower[0] / (problem.lower[0] + problem.upper[1])
        total, part = least + unit[:, 0] * (most - least), share + unit[:, 1] * (1.0 - 2.0 * share)
        points[:, 0], points[:, 1] = total * part, total * (1.0 - part)
        return np.clip(points, problem.lower, problem.upper)

    result = search(lambda unit: problem.box.cost(at(unit)), UNIT, DEEP)
    return at(result.x[np.newaxis])[0], result.nfev


def in_boxes(problem: Problem, *, turned: bool) -> Found:
    """In ever smaller boxes about the best point so far, a tenth of the evaluations each.

    turned: along the principal axes of the residuals' slopes at that point; else along the coordinates.
    """
    best, least, half, simulations = np.full(7, 0.5), np.inf, 0.5, 0
    each = replace(DEEP, max_global=FEW // BOXES // 2, max_local=FEW // BOXES // 2)
    for _ in range(BOXES):
        axes = np.eye(7)
        if turned:
            axes = _principal_axes(problem, best)
            simulations += 2 * best.size
        middle, reach = best, 2.0 * half

        def unit_at(inner: Array, middle: Array = middle, reach: float = reach, axes: Array = axes) -> Array:
            return np.asarray(middle + reach * (inner - 0.5) @ axes.T)

        def cost(inner: Array, unit_at: Callable[[Array], Array] = unit_at) -> Array:
            return problem.box.cost(problem.at(unit_at(inner)))

        result = search(cost, UNIT, each)
        simulations += result.nfev
        if result.fun < least:
            best, least = np.clip(unit_at(result.x), 0.0, 1.0), float(result.fun)
        half *= SHRINKING
    return problem.at(best), simulations


def _principal_axes(problem: Problem, unit: Array) -> Array:
    """Eigenvectors of J'J, J the residuals' slopes in the unit cube: (7, 7), by column."""
    steps = SLOPE_STEP * np.eye(unit.size)
    residuals = problem.box.residuals(problem.at(np.concatenate([unit + steps, unit - steps])))
    slopes = residuals[: unit.size] - residuals[unit.size :]
    return np.asarray(np.linalg.eigh(slopes @ slopes.T)[1])


def _whole(start: Start) -> Problem:
    return Problem(Box(start, None), LOWER, UPPER)


def _offset_seen(start: Start) -> Problem:
    if start.offset_hint_s is None:
        raise ValueError(f"{start.source}: its voltages were live before the start, so T_d is not seen")
    lower, upper = LOWER.copy(), UPPER.copy()
    lower[6], upper[6] = start.offset_hint_s - OFFSET_REACH_S, start.offset_hint_s + OFFSET_REACH_S
    return Problem(Box(start, None), lower, upper)


VARIANTS: dict[str, Callable[[Start], Found]] = {
    "as in section 5.4: 200 + 100 points, alpha 0.2, epsilon 0.3": lambda start: plain(
        _whole(start), SECTION_5_4
    ),
    "as in Fig. 5.2: 500 + 500 points, alpha 1, no exclusion": lambda start: plain(_whole(start), FIG_5_2),
    "(1) deeper: alpha 0.4, L0 40, no exclusion, 5,000 points": lambda start: plain(
        _whole(start), replace(DEEP, max_global=2_500, max_local=2_500)
    ),
    "(2) T_d as the onsets of voltage and current show it, alpha 0.4, L0 40": lambda start: plain(
        _offset_seen(start), DEEP
    ),
    "(3) as (2), R_s + R_r' and R_s's share of it for the two": lambda start: in_combinations(
        _offset_seen(start)
    ),
    "(4) as (2), ten boxes of 100 points, each 0.75 of the last": lambda start: in_boxes(
        _offset_seen(start), turned=False
    ),
    "(5) as (4), along the principal axes of the residuals' slopes": lambda start: in_boxes(
        _offset_seen(start), turned=True
    ),
}
BEST = tuple(VARIANTS)[-1]


def alone(task: tuple[str, StartRecord]) -> tuple[Array, int]:
    """Relative errors (5,) of a variant on a record of the thesis's motor, and its simulations."""
    name, record = task
    start = start_of(record.of(REFERENCE), REFERENCE.nameplate, plate_of(REFERENCE).channels)
    point, simulations = VARIANTS[name](start)
    return np.asarray(point[:5] / TRUTH - 1.0), simulations


def lines(records: list[StartRecord], best: Array, pool: Executor) -> list[str]:
    """The comparison on some records; best: errors (trials, 5) of BEST on all of them."""
    rows = []
    for name in VARIANTS:
        found = list(spread(alone, [(name, record) for record in records], name, pool))
        wrong = np.abs([errors for errors, _ in found])
        rows.append(
            [
                name,
                f"{np.median([count for _, count in found]):.0f}",
                ", ".join(f"{100 * value:.1f}" for value in np.median(wrong, axis=0)),
                f"{100 * np.median(wrong.max(axis=1)):.1f} %",
                f"{(wrong.max(axis=1) < WITHIN).sum()} of {len(wrong)}",
            ]
        )
    greatest = np.abs(best).max(axis=1)
    return [
        "HCPA alone, seven unknowns over Table 5.1 (Fig. 5.8; the thesis: within 10 %), on "
        f"{len(records)} of the records. Errors in % of R_s, R_r', L_ls, L_s, J.",
        "",
        *table(
            (
                "search",
                "simulations",
                "median errors",
                "greatest error, median",
                "all five within 10 %",
            ),
            rows,
        ),
        "",
        "As printed, and with any budget tried, the algorithm falls short of the thesis's figure here: the "
        "cost has valleys along which R_s, R_r', L_s and H trade against each other, and steps along single "
        "coordinates do not follow them; T_d adds local minima half a cycle apart. Where the record shows "
        "T_d it need not be searched, and along the principal axes (14 of the simulations of each box) the "
        "same algorithm follows the valleys. The variants were chosen on ten records of seeds 100 and 101; "
        f"of all {len(greatest)} records of the first second the last one has "
        f"{(greatest < WITHIN).sum()} within 10 %, the farthest {100 * greatest.max():.1f} % off (drawn "
        "below). `mcc commission` refines by least squares instead, and needs no sight of T_d.",
        "",
    ]
