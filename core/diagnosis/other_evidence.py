"""Evidence for what is no shorted turn: channels, a joint, other parameters, an asymmetry of another cause.

Each adds a signature of unknown size to the figures of a healthy machine, U g with g ~ N(0, D). The
likelihood is that of figures with the covariance M = S + U D U'; slip and offset, linear about the healthy
machine's, are integrated over:

    ln L = -(Q + ln det M + ln det H) / 2,    H = J' M^-1 J + P,    Q = r' M^-1 r + q - g' H^-1 g

Where a size is positive, as a joint's, ln 2 Phi(size / deviation) is added.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import log, sqrt
from typing import Final

import numpy as np
from scipy.special import log_ndtr

from core.diagnosis.causes import Cause
from core.diagnosis.channel_errors import channel_of
from core.diagnosis.coil_likelihood import fit, offset_prior
from core.diagnosis.loads_behind import RATED_EFFICIENCY_POWER_FACTOR, loads_behind
from core.diagnosis.priors import GENERATING, OFFSET_S, UNKNOWN_ASYMMETRY
from core.diagnosis.record_errors import HEALTHY, RecordErrors
from core.diagnosis.running_range import RunningPoint, SlipRange
from core.diagnosis.signature import Signature
from core.machines.base import Array
from core.machines.parameters import Connection
from core.machines.winding_frame import terminal_winding
from core.normal_distribution import NORMAL_95
from core.signals.terminals import VoltageChannels

CHANNELS: Final = (0.025, 0.075)
"""Usual errors of a wrong channel, each as likely as the other; `SensorClass` has those of sound ones."""
CHANNEL_PHASE: Final = 0.3
"""How far it turns, over its size."""
JOINT_DROPS: Final = (0.015, 0.045)
"""Usual drops over a joint at rated current, over the rated voltage."""
JOINT_DIRECTION: Final = 0.1
WRONG_PARAMETER: Final = 0.3
"""Usual error of a wrong parameter, relative."""
STEP_OF_SLIP: Final = 1e-6
PHASES: Final = ("a", "b", "c")
LINES: Final = ("ab", "bc", "ca")


@dataclass(frozen=True, slots=True)
class Weighed:
    """Evidence of one cause.

    Parameters
    ----------
    log_evidence : float
        Log of its likelihood, all places and sizes together.
    figure : str
        The likeliest place and its size, in words.
    loss : ndarray
        Inverse of the covariance that the figures have with it, for its likeliest place and spread.
    """

    log_evidence: float
    figure: str
    loss: Array


class OtherCauses:
    """All causes but shorted turns, weighed against a record.

    Parameters
    ----------
    errors : RecordErrors
        The record and its errors.
    point : RunningPoint
        Slip and offset of the record.
    slips : SlipRange
        Slips that are searched.
    """

    def __init__(self, errors: RecordErrors, point: RunningPoint, slips: SlipRange) -> None:
        self._errors, self._point, self._slips = errors, point, slips
        slip, offset = point.slip, point.offset_s
        here = errors.residual(HEALTHY, slip, offset)
        by_slip = (errors.residual(HEALTHY, slip + STEP_OF_SLIP, offset) - here) / STEP_OF_SLIP
        step = 0.01 * OFFSET_S
        by_offset = (errors.residual(HEALTHY, slip, offset + step) - here) / step
        # In rated slips, and in usual offsets.
        self._slopes = np.stack([by_slip * slips.rated, by_offset * OFFSET_S], axis=1)
        _, _, slope = offset_prior(offset)
        brake = 1.0 / GENERATING if slip < 0.0 else 0.0
        self._prior = np.diag([brake**2, (slope * OFFSET_S) ** 2])

    def weigh(self) -> dict[Cause, Weighed]:
        """Return the evidence of every cause."""
        signatures = [
            *self._channels(),
            *self._joints(),
            *loads_behind(self._errors),
            self._asymmetry(),
            *self._parameters(),
        ]
        found: dict[Cause, Weighed] = {}
        for one, this in zip(signatures, self._weighed(signatures), strict=True):
            before = found.get(one.cause)
            if before is not None:
                likelier = max(this, before, key=lambda each: each.log_evidence)
                total = float(np.logaddexp(this.log_evidence, before.log_evidence))
                this = replace(likelier, log_evidence=total)
            found[one.cause] = this
        return found

    def projected(self, columns: Array, loss: Array) -> Array:
        """Return the information of columns that is left where slip and offset are free.

        Both may be stacks of as many, which are taken one by one.
        """
        J = self._slopes
        H = J.T @ loss @ J + self._prior
        across = J.T @ loss @ columns
        taken = np.swapaxes(across, -1, -2) @ np.linalg.solve(H, across)
        return np.asarray(np.swapaxes(columns, -1, -2) @ loss @ columns - taken)

    def _weighed(self, signatures: Sequence[Signature]) -> Iterator[Weighed]:
        """Fit slip and offset with the errors that a healthy machine has and those of each signature."""
        errors, point = self._errors, self._point
        most = max(one.spread.size for one in signatures)
        U = np.zeros((len(signatures), point.covariance.shape[0], most))
        for place, one in zip(U, signatures, strict=True):
            place[:, : one.spread.size] = one.columns * one.spread
        covariances = point.covariance + U @ np.swapaxes(U, -1, -2)
        losses: Array = np.asarray(np.linalg.inv(covariances), dtype=np.float64)
        first = U[:, :, :1]
        # Covariance of the sizes, over their spreads: I - U' M^-1 U, slip and offset free.
        known = self.projected(first, losses)[:, 0, 0]
        deviations = np.sqrt(np.maximum(1.0 - known, 1e-9)).tolist()
        constants = errors.log_constants(covariances).tolist()
        work = np.empty((5, 4))
        starts = (point.slip, point.offset_s), (0.5 * self._slips.rated, 0.0)
        for k, record in enumerate(errors.compared_by_each(covariances, self._slips)):
            found, slip, offset = max(fit(record, errors.machine, HEALTHY, *start, work) for start in starts)
            size = float(first[k, :, 0] @ losses[k] @ errors.residual(HEALTHY, slip, offset))
            one, deviation = signatures[k], deviations[k]
            found += constants[k] + log(one.share)
            if one.one_sided:
                found += log(2.0) + float(log_ndtr(size / deviation))
            unit = float(one.spread[0])
            words = one.size_in_words(size * unit, deviation * unit)
            yield Weighed(found, f"{one.place}: {words}" if one.place else words, losses[k])

    def _channels(self) -> list[Signature]:
        errors, slip = self._errors, self._point.slip
        figures, found = errors.figures, list[Signature]()
        channels = figures.voltage_channels
        for x in range(3):
            if channels is None:
                break
            names = PHASES if channels is VoltageChannels.PHASE else LINES
            channel = channel_of(x, channels, figures.sequence)
            place = "one of the lines" if channel is None else f"channel {names[channel]}"
            columns = np.stack([errors.voltage_error(x, one, slip) for one in (1.0, 1j)], axis=1)
            found += _of_channel(Cause.VOLTAGE_CHANNEL, place, columns)
        for x in range(3):
            place = f"channel {PHASES[terminal_winding(x, figures.sequence, Connection.STAR)]}"
            columns = np.stack([errors.current_error(x, one) for one in (1.0, 1j)], axis=1)
            found += _of_channel(Cause.CURRENT_CHANNEL, place, columns)
        return found

    def _joints(self) -> list[Signature]:
        errors, slip, motor = self._errors, self._point.slip, self._errors.motor
        plate, sequence = motor.nameplate, self._errors.figures.sequence
        rated_S = plate.rated_power_W / (3.0 * plate.winding_voltage_V**2 * RATED_EFFICIENCY_POWER_FACTOR)
        in_lines = (False, True) if plate.connection is Connection.DELTA else (False,)
        found = []
        for x in range(3):
            for in_line in in_lines:
                name = "line" if in_line else "winding" if len(in_lines) > 1 else "phase"
                own = Connection.STAR if in_line else plate.connection
                columns = [errors.joint(x, part / rated_S, slip, in_line=in_line) for part in (1.0, 1j)]
                place = f"{name} {PHASES[terminal_winding(x, sequence, own)]}"
                found += [
                    Signature(
                        Cause.CONNECTION,
                        place,
                        np.stack(columns, axis=1),
                        drop * np.array([1.0, JOINT_DIRECTION]),
                        one_sided=True,
                        share=1.0 / (3.0 * len(in_lines) * len(JOINT_DROPS)),
                        size_in_words=_drop,
                    )
                    for drop in JOINT_DROPS
                ]
        return found

    def _asymmetry(self) -> Signature:
        columns = [self._errors.asymmetry(part, self._point.slip) for part in (1.0, 1j)]
        return Signature(
            Cause.ASYMMETRY,
            "",
            np.stack(columns, axis=1),
            np.full(2, UNKNOWN_ASYMMETRY * sqrt(0.5)),
            one_sided=False,
            share=1.0,
            size_in_words=lambda _size, _deviation: "an asymmetry of unknown cause",
        )

    def _parameters(self) -> list[Signature]:
        """Each parameter another by a factor of its own, or all by one: another motor, or a wrong ratio."""
        each = np.stack(list(self._errors.by_parameter(HEALTHY, self._point.slip).values()), axis=1)
        return [
            Signature(
                Cause.PARAMETERS,
                "",
                columns,
                np.full(columns.shape[1], WRONG_PARAMETER),
                one_sided=False,
                share=0.5,
                size_in_words=_other_parameters,
            )
            for columns in (each, each.sum(axis=1, keepdims=True))
        ]


def _of_channel(cause: Cause, place: str, columns: Array) -> list[Signature]:
    share = 1.0 / (3.0 * len(CHANNELS))
    return [
        Signature(
            cause,
            place,
            columns,
            size * np.array([1.0, CHANNEL_PHASE]),
            one_sided=False,
            share=share,
            size_in_words=_error,
        )
        for size in CHANNELS
    ]


def _other_parameters(_size: float, _deviation: float) -> str:
    return "the currents are not those of a motor with these parameters"


def _drop(size: float, deviation: float) -> str:
    return (
        f"drop of {max(size, 0.0):.1%} (+-{NORMAL_95 * deviation:.1%}) of the rated voltage at rated current"
    )


def _error(size: float, deviation: float) -> str:
    return f"error of {size:+.1%} (+-{NORMAL_95 * deviation:.1%})"
