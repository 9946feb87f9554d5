"""What a record's phasors are expected to show: of each cause, and of a sound motor besides."""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt
from typing import Final

import numpy as np

from core.classification.causes import Cause
from core.condition.changes.hypotheses import PATH_SHARES, rated_current
from core.condition.filter.prior import OWN_CURRENT, prior_of
from core.condition.measuring.measurement import measure, negative_impedance
from core.condition.measuring.signatures import (
    HALF_WARM,
    PATHS,
    A,
    channel_of,
    shorted_turns,
    terminal_turn,
    voltage_channels,
)
from core.condition.observation import Observation, VoltageChannels
from core.diagnosis.parameter_check import TOGETHER, check_admittance
from core.machines.base import Array
from core.machines.current_locus import current_locus
from core.machines.parameters import Connection, Motor
from core.machines.winding_frame import terminal_winding

LEVEL: Final = 0.02
"""Usual level of shorted turns, over the turns of a phase."""
JOINT_DROP: Final = 0.015
"""Usual drop over a joint at rated current, over the rated voltage."""
CHANNEL: Final = 0.025
"""Usual error of a wrong channel; `SensorClass` has those of sound ones."""
UNBALANCED: Final = 0.02
"""Usual V2/V1 of an unbalanced supply, real and imaginary part each."""
BALANCED, BALANCED_ZERO = 0.005, 0.007
"""The same of a usual supply, and that of V0/V1."""
BESIDE_CIRCLE: Final = 0.1
"""Usual distance of the current from the circle of wrong parameters, a share of it."""
WRONG_IMPEDANCE: Final = 0.06
"""Usual error of Z2 beside it, real and imaginary part each."""
TURNS_DIRECTION, JOINT_DIRECTION, CHANNEL_PHASE = 0.1, 0.1, 0.3
"""How far a signature may turn, over its size: the leakage of the shorted turns, the motor's parameters, and
the phase error of a wrong channel."""
FLOOR: Final = 3e-4
"""Standard deviation of y and I0/I1 that no length of a record takes away."""
ON_CIRCLE: Final = 0.004
"""The same of the distance from the circle."""
PHASES: Final = ("a", "b", "c")
LINES: Final = ("ab", "bc", "ca")


@dataclass(frozen=True, slots=True)
class Signature:
    """What one cause in one place adds to the figures of a record.

    Parameters
    ----------
    cause : Cause
        The cause.
    place : str
        Phase, winding or channel, in words; empty where it has none.
    columns : ndarray, shape (n, k)
        Added per size, and per size in other directions.
    spread : ndarray, shape (k,)
        Usual sizes.
    one_sided : bool
        Whether the first size is positive.
    share : float
        Share of this place in its cause.
    told : callable
        Returns size and standard deviation in words.
    """

    cause: Cause
    place: str
    columns: Array
    spread: Array
    one_sided: bool
    share: float
    told: Callable[[float, float], str]

    def words(self, size: float, deviation: float) -> str:
        """Return size and place in words.

        Parameters
        ----------
        size, deviation : float
            Size and its standard deviation.

        Returns
        -------
        str
            The words.
        """
        return f"{self.place}: {self.told(size, deviation)}" if self.place else self.told(size, deviation)


