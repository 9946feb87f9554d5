"""Local refinement: Gauss-Newton on the model's currents, and what its Jacobian says of the uncertainty.

The Jacobian comes from central differences, all of them one batch of the compiled kernel. The covariance
allows for coloured residuals: the gradient of the cost is summed over single cycles, and the scatter of those
sums, not that of single samples, is the noise (batch means; Law and Kelton, Simulation Modeling and
Analysis). Harmonics the model does not explain repeat every cycle and so do not pass for noise.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import t as student_t

from core.diagnosis.case import Case
from core.machines.base import Array, StatorModel
from core.machines.playback import Candidates, Playback

CONFIDENCE = 0.95
MOST_ITERATIONS = 12
FEWEST_BLOCKS = 3
HIGHEST_PATH_RATIO = 4.0
"""Beyond it a path draws a current in the voltage's own direction, as many an asymmetry does that is none."""


@dataclass(frozen=True, slots=True)
class Unknown:
    """A quantity that is fitted: its name in Candidates, the step of its difference quotient, its range."""

    name: str
    step: float
    lower: float
    upper: float


FAULT_LEVEL = "fault_level"
LOAD_LEVEL = "load_level"
TIME_OFFSET = "time_offset_s"
PATH_RATIO = "path_ratio"


def unknown(name: str, case: Case, model: StatorModel) -> Unknown:
    """Range and step of an unknown; T_d within half a cycle either way, as it is known modulo one cycle."""
    cycle = 1.0 / case.frequency_hz
    return {
        FAULT_LEVEL: Unknown(FAULT_LEVEL, 2e-4, model.lowest_level, 0.5),
        LOAD_LEVEL: Unknown(LOAD_LEVEL, 2e-3, -0.2, 2.0),
        TIME_OFFSET: Unknown(TIME_OFFSET, 1e-4 * cycle, -0.5 * cycle, 0.5 * cycle),
        PATH_RATIO: Unknown(PATH_RATIO, 2e-3, 0.0, HIGHEST_PATH_RATIO),
    }[name]


@dataclass(frozen=True, slots=True)
class Fit:
    """A hypothesis at its best.

    candidate: a batch of one.  squared_error: over the compared samples [A^2, winding current].
    residual_ab: measured minus modelled winding current over the window, (2, window samples) [A].
    standard_error: by name of the unknowns; `degrees_of_freedom` of the noise behind it.
    at_bound: names of unknowns that ended on their bound and have no standard error.
    """

    candidate: Candidates
    squared_error: float
    residual_ab: Array
    standard_error: dict[str, float]
    degrees_of_freedom: int
    at_bound: tuple[str, ...]
    evaluations: int

    def value(self, name: str) -> float:
        """Fitted value of an unknown."""
        return float(getattr(self.candidate, name)[0])

    def interval(self, name: str) -> tuple[float, float]:
        """95 % confidence interval of an unknown; its bound alone where it ended on one."""
        if name in self.at_bound:
            return self.value(name), self.value(name)
        reach = (
            float(student_t.ppf(0.5 + CONFIDENCE / 2.0, self.degrees_of_freedom)) * self.standard_error[name]
        )
        return self.value(name) - reach, self.value(name) + reach


def refine(case: Case, playback: Playback, start: Candidates, names: tuple[str, ...]) -> Fit:
    """Minimise the squared residual from one candidate over the named unknowns, the others held."""
    unknowns = tuple(unknown(name, case, playback.model) for name in names)
    candidate, evaluations = start, 0
    residual, jacobian = _linearise(case, playback, candidate, unknowns)
    evaluations += 1 + 2 * len(unknowns)
    error = _squared(case, residual)
    for _ in range(MOST_ITERATIONS):
        free = _free(candidate, unknowns, case, residual, jacobian)
        step = np.zeros(len(unknowns))
        stacked, target = _stack(case, jacobian[free]), _flat(case, residual)
        step[free] = np.linalg.lstsq(stacked, target)[0]
        improved = False
        for damping in (1.0, 0.3, 0.1, 0.03):
            moved = _moved(candidate, unknowns, damping * step)
            new_residual, new_jacobian = _linearise(case, playback, moved, unknowns)
            evaluations += 1 + 2 * len(unknowns)
            new_error = _squared(case, new_residual)
            if new_error <= error:
                improved = True
                break
        if not improved:
            break
        gain = error - new_error
        candidate, residual, jacobian, error = moved, new_residual, new_jacobian, new_error
        if gain <= 1e-7 * error:
            break
    free = _free(candidate, unknowns, case, residual, jacobian)
    scatter, blocks = _covariance(case, residual, jacobian[free])
    seen = [name for name, is_free in zip(names, free, strict=True) if is_free]
    return Fit(
        candidate=candidate,
        squared_error=error,
        residual_ab=residual,
        standard_error=dict(zip(seen, np.sqrt(np.diag(scatter)).tolist(), strict=True)),
        degrees_of_freedom=blocks - 1,
        at_bound=tuple(name for name in names if name not in seen),
        evaluations=evaluations,
    )


