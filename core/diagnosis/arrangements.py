"""How relay, feeder and motor may be connected other than the motor's file says, weighed as the causes are.

Each arrangement is another reading of the same figures, with the evidence of all causes under it. They are
looked at where the positive-sequence current does not fit the file. The evidence of an arrangement is that of
its causes together:

    P(arrangement) ~ prior * sum over causes of prior odds * likelihood
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from math import log, sqrt
from typing import Final

import numpy as np

from core.diagnosis.causes import Cause, log_prior_odds
from core.diagnosis.channel_errors import SIXTH
from core.diagnosis.priors import OFFSET_S
from core.diagnosis.record_errors import HEALTHY, Known
from core.diagnosis.record_figures import RecordFigures
from core.diagnosis.stator_evidence import CALLED, StatorEvidence, weigh_stator
from core.machines.parameters import Connection, Motor
from core.signals.sequence import PhaseSequence

BANK, BANK_SPREAD = 0.6, 0.35
"""Usual susceptance of power-factor capacitors over that which magnetises the motor, and its deviation."""
LEAST_BANK = 0.08
"""Smaller ones are not told from parameters within their tolerances."""
UNEQUAL_LOADS: Final = 0.02
"""How far beside the circle the mean current of two motors lies, over it (complex magnitude)."""
ODD: Final = 9.0
"""Misfit of the positive-sequence current from which on other arrangements are looked at (chi squared)."""
USUAL_OFFSETS: Final = 2.5
"""Offset between currents and voltages from which on they are, in usual offsets."""
POSSIBLE: Final = 0.03
"""Probability from which on an arrangement is possible: levels hold under it too."""
LIKELY: Final = 0.1
"""Probability from which on nothing is called that is not called under it."""


DOUBTED: Final = frozenset({Cause.PARAMETERS, Cause.ASYMMETRY, Cause.CONNECTION, Cause.BEHIND_RELAY})
"""Answers that another arrangement may be behind."""


class Arrangement(StrEnum):
    """How a record's channels and its motor are connected."""

    AS_IN_FILE = "as-in-file"
    CAPACITORS = "capacitors"
    TWO_MOTORS = "two-motors"
    INSIDE_DELTA = "inside-delta"
    IN_STAR = "in-star"


PRIORS: Final = {
    Arrangement.AS_IN_FILE: 0.95,
    Arrangement.CAPACITORS: 0.02,
    Arrangement.TWO_MOTORS: 0.01,
    Arrangement.INSIDE_DELTA: 0.01,
    Arrangement.IN_STAR: 0.01,
}
"""How often each is there; no survey is known."""


@dataclass(frozen=True)
class Arranged:
    """The likeliest arrangement of a record.

    Parameters
    ----------
    arrangement : Arrangement
        Which it is.
    probability : float
        Its probability, given that it is one of those looked at.
    evidence : StatorEvidence
        Evidence of all causes under it.
    log_likelihood : float
        Log of its likelihood, all causes together.
    kvar : float
        Reactive power of capacitors behind the relay at rated voltage [kvar]; zero where none are seen.
    kvar_deviation : float
        Its standard deviation [kvar].
    rivals : tuple of Arranged
        The other arrangements that remain possible.
    """

    arrangement: Arrangement
    probability: float
    evidence: StatorEvidence
    log_likelihood: float
    kvar: float = 0.0
    kvar_deviation: float = 0.0
    rivals: tuple["Arranged", ...] = ()

    @property
    def calls_turns(self) -> bool:
        """Whether shorted turns are the answer."""
        turns = Cause.SHORTED_TURNS
        return self.evidence.answer is turns and self.evidence.probability[turns] >= CALLED


