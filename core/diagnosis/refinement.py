"""Local refinement: Gauss-Newton on the model's currents, Levenberg-Marquardt where that overshoots.

scipy.optimize.least_squares finds the same minima in as many rounds, but takes nearly twice the time a fit,
and its import takes as long as ten diagnoses; `python -m benchmarks.refinement` measures both. The Jacobian
comes from central differences, all of them one batch of compiled steady states.

The delay between a relay's currents and voltages has a prior: it is a few sample times, rarely more. A light
load on a strongly unbalanced supply leaves delay and load nearly indistinguishable, and the prior decides;
its tails are Cauchy's, so that a record which does tell a long delay is believed.
"""

from dataclasses import dataclass, replace
from math import hypot, log1p, sqrt

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.fundamental import Fundamental, axis_phasors, components
from core.machines.base import Array, StatorModel
from core.machines.candidates import Candidates
from core.machines.running import SteadyRunning

MOST_ROUNDS = 40
OFFSET_SCALE_S = 100e-6
"""Half width at half maximum of the Cauchy distribution of the offset between a relay's channels."""
ADMITTANCE_STEP = 1e-4
"""Step of the difference quotient of currents by voltages, a share of the forward voltage."""
POOR, GOOD = 0.25, 0.75
"""Shares of the promised fall of the misfit: a step that keeps less is followed by shorter ones, one that
keeps more by longer ones."""
FIRST_DAMPING, MOST_DAMPING = 0.1, 1e6
SMALLEST_FALL = 1e-30
NEGLIGIBLE = 3e-3
"""Share of a difference quotient's step below which a Gauss-Newton step is not worth taking."""
COMPONENTS_OF_A_RATIO = 6
"""A channel's complex ratio shows in either sequence with a third of its variance in two components."""


@dataclass(frozen=True, slots=True)
class Unknown:
    """A quantity that is fitted.

    Parameters
    ----------
    name : str
        Its name in Candidates.
    step : float
        Step of its difference quotient.
    lower, upper : float
        Its range.
    """

    name: str
    step: float
    lower: float
    upper: float


FAULT_LEVEL = "fault_level"
LOAD_LEVEL = "load_level"
TIME_OFFSET = "time_offset_s"


def unknown(name: str, case: Case, model: StatorModel) -> Unknown:
    """Return range and step of an unknown.

    T_d is known modulo one cycle and kept within half a one either way; the quality gate lets none pass that
    is near either end.
    """
    cycle = 1.0 / case.frequency_hz
    return {
        FAULT_LEVEL: Unknown(FAULT_LEVEL, 2e-4, model.lowest_level, 0.5),
        LOAD_LEVEL: Unknown(LOAD_LEVEL, 2e-3, -0.2, 2.0),
        TIME_OFFSET: Unknown(TIME_OFFSET, 1e-4 * cycle, -0.5 * cycle, 0.5 * cycle),
    }[name]


@dataclass(frozen=True, slots=True)
class Fit:
    """A hypothesis at its best.

    Parameters
    ----------
    candidate : Candidates
        A batch of one hypothesis.
    misfit : float
        Squared distance of the compared components, weighted by what noise and the sensors' class make of
        them, prior included: minus twice the log likelihood, but for a constant.
    evaluations : int
        Number of simulated candidates or evaluated points.
    """

    candidate: Candidates
    misfit: float
    evaluations: int

    def value(self, name: str) -> float:
        """Return the fitted value of an unknown."""
        return float(getattr(self.candidate, name)[0])


