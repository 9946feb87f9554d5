"""What channels, parameters, the winding itself and noise make of a record's figures: their covariance.

Every error is small and changes the residual in proportion (a column); errors are independent, so their
columns' squares add up. Rows are re and im of I1/V1, of I2/V1, of V0/V1 where it is measured, and of I0/I1,
the first two made dimensionless: a share of I1, and a share of V1.

What parameters make of the figures depends on the point: with shorted turns R_s and X_ls act on their current
as well, so the covariance is taken again at the likeliest ones.
"""

from dataclasses import dataclass
from enum import Enum
from math import hypot, pi, sqrt
from typing import Final, NamedTuple

import numpy as np

from core.diagnosis.channel_errors import A, terminal_turn, voltage_channels, voltage_forward_shares
from core.diagnosis.coil_likelihood import ComparedRecord, MachineNumbers, ShortedTurns, ratios
from core.diagnosis.priors import MISFIT, SATURATION_SPREAD, saturated_share
from core.diagnosis.record_figures import RecordFigures
from core.machines.base import Array
from core.machines.coil_fault import SequencePair
from core.machines.feeder import susceptance_S
from core.machines.model_names import Model
from core.machines.parameters import Connection, Motor
from core.signals.terminals import VoltageChannels

TEMPERATURE: Final = 0.08
"""Standard deviation of R_s by the winding's temperature, relative."""
OWN_ASYMMETRY: Final = 0.002
"""Standard deviation of a sound motor's own asymmetry, a share of V1 (complex magnitude)."""
OWN_ZERO: Final = 0.003
"""Standard deviation of V0/V1 (complex magnitude)."""
BESIDE_CIRCLE: Final = 0.004
"""Standard deviation of I1 by what no parameter explains, a share of it (complex magnitude)."""
OF_ZERO_CURRENT: Final = 4e-4
"""The same of I0/I1."""
ANY_ZERO_CURRENT: Final = 0.2
"""The same where there are no voltages: other recorders than relays then, whose currents need not add up."""
OF_A_NEUTRAL: Final = 2.0
"""The same with the star point on the neutral, whose current tells nothing of the channels."""
STEP: Final = 1e-3
LEAST_RATIO: Final = 1e-4
HEALTHY: Final = ShortedTurns(0.0, 1.0, 1.0 + 0.0j, 0)


@dataclass(frozen=True, slots=True)
class Known:
    """What is known of the errors of one record, or is worse than usual.

    Parameters
    ----------
    share : float, default 0.0
        Share of the sensors' asymmetry that a baseline has taken off.
    unbalance : complex, default 0.0
        V2/V1 of the baseline. What the errors of the parameters make of it is taken off, too.
    error_S : float, default 0.0
        Standard deviation of what a baseline has taken off of I2/V1 [S].
    supply_unbalance : float, default 0.0
        Standard deviation of V2/V1 where the voltages are assumed.
    bank_S : float, default 0.0
        Susceptance of a line of capacitors that the record shows and that are taken off [S].
    bank_error_S : float, default 0.0
        Its standard deviation, in the frame of the windings [S].
    beside_circle : float, default 0.0
        Standard deviation of I1 by motors beside this one, a share of it (complex magnitude).
    """

    share: float = 0.0
    unbalance: complex = 0.0j
    error_S: float = 0.0
    supply_unbalance: float = 0.0
    bank_S: float = 0.0
    bank_error_S: float = 0.0
    beside_circle: float = 0.0


class Element(Enum):
    """Where an element behind the relay lies, seen from line x."""

    BETWEEN_LINES = "between the two other lines"
    TO_NEUTRAL = "from the line to the neutral"
    OF_FREE_STAR = "in the line, of a star whose star point is free: its positive sequence"


class Figures(NamedTuple):
    """Parts of a residual, or of what an error adds to it.

    Parameters
    ----------
    first, second, v0, i0 : complex
        Of I1/V1 and I2/V1, dimensionless, of V0/V1 and I0/I1.
    """

    first: complex = 0j
    second: complex = 0j
    v0: complex = 0j
    i0: complex = 0j


class Columns(NamedTuple):
    """What one standard deviation of each error adds to a residual.

    Parameters
    ----------
    parameters : ndarray, shape (errors, figures)
        Errors of parameters, in the order of `RecordErrors.other_machines`.
    others : ndarray, shape (errors, figures)
        Errors of channels, of the winding, and of the model.
    """

    parameters: Array
    others: Array