class RecordModel:
    """Figures of one record, their covariance in a sound motor, and what each cause would add.

    Parameters
    ----------
    observation : Observation
        Phasors of the record.
    motor : Motor
        The motor, with tolerances and the class of its sensors.
    """

    figures: Array
    """Real and imaginary parts of y, V2/V1, V0/V1 where it is measured, I0/I1; distance from the circle."""
    covariance: Array
    """Their covariance in a sound motor on a usual supply."""
    signatures: tuple[Signature, ...]
    """All places of all causes."""

    def __init__(self, observation: Observation, motor: Motor) -> None:
        self._observation, self._motor = observation, motor
        plate = motor.nameplate
        self._z = abs(negative_impedance(motor.parameters, plate.rated_frequency_Hz))
        seen = self._seen = measure(observation, motor, self._z, 0.0)
        self._has_v0 = seen.has_v0
        self._turn = terminal_turn(motor)
        w = 2.0 * pi * observation.frequency_hz
        admittance = observation.positive_current_A / observation.positive_voltage_V
        centre = current_locus(motor.parameters, w).centre
        self._outwards = (admittance - centre) / abs(admittance - centre)
        self._admittance = admittance
        # Peak of a winding's phasor at rated voltage and frequency.
        per_line = sqrt(2.0) if plate.connection is Connection.DELTA else sqrt(2.0 / 3.0)
        relative_V = abs(observation.positive_voltage_V) / (per_line * plate.rated_voltage_V)
        self._check = check_admittance(admittance, relative_V, w, motor)
        self.figures = self._row(y=seen.y, v2=seen.v2, v0=seen.v0, i0=seen.i0, distance=self._check.distance)
        self.covariance = self._covariance()
        self.signatures = (
            *self._shorted_turns(),
            *self._joints(),
            *self._channels_of_voltage(),
            *self._channels_of_current(),
            self._supply(),
            self._parameters(),
        )

    def _row(
        self, y: complex = 0j, v2: complex = 0j, v0: complex = 0j, i0: complex = 0j, distance: float = 0.0
    ) -> Array:
        values = (y, v2, v0, i0) if self._has_v0 else (y, v2, i0)
        return np.array([part for one in values for part in (one.real, one.imag)] + [distance])

    def _drawn(self, share: complex) -> float:
        """Return how far the current moves from the circle when it grows by a complex share."""
        more = share * self._admittance
        return (self._outwards.conjugate() * more).real / abs(self._admittance)

    def _covariance(self) -> Array:
        seen, motor, sensors = self._seen, self._motor, self._motor.sensors
        prior = prior_of(motor, self._observation.voltage_channels)
        frequency = self._observation.frequency_hz
        own = sqrt(prior.own[0, 0] + (OWN_CURRENT * abs(seen.j1)) ** 2 / 2.0)
        noise = sqrt(seen.scatter / 2.0 + FLOOR**2)
        # A wrong Z2 takes its share of the current that V2 drives, not of a fault's own.
        impedance = prior.impedance * abs(seen.v2)
        rows = [self._row(y=part * size) for part in (1.0, 1j) for size in (own, noise, impedance)]
        rows += [self._row(v2=BALANCED * part) for part in (1.0, 1j)]
        rows += [self._row(v0=BALANCED_ZERO * part) for part in (1.0, 1j)]
        rows += [self._row(i0=FLOOR * part) for part in (1.0, 1j)]
        beside = sqrt((TOGETHER * self._check.parameters) ** 2 / 3.0 + self._check.channels**2 + ON_CIRCLE**2)
        rows.append(self._row(distance=beside))
        angle = 2.0 * pi * frequency / sqrt(3.0)
        shares = (
            1.0 if self._observation.voltage_channels is not VoltageChannels.TWO_LINES else sqrt(2.0 / 3.0)
        )
        for x, e in enumerate(voltage_channels(self._observation.voltage_channels)):
            gain, delay = sensors.voltage_gain / sqrt(3.0), angle * sensors.voltage_delay_s
            rows += [shares * self._voltage_error(x, e, one) for one in (gain, 1j * delay)]
        for x in range(3):
            gain, delay = sensors.current_gain / sqrt(3.0), angle * sensors.current_delay_s
            rows += [self._current_error(x, one) for one in (gain, 1j * delay)]
        errors = np.array(rows)
        return np.asarray(errors.T @ errors)

    def _voltage_error(self, x: int, e: complex, error: complex, *, drawn: float = 0.0) -> Array:
        phase = self._observation.voltage_channels is VoltageChannels.PHASE
        return self._row(
            y=e * self._turn * error,
            v2=e * error,
            v0=A**-x / 3.0 * error if phase else 0j,
            distance=-drawn * self._drawn(error / 3.0),
        )

    def _current_error(self, x: int, error: complex, *, drawn: float = 0.0) -> Array:
        Z2n = negative_impedance(self._motor.parameters, self._motor.nameplate.rated_frequency_Hz)
        return self._row(
            y=-Z2n / self._z * A**x / 3.0 * self._turn * self._seen.j1 * error,
            i0=A**-x / 3.0 * error,
            distance=drawn * self._drawn(error / 3.0),
        )

    def _shorted_turns(self) -> list[Signature]:
        motor, found = self._motor, []
        f = motor.nameplate.rated_frequency_Hz
        R_s = HALF_WARM * motor.parameters.stator_resistance_ohm
        X_ls = 2.0 * pi * f * motor.parameters.stator_leakage_H
        for x in range(3):
            for p, share in zip(PATHS, PATH_SHARES, strict=True):
                u = shorted_turns(motor, x, p)
                drawn = (1.0 + p) / (3.0 * complex(R_s * (1.0 + p), X_ls)) / self._admittance
                columns = [self._row(y=u, distance=self._drawn(drawn)), self._row(y=1j * u)]
                phase = PHASES[self._winding(x)]
                found.append(
                    Signature(
                        Cause.SHORTED_TURNS,
                        f"phase {phase}",
                        np.column_stack(columns),
                        np.array([LEVEL, TURNS_DIRECTION * LEVEL]),
                        one_sided=True,
                        share=share / 3.0,
                        told=_level,
                    )
                )
        return found

    def _joints(self) -> list[Signature]:
        motor, j1, found = self._motor, self._seen.j1, []
        rated = rated_current(motor, self._z)
        delta = motor.nameplate.connection is Connection.DELTA
        for x in range(3):
            # In delta a joint lies in a winding, or in a line, whose current is another.
            places = [("winding", 1.0 + 0j), ("line", self._turn)] if delta else [("phase", 1.0 + 0j)]
            for name, turn in places:
                u = A**x / 3.0 * turn * j1 / rated
                drop = -self._z / rated / 3.0 * self._admittance
                columns = [self._row(y=u, distance=self._drawn(drop)), self._row(y=1j * u)]
                winding = self._winding(x) if name != "line" else self._line(x)
                found.append(
                    Signature(
                        Cause.CONNECTION,
                        f"{name} {PHASES[winding]}",
                        np.column_stack(columns),
                        np.array([JOINT_DROP, JOINT_DIRECTION * JOINT_DROP]),
                        one_sided=True,
                        share=1.0 / (3.0 * len(places)),
                        told=_drop,
                    )
                )
        return found

    def _channels_of_voltage(self) -> list[Signature]:
        channels, found = self._observation.voltage_channels, []
        names = PHASES if channels is VoltageChannels.PHASE else LINES
        for x, e in enumerate(voltage_channels(channels)):
            channel = channel_of(x, channels, self._observation.sequence)
            found.append(
                Signature(
                    Cause.VOLTAGE_CHANNEL,
                    "one of the lines" if channel is None else f"channel {names[channel]}",
                    np.column_stack(
                        [self._voltage_error(x, e, 1.0, drawn=1.0), self._voltage_error(x, e, 1j, drawn=1.0)]
                    ),
                    np.array([CHANNEL, CHANNEL_PHASE * CHANNEL]),
                    one_sided=False,
                    share=1.0 / 3.0,
                    told=_error,
                )
            )
        return found

    def _channels_of_current(self) -> list[Signature]:
        return [
            Signature(
                Cause.CURRENT_CHANNEL,
                f"channel {PHASES[self._line(x)]}",
                np.column_stack([self._current_error(x, one, drawn=1.0) for one in (1.0, 1j)]),
                np.array([CHANNEL, CHANNEL_PHASE * CHANNEL]),
                one_sided=False,
                share=1.0 / 3.0,
                told=_error,
            )
            for x in range(3)
        ]

    def _supply(self) -> Signature:
        unbalance = abs(self._seen.v2)
        return Signature(
            Cause.SUPPLY,
            "",
            np.column_stack([self._row(v2=1.0 + 0j), self._row(v2=1j)]),
            np.array([UNBALANCED, UNBALANCED]),
            one_sided=False,
            share=1.0,
            told=lambda _size, _deviation: f"V2/V1 is {unbalance:.1%}",
        )

    def _parameters(self) -> Signature:
        beside, driven = abs(self._check.distance), self._seen.v2 * self._turn
        return Signature(
            Cause.PARAMETERS,
            "",
            np.column_stack([self._row(distance=1.0), self._row(y=driven), self._row(y=1j * driven)]),
            np.array([BESIDE_CIRCLE, WRONG_IMPEDANCE, WRONG_IMPEDANCE]),
            one_sided=False,
            share=1.0,
            told=lambda _size, _deviation: f"the current lies {beside:.1%} beside the motor's circle",
        )

    def _winding(self, x: int) -> int:
        return terminal_winding(x, self._observation.sequence, self._motor.nameplate.connection)

    def _line(self, x: int) -> int:
        return terminal_winding(x, self._observation.sequence, Connection.STAR)


def _level(size: float, deviation: float) -> str:
    return f"equivalent level {max(size, 0.0):.1%} (+-{1.96 * deviation:.1%})"


def _drop(size: float, deviation: float) -> str:
    return f"drop of {max(size, 0.0):.1%} (+-{1.96 * deviation:.1%}) of the rated voltage at rated current"


def _error(size: float, deviation: float) -> str:
    return f"error of {size:+.1%} (+-{1.96 * deviation:.1%})"