class Refinement:
    """A local fit on one record, for any hypothesis.

    Components are weighted by what noise and the sensors' class make of each: noise on the voltages, say,
    falls mostly on the backward-turning current, which meets the machine's least impedance. `running` is the
    motor on the record's voltage.

    Parameters
    ----------
    case : Case
        The record in the winding frame.
    record : Fundamental
        Its phasors at supply frequency.
    model : StatorModel
        Machine model of the fault.
    near : Candidates
        A candidate near the truth, which tells how voltages become currents.
    """

    def __init__(self, case: Case, record: Fundamental, model: StatorModel, near: Candidates) -> None:
        self._case = case
        self.record = record
        current, voltage = self.record.current, self.record.voltage
        self.running = SteadyRunning(
            model, case.motor, case.supply.angular_frequency, axis_phasors(voltage.components)
        )
        passed = self.admittance(near)
        cycles = self.record.cycles
        sensors = (_channel_ratio(case) * abs(current.forward)) ** 2 / COMPONENTS_OF_A_RATIO * np.eye(4)
        weighed = current.shrunk(cycles) + passed @ voltage.shrunk(cycles) @ passed.T + sensors
        self._whitening = np.linalg.inv(np.linalg.cholesky(weighed))

    def fit(self, start: Candidates, names: tuple[str, ...]) -> Fit:
        """Minimise the misfit from one candidate over the named unknowns, the others held."""
        unknowns = tuple(unknown(name, self._case, self.running.model) for name in names)
        inside = _moved(start, unknowns, np.zeros(len(unknowns)))
        point, rounds, damping = self._linearise(inside, unknowns), 1, 0.0
        while rounds <= MOST_ROUNDS and damping <= MOST_DAMPING:
            step = _step(point, unknowns, 0.0)
            if all(abs(s) <= NEGLIGIBLE * one.step for s, one in zip(step.tolist(), unknowns, strict=True)):
                break
            if damping > 0.0:
                step = _step(point, unknowns, damping)
            moved = self._linearise(_moved(point.candidate, unknowns, step), unknowns)
            rounds += 1
            kept = (point.misfit - moved.misfit) / _promised(point, moved, unknowns)
            if kept < POOR:
                damping = max(FIRST_DAMPING, 4.0 * damping)
            elif kept > GOOD:
                damping = damping / 4.0 if damping > FIRST_DAMPING else 0.0
            if moved.misfit < point.misfit:
                point = moved
        return Fit(point.candidate, point.misfit, evaluations=rounds * (1 + 2 * len(unknowns)))

    def admittance(self, candidate: Candidates) -> Array:
        """Return how the current's components follow the voltage's at a candidate."""
        volts = self.record.voltage.components
        step = ADMITTANCE_STEP * abs(self.record.voltage.forward)
        here = self._modelled(self.running, candidate)[0]
        moved = [self.running.on(axis_phasors(volts + change)) for change in step * np.eye(4)]
        return np.stack([(self._modelled(one, candidate)[0] - here) / step for one in moved], axis=1)

    def _modelled(self, running: SteadyRunning, candidates: Candidates) -> Array:
        return components(running.state(candidates).current)

    def _linearise(self, candidate: Candidates, unknowns: tuple[Unknown, ...]) -> "_Point":
        rows = 1 + 2 * len(unknowns)
        batch = Candidates(
            fault_level=np.repeat(candidate.fault_level, rows),
            winding=np.repeat(candidate.winding, rows),
            load_level=np.repeat(candidate.load_level, rows),
            time_offset_s=np.repeat(candidate.time_offset_s, rows),
            leakage=np.repeat(candidate.leakage, rows),
            axis_rad=np.repeat(candidate.axis_rad, rows),
            linkage=np.repeat(candidate.linkage, rows),
        )
        steps = np.empty(len(unknowns))
        for k, one in enumerate(unknowns):
            values = getattr(batch, one.name)
            values[1 + 2 * k] = min(values[0] + one.step, one.upper)
            values[2 + 2 * k] = max(values[0] - one.step, one.lower)
            steps[k] = values[1 + 2 * k] - values[2 + 2 * k]
        modelled = self._modelled(self.running, batch)
        observed = self._whitening @ (self.record.current.components - modelled[0])
        slopes = self._whitening @ ((modelled[1::2] - modelled[2::2]) / steps[:, np.newaxis]).T

        offset = float(candidate.time_offset_s[0]) / OFFSET_SCALE_S
        # Cauchy's distribution as a row whose weight falls with the offset (iteratively reweighted).
        weight = sqrt(2.0 / (1.0 + offset**2))
        prior = np.array([weight / OFFSET_SCALE_S if one.name == TIME_OFFSET else 0.0 for one in unknowns])
        return _Point(
            candidate=candidate,
            misfit=float(observed @ observed) + 2.0 * log1p(offset**2),
            rows=np.append(-observed, weight * offset),
            slopes=np.vstack([slopes, prior]),
        )


@dataclass(frozen=True, slots=True)
class _Point:
    """One candidate with the misfit linearised about it.

    rows, slopes: modelled minus measured components over their standard deviation, (4,), and below them the
    prior's row; their derivatives by the unknowns, (5, unknowns).
    """

    candidate: Candidates
    misfit: float
    rows: Array
    slopes: Array


def _channel_ratio(case: Case) -> float:
    """Return the standard deviation of a channel's complex ratio, over voltages and currents alike."""
    sensors, frequency = case.motor.sensors, case.frequency_hz
    voltage, current = sensors.voltage_deviation(frequency), sensors.current_deviation(frequency)
    return hypot(voltage, current) / sqrt(2.0)


def _step(point: _Point, unknowns: tuple[Unknown, ...], damping: float) -> Array:
    """Levenberg-Marquardt step of the unknowns that are free to move; undamped, that of Gauss and Newton."""
    step = np.zeros(len(unknowns))
    free = _free(point, unknowns)
    slopes, rows = point.slopes[:, free], point.rows
    if damping > 0.0:
        brakes = np.diag(np.sqrt(damping * np.sum(slopes**2, axis=0)))
        slopes, rows = np.vstack([slopes, brakes]), np.append(rows, np.zeros(len(brakes)))
    step[free] = -np.linalg.lstsq(slopes, rows)[0]
    return step


def _promised(point: _Point, moved: _Point, unknowns: tuple[Unknown, ...]) -> float:
    """Fall of the misfit on the way to `moved`, were the model linear; never quite nothing."""
    way = [float((getattr(moved.candidate, x.name) - getattr(point.candidate, x.name))[0]) for x in unknowns]
    change = point.slopes @ np.array(way)
    return max(float(-2.0 * (change @ point.rows) - change @ change), SMALLEST_FALL)


def _free(point: _Point, unknowns: tuple[Unknown, ...]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Unknowns that are inside their range, or at its edge with the misfit falling inwards."""
    free = np.ones(len(unknowns), dtype=np.bool_)
    growth = point.slopes.T @ point.rows
    for k, one in enumerate(unknowns):
        value = float(getattr(point.candidate, one.name)[0])
        outwards = (value <= one.lower and growth[k] > 0.0) or (value >= one.upper and growth[k] < 0.0)
        free[k] = not outwards
    return free


def _moved(candidate: Candidates, unknowns: tuple[Unknown, ...], step: Array) -> Candidates:
    for one, change in zip(unknowns, step.tolist(), strict=True):
        value = np.clip(getattr(candidate, one.name) + change, one.lower, one.upper)
        candidate = replace(candidate, **{one.name: value})
    return candidate