def arrange(figures: RecordFigures, motor: Motor, known: Known, model: str) -> Arranged:
    """Weigh the causes as the file has it and, where I1 does not fit it, under every other arrangement.

    Shorted turns change I1 too. Where they are called, a bank of capacitors is looked at beside them.
    """
    as_in_file = _arranged(Arrangement.AS_IN_FILE, weigh_stator(figures, motor, known, model))
    called = as_in_file.calls_turns
    if not called and not _is_odd(as_in_file.evidence):
        return as_in_file
    others = [make(figures, motor, known, model) for make in _others(motor, figures, called=called)]
    found = [as_in_file, *(one for one in others if one is not None and _is_running(one.evidence))]
    logs = np.array([log(PRIORS[one.arrangement]) + one.log_likelihood for one in found])
    logs[0] = logs[0] if _is_running(as_in_file.evidence) else -np.inf
    if not np.isfinite(logs).any():
        return as_in_file
    shares = np.exp(logs - np.logaddexp.reduce(logs)).tolist()
    found = [replace(one, probability=share) for one, share in zip(found, shares, strict=True)]
    likeliest, *rivals = sorted(found, key=lambda one: -one.probability)
    possible = tuple(one for one in rivals if one.probability >= POSSIBLE)
    return replace(likeliest, rivals=possible)


def _is_odd(evidence: StatorEvidence) -> bool:
    """Whether the positive-sequence current is not that of the file's motor."""
    point, errors = evidence.point, evidence.errors
    if not _is_running(evidence) or abs(point.offset_s) > USUAL_OFFSETS * OFFSET_S:
        return True
    left = errors.residual(HEALTHY, point.slip, point.offset_s)[:2]
    misfit = float(left @ np.linalg.solve(point.covariance[:2, :2], left)) + (point.offset_s / OFFSET_S) ** 2
    return misfit > ODD or evidence.answer in DOUBTED


def _is_running(evidence: StatorEvidence) -> bool:
    """Whether some slip of the motor explains the record."""
    slips = evidence.slips
    finite = bool(np.isfinite(list(evidence.log_likelihood_ratio.values())).all())
    return finite and slips.lowest < evidence.slip < slips.highest


def _arranged(arrangement: Arrangement, evidence: StatorEvidence) -> Arranged:
    return Arranged(arrangement, 1.0, evidence, _log_likelihood(evidence))


def _log_likelihood(evidence: StatorEvidence) -> float:
    ratios = evidence.log_likelihood_ratio
    logs = [log_prior_odds(cause) + ratio for cause, ratio in ratios.items()]
    return float(np.logaddexp.reduce(logs)) + evidence.healthy.log_likelihood


Make = Callable[[RecordFigures, Motor, Known, str], Arranged | None]


def _others(motor: Motor, figures: RecordFigures, *, called: bool) -> Iterator[Make]:
    """Yield what else may be; where shorted turns are called, only what they are found under as well."""
    if figures.voltage_channels is None:  # assumed voltages have no angle of their own
        return
    if not motor.transformers.inside_delta:
        if motor.capacitors is None:
            yield _with_capacitors
        if not called:
            yield _with_two_motors
    if called:
        return
    if motor.nameplate.connection is Connection.DELTA:
        if not motor.transformers.inside_delta:
            yield _inside_delta
        yield _in_star


def _with_capacitors(figures: RecordFigures, motor: Motor, known: Known, model: str) -> Arranged | None:
    """Fit a bank: its susceptance is added to I1/V1, exactly, so a Gaussian one stays Gaussian."""
    w, per_line = figures.angular_frequency, _per_line(motor)
    magnetising_S = 1.0 / (w * motor.parameters.magnetising_inductance_H)
    first = _less(figures, BANK * magnetising_S)
    known_bank = replace(
        known, bank_S=per_line * BANK * magnetising_S, bank_error_S=BANK_SPREAD * magnetising_S
    )
    wide = weigh_stator(first, motor, known_bank, model)
    size, deviation = _fitted_bank(wide, BANK_SPREAD * magnetising_S)
    bank_S = BANK * magnetising_S + size
    if bank_S < LEAST_BANK * magnetising_S:
        return None
    close = replace(known, bank_S=per_line * bank_S, bank_error_S=deviation)
    evidence = weigh_stator(_less(figures, bank_S), motor, close, model)
    if evidence.answer is not wide.answer:  # that of all banks counts
        evidence = wide
    frequency = motor.nameplate.rated_angular_frequency / w
    kvar_per_S = 1e-3 * per_line * motor.nameplate.rated_voltage_V**2 * frequency
    return Arranged(
        Arrangement.CAPACITORS,
        1.0,
        evidence,
        _log_likelihood(wide),
        bank_S * kvar_per_S,
        deviation * kvar_per_S,
    )


