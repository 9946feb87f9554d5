"""Figures of a record, from the evidence over all hypotheses: level, load, speed, and what could be detected.

Where shorted turns are the answer, the level is the median of its posterior, and the interval holds the axis,
the leakage, the sensors and the parameters. Elsewhere it is what shorted turns would be nearest, and the
interval begins at zero: it is that of a healthy machine and shorted turns with even odds.
"""

from dataclasses import dataclass
from functools import cached_property
from math import exp, log, sqrt
from typing import Final

import numpy as np

from core.diagnosis.causes import Cause, log_prior_odds
from core.diagnosis.coil_likelihood import ShortedTurns, air_gap_torque, fit, offset_prior
from core.diagnosis.priors import GENERATING, OFFSET_S
from core.diagnosis.record_errors import HEALTHY
from core.diagnosis.stator_evidence import CALLED, StatorEvidence, whatever_the_asymmetry
from core.diagnosis.student_t import student_t_quantile
from core.machines.base import Array
from core.normal_distribution import NORMAL_95

Interval = tuple[float, float]
ONE_OF_TEN: Final = 1.2816
"""Standard deviations above the least level that is called, at which nine of ten records call one."""
PROBE_LEVEL: Final = 0.01
OCCAM: Final = 4.0
"""What the places of shorted turns cost their evidence: phase, axis, leakage and level are not known
before."""
LEVEL_SCATTER: Final = 0.12
"""Standard deviation of a level by the axis and the leakage, relative."""
MOST_STEPS, NEGLIGIBLE_LEVEL = 12, 1e-7
STEPS: Final = (1e-5, 1e-6, 1e-7)
"""Steps of the difference quotients by level, slip and offset."""