def _linearise(
    case: Case, playback: Playback, candidate: Candidates, unknowns: tuple[Unknown, ...]
) -> tuple[Array, Array]:
    """Residual (2, window) and the model current's derivatives (unknowns, 2, window)."""
    rows = 1 + 2 * len(unknowns)
    batch = Candidates(
        fault_level=np.repeat(candidate.fault_level, rows),
        winding=np.repeat(candidate.winding, rows),
        load_level=np.repeat(candidate.load_level, rows),
        time_offset_s=np.repeat(candidate.time_offset_s, rows),
        path_ratio=np.repeat(candidate.path_ratio, rows),
    )
    steps = np.empty(len(unknowns))
    for k, one in enumerate(unknowns):
        values = getattr(batch, one.name)
        values[1 + 2 * k] = min(values[0] + one.step, one.upper)
        values[2 + 2 * k] = max(values[0] - one.step, one.lower)
        steps[k] = values[1 + 2 * k] - values[2 + 2 * k]
    current = playback.trajectories(batch).current
    window = case.window
    residual = case.current_ab[:, window.first : window.last] - current[0]
    jacobian = (current[1::2] - current[2::2]) / steps[:, np.newaxis, np.newaxis]
    return residual, jacobian


def _free(
    candidate: Candidates, unknowns: tuple[Unknown, ...], case: Case, residual: Array, jacobian: Array
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Unknowns that are inside their range, or at its edge with the cost falling inwards."""
    free = np.ones(len(unknowns), dtype=np.bool_)
    target = _flat(case, residual)
    for k, one in enumerate(unknowns):
        value = float(getattr(candidate, one.name)[0])
        descent = float(_stack(case, jacobian[k : k + 1])[:, 0] @ target)
        outwards = (value <= one.lower and descent < 0.0) or (value >= one.upper and descent > 0.0)
        free[k] = not outwards
    return free


def _moved(candidate: Candidates, unknowns: tuple[Unknown, ...], step: Array) -> Candidates:
    for one, change in zip(unknowns, step.tolist(), strict=True):
        value = np.clip(getattr(candidate, one.name) + change, one.lower, one.upper)
        candidate = replace(candidate, **{one.name: value})
    return candidate


def _covariance(case: Case, residual: Array, jacobian: Array) -> tuple[Array, int]:
    """Covariance of the free unknowns and the number of cycles it rests on."""
    stacked = _stack(case, jacobian)
    information = stacked.T @ stacked
    offset = case.window.compare_from - case.window.first
    scores = (jacobian[:, :, offset:] * residual[:, offset:]).sum(axis=1)
    per_cycle = case.sample_rate_hz / case.frequency_hz
    blocks = max(int(scores.shape[1] / per_cycle), FEWEST_BLOCKS)
    edges = np.round(np.arange(blocks) * scores.shape[1] / blocks).astype(np.int64)
    sums = np.add.reduceat(scores, edges, axis=1)
    centred = sums - sums.mean(axis=1, keepdims=True)
    filling = centred @ centred.T * (blocks / (blocks - 1))
    try:
        bread = np.linalg.inv(information)
    except np.linalg.LinAlgError:
        # The record does not tell the unknowns apart: no value of theirs is better than another.
        return np.full_like(information, np.inf), blocks
    return bread @ filling @ bread, blocks


def _stack(case: Case, jacobian: Array) -> Array:
    """Derivatives over the compared samples, both axes one after the other: (2 samples, unknowns)."""
    offset = case.window.compare_from - case.window.first
    return jacobian[:, :, offset:].reshape(jacobian.shape[0], -1).T


def _flat(case: Case, residual: Array) -> Array:
    return residual[:, case.window.compare_from - case.window.first :].reshape(-1)


def _squared(case: Case, residual: Array) -> float:
    flat = _flat(case, residual)
    return float(flat @ flat)