def _fitted_bank(evidence: StatorEvidence, spread_S: float) -> tuple[float, float]:
    """Return how far a bank is from the usual one, and the standard deviation of that [S]."""
    errors = evidence.errors
    turns, slip, offset = HEALTHY, evidence.point.slip, evidence.point.offset_s
    loss = evidence.losses.get(evidence.answer)
    if loss is None:
        turns, slip, offset = evidence.turns.likeliest
        loss = np.asarray(np.linalg.inv(errors.covariance(turns, slip)))
    column = spread_S * errors.bank(1.0)
    size = float(column @ loss @ errors.residual(turns, slip, offset))
    left = 1.0 - float(evidence.causes.projected(column[:, np.newaxis], loss)[0, 0])
    return size * spread_S, sqrt(max(left, 1e-3)) * spread_S


def _less(figures: RecordFigures, bank_S: float) -> RecordFigures:
    return replace(
        figures,
        admittance=figures.admittance - 1j * bank_S,
        negative_current_S=figures.negative_current_S - 1j * bank_S * figures.negative_voltage,
    )


def _with_two_motors(figures: RecordFigures, motor: Motor, known: Known, model: str) -> Arranged | None:
    half = _scaled(figures, 0.5, 1.0 + 0.0j)
    known = replace(known, beside_circle=UNEQUAL_LOADS)
    return _arranged(Arrangement.TWO_MOTORS, weigh_stator(half, motor, known, model))


def _inside_delta(figures: RecordFigures, motor: Motor, known: Known, model: str) -> Arranged | None:
    """Take the currents for those of the windings ab, bc, ca."""
    ahead = SIXTH if figures.sequence is PhaseSequence.ACB else 1.0 / SIXTH
    windings = replace(_scaled(figures, sqrt(3.0), ahead), zero_current=0j)
    return _arranged(Arrangement.INSIDE_DELTA, weigh_stator(windings, motor, known, model))


def _in_star(figures: RecordFigures, motor: Motor, known: Known, model: str) -> Arranged | None:
    """Take the motor for one whose windings are in star on the voltage that they have in delta."""
    plate = motor.nameplate
    star = replace(plate, connection=Connection.STAR, rated_voltage_V=sqrt(3.0) * plate.rated_voltage_V)
    turned = SIXTH**2
    seen = replace(
        _scaled(figures, 3.0, 1.0 + 0.0j),
        negative_current_S=3.0 * turned * figures.negative_current_S,
        negative_voltage=turned * figures.negative_voltage,
        positive_voltage_V=figures.positive_voltage_V / sqrt(3.0),
        relative_voltage=figures.relative_voltage / sqrt(3.0),
    )
    motor = replace(motor, nameplate=star)
    return _arranged(Arrangement.IN_STAR, weigh_stator(seen, motor, known, model))


def _scaled(figures: RecordFigures, factor: float, ahead: complex) -> RecordFigures:
    noise = figures.noise.copy()
    noise[:4, :] *= factor
    noise[:, :4] *= factor
    return replace(
        figures,
        admittance=factor * ahead * figures.admittance,
        negative_current_S=factor * ahead.conjugate() * figures.negative_current_S,
        noise=noise,
    )


def _per_line(motor: Motor) -> float:
    """Admittance of a line, of a star that is equal, over that of a winding."""
    return 3.0 if motor.nameplate.connection is Connection.DELTA else 1.0