@dataclass(frozen=True)
class Estimates:
    """Figures of one record.

    Parameters
    ----------
    evidence : StatorEvidence
        The evidence.
    turns : ShortedTurns
        The hypothesis that the figures belong to; of level zero where the machine is taken as healthy.
    slip, offset_s : float
        Its slip, and the delay of the currents [s].
    """

    evidence: StatorEvidence
    turns: ShortedTurns
    slip: float
    offset_s: float

    @property
    def is_faulted(self) -> bool:
        """Whether shorted turns are the likeliest explanation."""
        return self.evidence.answer is Cause.SHORTED_TURNS

    @cached_property
    def level(self) -> float:
        """Equivalent level."""
        return self.turns.level if self.is_faulted else _level_of_asymmetry(self.evidence)

    @cached_property
    def level_ci95(self) -> Interval:
        """Its 95 % interval from all causes."""
        posterior = self.evidence.turns
        if self.is_faulted:
            return posterior.level_quantile(0.025), posterior.level_quantile(0.975)
        ratio = self.evidence.log_likelihood_ratio[Cause.SHORTED_TURNS]
        share = 1.0 / (1.0 + exp(-min(ratio, 50.0)))
        return 0.0, max(self.level, posterior.level_quantile(max(0.0, 1.0 - 0.025 / share)))

    @cached_property
    def level_scatter95(self) -> Interval:
        """Its 95 % interval by the record's own scatter alone."""
        reach = self._reach * self._noise_deviation(0)
        return max(0.0, self.level - reach), self.level + reach

    @cached_property
    def load_level(self) -> float:
        """Load torque over rated torque."""
        return self._load(self.slip)

    @cached_property
    def load_ci95(self) -> Interval:
        """Its 95 % interval from all causes."""
        step = STEPS[1]
        by_slip = (self._load(self.slip + step) - self._load(self.slip - step)) / (2.0 * step)
        errors = self.evidence.errors
        columns = errors.columns(self.turns, self.slip)
        of_errors = by_slip * (columns.others @ self._response[1])
        # A parameter changes the load at a slip as well as the slip that fits: a wrong R_r changes the slip
        # alone.
        found = [
            by_slip * float(column @ self._response[1]) - change
            for column, change in zip(columns.parameters, self._by_parameter, strict=True)
        ]
        noise = by_slip * self._noise_deviation(1)
        variance = float(of_errors @ of_errors) + sum(one**2 for one in found) + noise**2
        if self.is_faulted:
            variance += by_slip**2 * self.evidence.turns.moments("slip")[1]
        reach = NORMAL_95 * sqrt(variance)
        low, high = self.load_level - reach, self.load_level + reach
        if not self.is_faulted and self.evidence.log_likelihood_ratio[Cause.SHORTED_TURNS] > -2.0:
            # Shorted turns that are not excluded draw their share.
            turns, slip, _ = self.evidence.turns.likeliest
            with_turns = self._load(slip, turns)
            low, high = min(low, with_turns - reach), max(high, with_turns + reach)
        return low, high

    @cached_property
    def load_scatter95(self) -> Interval:
        """Its 95 % interval by the record's own scatter alone."""
        step = STEPS[1]
        by_slip = (self._load(self.slip + step) - self._load(self.slip - step)) / (2.0 * step)
        reach = self._reach * abs(by_slip) * self._noise_deviation(1)
        return self.load_level - reach, self.load_level + reach

    @cached_property
    def detection_limit(self) -> float:
        """Level of which nine of ten such recordings show a fault above the motor's limit."""
        evidence = self.evidence
        errors, prior = evidence.errors, evidence.turns.prior
        limit = errors.motor.limits.fault_level
        leakage = prior.usual_leakage(PROBE_LEVEL)
        found = 0.0
        for winding in range(3):
            probe = ShortedTurns(PROBE_LEVEL, leakage, 1.0 + 0.0j, winding)
            point = evidence.point
            here = errors.residual(probe, point.slip, point.offset_s)
            column = (here - errors.residual(HEALTHY, point.slip, point.offset_s)) / PROBE_LEVEL
            column = column[:, np.newaxis]
            sound = float(evidence.causes.projected(column, evidence.losses[Cause.HEALTHY])[0, 0])
            deviation = 1.0 / sqrt(sound)
            needed = [(limit + (NORMAL_95 + ONE_OF_TEN) * deviation) / (1.0 - NORMAL_95 * LEVEL_SCATTER)]
            for cause, loss in evidence.losses.items():
                odds = log(CALLED / (1.0 - CALLED))
                odds += log_prior_odds(cause) - log_prior_odds(Cause.SHORTED_TURNS)
                information = float(evidence.causes.projected(column, loss)[0, 0])
                least = sqrt(2.0 * max(odds + OCCAM, 0.5) / max(information, 1e-12))
                needed.append(least + ONE_OF_TEN * deviation)
            found = max(found, *needed)
        return min(found, 1.0)

    @property
    def _reach(self) -> float:
        return student_t_quantile(0.975, max(self.evidence.errors.figures.cycles - 1, 1))

    def _load(self, slip: float, turns: ShortedTurns | None = None) -> float:
        errors = self.evidence.errors
        figures, plate = errors.figures, errors.motor.nameplate
        torque_S = air_gap_torque(
            errors.machine,
            self.turns if turns is None else turns,
            figures.angular_frequency,
            figures.negative_voltage,
            slip,
        )
        torque = torque_S * figures.positive_voltage_V**2 * plate.pole_pairs / figures.angular_frequency
        return float(torque / plate.rated_torque_Nm)

    @cached_property
    def _by_parameter(self) -> list[float]:
        """What one standard deviation of each parameter changes of the load at this slip."""
        errors = self.evidence.errors
        figures, plate = errors.figures, errors.motor.nameplate
        here, found = self.load_level, []
        for machine in errors.other_machines():
            torque_S = air_gap_torque(
                machine, self.turns, figures.angular_frequency, figures.negative_voltage, self.slip
            )
            torque = torque_S * figures.positive_voltage_V**2 * plate.pole_pairs / figures.angular_frequency
            found.append(float(torque / plate.rated_torque_Nm) - here)
        return found

    @cached_property
    def _response(self) -> Array:
        """Change of level, slip and offset by one of each figure, shape (3, figures)."""
        errors, turns = self.evidence.errors, self.turns
        level = max(turns.level, PROBE_LEVEL if not self.is_faulted else turns.level)
        if not self.is_faulted:
            turns = self.evidence.turns.likeliest[0]._replace(level=level)
        loss = np.linalg.inv(errors.covariance(turns, self.slip))
        at = np.array([level, self.slip, self.offset_s])
        return _linearised(self.evidence, turns, at, np.asarray(loss))[1]

    def _noise_deviation(self, k: int) -> float:
        row = self._response[k]
        return sqrt(float(row @ self.evidence.errors.noise(self.slip) @ row))