class RecordErrors:
    """Errors of one record of a motor.

    Parameters
    ----------
    figures : RecordFigures
        The record.
    motor : Motor
        The motor, with its tolerances and the class of its channels.
    known : Known, optional
        What a baseline has taken off.
    model : str, optional
        Fault model, one of `core.machines.model_names.Model`.
    """

    def __init__(
        self, figures: RecordFigures, motor: Motor, known: Known | None = None, model: str = Model.COIL
    ) -> None:
        self.figures, self.motor = figures, motor
        self._known = Known() if known is None else known
        shared = 0.0 if model == Model.SHORTED_WINDING else 1.0
        self.machine = machine_numbers(motor, shared, figures.relative_flux(motor.nameplate))
        w = figures.angular_frequency
        leakage = w * (self.machine.L_ls + self.machine.L_lr)
        self.negative_scale = hypot(self.machine.R_s + self.machine.R_r / 2.0, leakage)
        self.admittance_scale = 1.0 / abs(figures.admittance)
        self.has_zero_voltage = figures.voltage_channels is VoltageChannels.PHASE
        self._turn = terminal_turn(motor)

    def row(self, parts: Figures) -> Array:
        """Return parts of a residual as real numbers, shape (8,), or (6,) where V0 is not measured."""
        values = parts if self.has_zero_voltage else (parts.first, parts.second, parts.i0)
        return np.array([part for one in values for part in (one.real, one.imag)])

    def ratios(self, turns: ShortedTurns, slip: float, machine: MachineNumbers | None = None) -> SequencePair:
        """Return I1/V1 and I2/V1 of a hypothesis on the record's voltages [S]."""
        figures = self.figures
        return ratios(
            self.machine if machine is None else machine,
            turns,
            figures.angular_frequency,
            figures.negative_voltage,
            slip,
        )

    def scaled(self, first: complex, second: complex) -> Figures:
        """Return what a change of I1/V1 and of I2/V1 [S] adds."""
        return Figures(first * self.admittance_scale, second * self.negative_scale)

    def residual(self, turns: ShortedTurns, slip: float, offset_s: float) -> Array:
        """Return measured less modelled figures of a hypothesis."""
        figures, modelled = self.figures, self.ratios(turns, slip)
        turn = np.exp(1j * figures.angular_frequency * offset_s)
        beside = self.scaled(
            figures.admittance * turn - modelled.positive,
            figures.negative_current_S * turn - modelled.negative,
        )
        zero = 0j if figures.zero_voltage is None else figures.zero_voltage
        return self.row(beside._replace(v0=zero, i0=figures.zero_current))

    def covariance(self, turns: ShortedTurns, slip: float) -> Array:
        """Return the covariance of the figures' errors at a hypothesis."""
        columns = self.columns(turns, slip)
        found = columns.parameters.T @ columns.parameters + columns.others.T @ columns.others
        return np.asarray(found + self.noise(slip))

    def columns(self, turns: ShortedTurns, slip: float) -> Columns:
        """Return what one standard deviation of every error but noise adds at a hypothesis."""
        others = [*self._of_channels(slip), *self._own(turns, slip)]
        return Columns(np.array(self._of_parameters(turns, slip)), np.array(others))

    def other_machines(self) -> list[MachineNumbers]:
        """Return the machine with each of its parameters one standard deviation greater."""
        return [self._with(_OF_PARAMETER[name], 1.0 + spread) for name, spread in self._parameter_spreads()]

    def of_channels_alike(self) -> Array:
        """Return the covariance by channels whose errors are alike in both sequences and both parts."""
        sensors, frequency = self.motor.sensors, self.figures.angular_frequency / (2.0 * pi)
        ratio = hypot(sensors.voltage_deviation(frequency), sensors.current_deviation(frequency)) / sqrt(2.0)
        drop = abs(self.figures.admittance) * self.negative_scale
        spread = np.full(self.row(Figures()).size, max(ratio, LEAST_RATIO) / sqrt(6.0))
        spread[2:4] *= drop
        return np.diag(spread**2)

    def noise(self, slip: float) -> Array:
        """Return the covariance of the record's own scatter."""
        Z2 = self._negative_impedance(slip)
        mix = np.zeros((self.row(Figures()).size, 6))
        for k, part in enumerate((1.0 + 0.0j, 1j)):
            mix[:, k] = self.row(self.scaled(part, 0j))
            mix[:, 2 + k] = self.row(self.scaled(0j, part))
            mix[:, 4 + k] = self.row(self.scaled(0j, -part / Z2))
        return np.asarray(mix @ self.figures.noise @ mix.T)

    def voltage_error(self, x: int, error: complex, slip: float) -> Array:
        """Return what a relative error of a voltage channel adds."""
        channels = self.figures.voltage_channels
        if channels is None:
            return self.row(Figures())
        e = voltage_channels(channels)[x] * self._turn
        f = voltage_forward_shares(channels)[x]
        found = self.figures
        seen = self.scaled(
            -f * found.admittance * error,
            -f * found.negative_current_S * error - e * error / self._negative_impedance(slip),
        )
        return self.row(seen._replace(v0=A**-x / 3.0 * error))

    def current_error(self, x: int, error: complex) -> Array:
        """Return what a relative error of a current channel adds."""
        found = self.figures
        turned = A**x * self._turn * found.admittance
        seen = self.scaled(found.admittance * error / 3.0, (found.negative_current_S + turned) * error / 3.0)
        return self.row(seen._replace(i0=A**-x / 3.0 * error))

    def joint(self, x: int, resistance_ohm: complex, slip: float, *, in_line: bool) -> Array:
        """Return what a resistance in series with a winding, or in a line of a delta, adds."""
        Y = self.figures.admittance
        turned = A**x * (self._turn if in_line else 1.0)
        drop = resistance_ohm * Y / 3.0
        return self.row(self.scaled(-drop * Y, -turned * drop / self._negative_impedance(slip)))

    def load(self, x: int, admittance_S: complex, element: "Element") -> Array:
        """Return what an element behind the relay adds; see `Element` for where it lies and what it is."""
        found = admittance_S / (3.0 if self.motor.nameplate.connection is Connection.DELTA else 1.0)
        turned = A**x * self._turn
        if element is Element.BETWEEN_LINES:
            return self.row(self.scaled(found, -turned * found))
        if element is Element.OF_FREE_STAR:
            return self.row(self.scaled(found, turned * found))
        seen = self.scaled(found / 3.0, turned * found / 3.0)
        return self.row(seen._replace(i0=A**-x / 3.0 * found / self.figures.admittance))

    def bank(self, susceptance_S: float) -> Array:
        """Return what capacitors behind the relay add, alike in all lines, in the frame of the windings."""
        drawn = 1j * susceptance_S
        return self.row(self.scaled(drawn, drawn * self.figures.negative_voltage))

    @property
    def bank_S(self) -> float:
        """Susceptance of a bank of capacitors behind the relay, of a line; zero where none is known of."""
        bank = self.motor.capacitors
        return self._known.bank_S if bank is None else susceptance_S(self.motor, bank.kvar)

    def asymmetry(self, y: complex, slip: float) -> Array:
        """Return what an asymmetry of another kind adds, a share of V1."""
        return self.row(self.scaled(0j, -y / self._negative_impedance(slip)))

    def by_parameter(self, turns: ShortedTurns, slip: float) -> dict[str, Array]:
        """Return what one per unit of each parameter of the circuit adds."""
        columns, share = {}, self._known.unbalance
        for name, field in _OF_PARAMETER.items():
            up, down = (self._with(field, 1.0 + step) for step in (STEP, -STEP))
            more, less = self.ratios(turns, slip, up), self.ratios(turns, slip, down)
            known = 0j
            if share != 0.0:
                w = self.figures.angular_frequency
                known = ratios(up, HEALTHY, w, share, slip).negative
                known -= ratios(down, HEALTHY, w, share, slip).negative
            change = self.scaled(more.positive - less.positive, more.negative - less.negative - known)
            columns[name] = self.row(change) / (2.0 * STEP)
        return columns

    def log_constant(self, covariance: Array) -> float:
        """Return what of the log of the likelihood does not depend on the hypothesis."""
        return float(self.log_constants(covariance[np.newaxis])[0])

    def log_constants(self, covariances: Array) -> Array:
        """Return that of each covariance, shape (n,); they are of shape (n, figures, figures)."""
        logdets = np.linalg.slogdet(covariances)[1]
        zero = self._zero_sequences()
        given = np.linalg.solve(covariances[:, 4:, 4:], zero[:, np.newaxis])[..., 0]
        return np.asarray(-0.5 * (logdets + given @ zero))

    def compared(self, covariance: Array, slip_range: tuple[float, float, float]) -> ComparedRecord:
        """Return what the inner loop compares: currents, given what the zero sequences show."""
        return self.compared_by_each(covariance[np.newaxis], slip_range)[0]

    def compared_by_each(
        self, covariances: Array, slip_range: tuple[float, float, float]
    ) -> list[ComparedRecord]:
        """Return that for each covariance; they are of shape (n, figures, figures)."""
        figures = self.figures
        zero = self._zero_sequences()
        of_zero, across = covariances[:, 4:, 4:], covariances[:, 4:, :4]
        share = np.linalg.solve(of_zero, across).transpose(0, 2, 1)
        expected, given = share @ zero, covariances[:, :4, :4] - share @ across
        rated, lowest, highest = slip_range
        return [
            ComparedRecord(
                angular_frequency=figures.angular_frequency,
                admittance=figures.admittance,
                negative_current=figures.negative_current_S,
                negative_voltage=figures.negative_voltage,
                admittance_scale=self.admittance_scale,
                negative_scale=self.negative_scale,
                whitening=whitening,
                expected=one,
                rated_slip=rated,
                lowest_slip=lowest,
                highest_slip=highest,
            )
            for whitening, one in zip(np.linalg.inv(np.linalg.cholesky(given)), expected, strict=True)
        ]

    def _zero_sequences(self) -> Array:
        """Return the rows of the residual that no hypothesis changes."""
        figures = self.figures
        zero = 0j if figures.zero_voltage is None else figures.zero_voltage
        return self.row(Figures(v0=zero, i0=figures.zero_current))[4:]

    def _negative_impedance(self, slip: float) -> complex:
        return 1.0 / ratios(self.machine, HEALTHY, self.figures.angular_frequency, 1.0 + 0j, slip).negative

    def _with(self, field: str, factor: float) -> MachineNumbers:
        return self.machine._replace(**{field: factor * getattr(self.machine, field)})

    def _of_channels(self, slip: float) -> list[Array]:
        sensors, w = self.motor.sensors, self.figures.angular_frequency
        left = np.ones(self.row(Figures()).size)
        left[2:4] = 1.0 - self._known.share
        columns = []
        for x in range(3):
            gain, delay = sensors.current_gain / sqrt(3.0), w * sensors.current_delay_s / sqrt(3.0)
            columns += [left * self.current_error(x, one) for one in (gain, -1j * delay)]
            gain, delay = sensors.voltage_gain / sqrt(3.0), w * sensors.voltage_delay_s / sqrt(3.0)
            if self.figures.voltage_channels is VoltageChannels.TWO_LINES:
                gain, delay = gain * sqrt(2.0 / 3.0), delay * sqrt(2.0 / 3.0)
            columns += [left * self.voltage_error(x, one, slip) for one in (gain, -1j * delay)]
        return columns

    def _of_parameters(self, turns: ShortedTurns, slip: float) -> list[Array]:
        columns = self.by_parameter(turns, slip)
        return [columns[name] * spread for name, spread in self._parameter_spreads()]

    def _parameter_spreads(self) -> list[tuple[str, float]]:
        """Return parameters and the standard deviations of what makes each another, relative."""
        saturated = SATURATION_SPREAD * abs(self.figures.relative_flux(self.motor.nameplate) - 1.0)
        within = [(name, getattr(self.motor.tolerances, name) / sqrt(3.0)) for name in _OF_PARAMETER]
        return [*within, ("stator_resistance_ohm", TEMPERATURE), ("stator_self_inductance_H", saturated)]

    def _own(self, turns: ShortedTurns, slip: float) -> list[Array]:
        known, half = self._known, sqrt(0.5)
        own = OWN_ASYMMETRY * (1.0 - known.share)
        healthy, faulty = self.ratios(HEALTHY, slip), self.ratios(turns, slip)
        change = faulty.positive - healthy.positive, faulty.negative - healthy.negative
        zero_current = ANY_ZERO_CURRENT if self.figures.voltage_channels is None else OF_ZERO_CURRENT
        zero_current = OF_A_NEUTRAL if self.motor.neutral else zero_current
        columns = [self.bank(known.bank_error_S)]
        beside = hypot(BESIDE_CIRCLE, known.beside_circle)
        for part in (half, 1j * half):
            columns += [
                self.asymmetry(part * hypot(own, known.supply_unbalance), slip),
                self.row(self.scaled(part * beside / self.admittance_scale, 0j)),
                self.row(Figures(v0=part * OWN_ZERO)),
                self.row(Figures(i0=part * zero_current)),
                self.row(self.scaled(part * MISFIT * change[0], 0j)),
                self.row(self.scaled(0j, part * MISFIT * change[1])),
                self.row(self.scaled(0j, part * known.error_S)),
            ]
        return columns


_OF_PARAMETER: Final = {
    "stator_resistance_ohm": "R_s",
    "rotor_resistance_ohm": "R_r",
    "stator_leakage_H": "L_ls",
    "rotor_leakage_H": "L_lr",
    "stator_self_inductance_H": "L_m",
}
"""Parameters of a motor file, and the symbols of what is in proportion to them."""


def machine_numbers(motor: Motor, shared: float = 1.0, relative_flux: float = 1.0) -> MachineNumbers:
    """Return a machine's parameters for compiled functions, at a flux over the rated one."""
    parameters = motor.parameters
    # Around a delta, and through a neutral, a fault's zero sequence has a way of its own.
    has_way = motor.nameplate.connection is Connection.DELTA or motor.neutral
    return MachineNumbers(
        parameters.stator_resistance_ohm,
        parameters.rotor_resistance_ohm,
        parameters.stator_leakage_H,
        parameters.rotor_leakage_H,
        parameters.magnetising_inductance_H * saturated_share(relative_flux),
        1.0 / 3.0 if has_way else 0.0,
        shared,
        *motor.backward_rotor,
    )