def estimates_of(evidence: StatorEvidence) -> Estimates:
    """Return the figures of a record."""
    if evidence.answer is not Cause.SHORTED_TURNS:
        return _estimates_at(evidence, HEALTHY, evidence.point.slip, evidence.point.offset_s)
    posterior = evidence.turns
    return _estimates_at(
        evidence, *posterior.nearest_to(posterior.level), of_one_place=posterior.is_of_one_place
    )


def nearest_turns(evidence: StatorEvidence) -> Estimates:
    """Return the figures of the shorted turns that come nearest, whatever the answer."""
    if evidence.answer is Cause.SHORTED_TURNS:
        return estimates_of(evidence)
    return _estimates_at(evidence, *evidence.turns.nearest_to(_level_of_asymmetry(evidence)))


def _level_of_asymmetry(evidence: StatorEvidence) -> float:
    """Return the level of shorted turns that would make as much asymmetry as the record has."""
    errors, point = evidence.errors, evidence.point
    leakage = evidence.turns.prior.usual_leakage(PROBE_LEVEL)
    own = errors.residual(HEALTHY, point.slip, point.offset_s)[2:4]
    probe = ShortedTurns(PROBE_LEVEL, leakage, 1.0 + 0.0j, 0)
    made = errors.residual(probe, point.slip, point.offset_s)[2:4] - own
    return float(PROBE_LEVEL * np.hypot(*own) / np.hypot(*made))


def _estimates_at(
    evidence: StatorEvidence, turns: ShortedTurns, slip: float, offset: float, *, of_one_place: bool = False
) -> Estimates:
    """Find slip and offset, and the level of one place, at which the file's parameters fit the record."""
    errors = evidence.errors
    covariance = errors.noise(slip) + errors.of_channels_alike()
    if turns.level <= 0.0 and evidence.answer is not Cause.HEALTHY:
        covariance = whatever_the_asymmetry(covariance)
    record = errors.compared(covariance, evidence.slips)
    _, slip, offset = fit(record, errors.machine, turns, slip, offset, np.empty((5, 4)))
    if of_one_place:
        loss, at = np.asarray(np.linalg.inv(covariance)), np.array([turns.level, slip, offset])
        for _ in range(MOST_STEPS):
            step, _ = _linearised(evidence, turns, at, loss)
            at += step
            if abs(step[0]) < NEGLIGIBLE_LEVEL:
                break
        turns, slip, offset = turns._replace(level=float(at[0])), float(at[1]), float(at[2])
    return Estimates(evidence, turns, slip, offset)


def _linearised(evidence: StatorEvidence, turns: ShortedTurns, at: Array, loss: Array) -> tuple[Array, Array]:
    """Linearise a record about level, slip and offset `at`, with the inverse covariance `loss`.

    Returns the step of Gauss and Newton to the likeliest ones, and how they follow each figure (3, figures).
    """
    errors, slopes = evidence.errors, []
    for k, step in enumerate(STEPS):
        ends = []
        for moved in (at[k] - step, at[k] + step):
            level, slip, offset = (moved if n == k else float(at[n]) for n in range(3))
            ends.append(errors.residual(turns._replace(level=level), slip, offset))
        slopes.append((ends[0] - ends[1]) / (2.0 * step))
    J = np.stack(slopes, axis=1)
    _, row, slope = offset_prior(float(at[2]))
    brake = 1.0 / (GENERATING * evidence.slips.rated) if at[1] < 0.0 else 0.0
    scale = np.array([PROBE_LEVEL, evidence.slips.rated, OFFSET_S])
    H = scale[:, np.newaxis] * (J.T @ loss @ J + np.diag([0.0, brake**2, slope**2])) * scale
    here = errors.residual(turns._replace(level=float(at[0])), float(at[1]), float(at[2]))
    downhill = J.T @ loss @ here - np.array([0.0, brake**2 * at[1], slope * row])
    ahead = np.asarray(scale * np.linalg.solve(H, scale * downhill))
    return ahead, np.asarray(scale[:, np.newaxis] * np.linalg.solve(H, scale[:, np.newaxis] * (J.T @ loss)))
