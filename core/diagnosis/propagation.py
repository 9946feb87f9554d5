"""How errors of the sensors and of the motor's parameters reach the figures of a fit.

Each cause changes the difference between measured and modelled currents by one standard deviation of its own;
the fit turns that change into a change of its unknowns. Causes are independent, so their squares add up.
"""

from dataclasses import dataclass, replace
from math import hypot, pi, sqrt
from statistics import NormalDist
from typing import NamedTuple, Self

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.fundamental import Fundamental, axis_phasors, components
from core.diagnosis.refinement import Fit
from core.machines.base import Array, StatorModel
from core.machines.candidates import Candidates
from core.machines.parameters import ParameterTolerances
from core.machines.running import SteadyRunning
from core.machines.winding_frame import to_winding_frame

PARAMETER_NAMES = ParameterTolerances.names()
AXES = tuple(np.array([np.cos(angle), np.sin(angle)]) for angle in (0.0, 2.0 * pi / 3.0, 4.0 * pi / 3.0))
"""Axes of the phases a, b, c on the Clarke axes."""
CONFIDENCE_QUANTILE = NormalDist().inv_cdf(0.975)
"""Standard deviations that hold 95 % of a normal distribution between them."""
BEST_OF_THREE_QUANTILE = NormalDist().inv_cdf(1.0 - 0.05 / 3.0)
"""Standard deviations above zero that the greatest of three windings' levels stays below in 95 of 100 healthy
records."""


@dataclass(frozen=True, slots=True)
class Known:
    """What is known of the errors of one record, or is worse than usual.

    Parameters
    ----------
    share : float, default 0.0
        Share of the sensors' asymmetry that a baseline has taken off.
    unbalance_V : complex, default 0.0
        Backward-turning voltage of the baseline, seen as in `backward_voltage` [V, peak]. What the errors of
        the parameters make of it is taken off, too.
    error_A : float, default 0.0
        Standard deviation of what a baseline has taken off [A, peak].
    supply_unbalance : float, default 0.0
        Standard deviation of V2 / V1 where the voltages are assumed.
    """

    share: float = 0.0
    unbalance_V: complex = 0.0
    error_A: float = 0.0
    supply_unbalance: float = 0.0


def errors_of(case: Case, model: StatorModel, record: Fundamental, at: Candidates, known: Known) -> Array:
    """Compute what one standard deviation of every cause makes of the currents.

    Parameters
    ----------
    case : Case
        The record in the winding frame.
    model : StatorModel
        Machine model of the fault.
    record : Fundamental
        Phasors of the record.
    at : Candidates
        The candidate at which it is asked, a batch of one.
    known : Known
        What is known of the errors.

    Returns
    -------
    ndarray, shape (4, causes)
        Measured less modelled components of the current: forwards re, im, backwards re, im [A, peak].
    """
    machine = _Machine(case, model, record, at)
    return np.stack([*_of_sensors(case, record, machine, known), *_of_parameters(machine, known)], axis=1)


def deviation(fit: Fit, name: str, errors: Array) -> float:
    """Return the standard deviation of an unknown that the causes add up to.

    Parameters
    ----------
    fit : Fit
        The fit.
    name : str
        Name of the unknown; one that ended on its bound has none.
    errors : ndarray, shape (4, causes)
        What every cause makes of the currents.

    Returns
    -------
    float
        The standard deviation, in the unknown's unit.
    """
    response = fit.response.get(name)
    return 0.0 if response is None else float(np.linalg.norm(response @ errors))


def widened(value: float, interval: tuple[float, float], deviation: float) -> tuple[float, float]:
    """Widen an interval about a value by a further, independent cause.

    Parameters
    ----------
    value : float
        The estimate.
    interval : tuple of float
        Its 95 % interval from the other causes; it need not be symmetric.
    deviation : float
        Standard deviation of the further cause.

    Returns
    -------
    tuple of float
        The 95 % interval from all causes.
    """
    reach = CONFIDENCE_QUANTILE * deviation
    low, high = interval
    return value - hypot(max(0.0, value - low), reach), value + hypot(max(0.0, high - value), reach)


def of_the_likeliest_winding(value: float, interval: tuple[float, float]) -> tuple[float, float]:
    """Let the interval of a level begin at zero where a healthy motor would show as much.

    The level is that of the winding which explains the record best. The greatest of three levels that chance
    makes is greater than each of them usually is.

    Parameters
    ----------
    value : float
        The level.
    interval : tuple of float
        Its 95 % interval as that of one winding chosen beforehand.

    Returns
    -------
    tuple of float
        The 95 % interval.
    """
    low, high = interval
    deviation = (value - low) / CONFIDENCE_QUANTILE
    return (min(low, 0.0) if value <= BEST_OF_THREE_QUANTILE * deviation else low), high


class _Machine:
    """One candidate on one record, whose supply and parameters can be changed."""

    def __init__(self, case: Case, model: StatorModel, record: Fundamental, at: Candidates) -> None:
        self._case, self._model, self.at = case, model, at
        self.record = record
        self.volts = record.voltage.components
        self.here = self.current(self.volts)

    def current(self, volts: Array, parameter: str | None = None, *, healthy: bool = False) -> Array:
        """Components of the current on other voltages, or with one parameter a standard deviation greater."""
        motor = self._case.motor
        if parameter is not None:
            # Every error within the tolerance is as likely as another.
            deviation = getattr(motor.tolerances, parameter) / sqrt(3.0)
            value = getattr(motor.parameters, parameter) * (1.0 + deviation)
            motor = replace(motor, parameters=replace(motor.parameters, **{parameter: value}))
        at = replace(self.at, fault_level=np.zeros(1)) if healthy else self.at
        running = SteadyRunning(self._model, motor, self._case.supply.angular_frequency, axis_phasors(volts))
        return np.asarray(components(running.state(at).current)[0])

    def change(self, parameter: str, volts: Array, *, healthy: bool = False) -> Array:
        """Change of the current by one parameter."""
        before = self.current(volts, healthy=healthy)
        return np.asarray(self.current(volts, parameter, healthy=healthy) - before)


def _of_sensors(case: Case, record: Fundamental, machine: _Machine, known: Known) -> list[Array]:
    to_current, to_voltage = to_winding_frame(
        np.eye(2), np.eye(2), case.sequence, case.motor.nameplate.connection
    )
    backward = np.array([1.0, 1.0, 1.0 - known.share, 1.0 - known.share])
    sensors, frequency = case.motor.sensors, record.angular_frequency
    of_current = _Ratio.within(sensors.current_gain, sensors.current_delay_s, frequency)
    of_voltage = _Ratio.within(sensors.voltage_gain, sensors.voltage_delay_s, frequency)
    errors = [backward * one for one in _channels(record.current.components, to_current, of_current)]
    if case.voltages_assumed:
        forward = abs(record.voltage.forward)
        unknown = known.supply_unbalance * forward / sqrt(2.0)
        volts = [np.array([0.0, 0.0, unknown, 0.0]), np.array([0.0, 0.0, 0.0, unknown])]
        backward = np.ones(4)
    else:
        volts = _channels(record.voltage.components, to_voltage, of_voltage)
    errors += [backward * (machine.here - machine.current(machine.volts + one)) for one in volts]
    if known.error_A > 0.0:
        own = known.error_A / sqrt(2.0)
        errors += [np.array([0.0, 0.0, own, 0.0]), np.array([0.0, 0.0, 0.0, own])]
    return errors


def _of_parameters(machine: _Machine, known: Known) -> list[Array]:
    """Each parameter changes the current in proportion to the voltage: what a baseline saw is known."""
    forward, share = machine.record.voltage.forward, known.unbalance_V
    if share == 0.0:
        return [machine.change(name, machine.volts) for name in PARAMETER_NAMES]
    seen = share * forward.conjugate() / abs(forward)
    known_volts = np.array([forward.real, forward.imag, seen.real, seen.imag])
    only_backward = np.array([0.0, 0.0, 1.0, 1.0])
    return [
        machine.change(name, machine.volts) - only_backward * machine.change(name, known_volts, healthy=True)
        for name in PARAMETER_NAMES
    ]


class _Ratio(NamedTuple):
    """Standard deviations of a channel's ratio: of its size, and of its angle [rad]."""

    size: float
    angle: float

    @classmethod
    def within(cls, gain: float, delay_s: float, angular_frequency: float) -> Self:
        """Return those of errors uniform within plus and minus the spans."""
        return cls(gain / sqrt(3.0), angular_frequency * delay_s / sqrt(3.0))


def _channels(values: Array, to_windings: Array, ratio: _Ratio) -> list[Array]:
    """Return how gain and delay of each of three channels change a quantity's components."""
    phasor = axis_phasors(values)
    changes = []
    for axis in AXES:
        one = to_windings @ (2.0 / 3.0 * np.outer(axis, axis)) @ np.linalg.inv(to_windings) @ phasor
        changes += [
            components(ratio.size * one),
            components(-1j * ratio.angle * one),
        ]
    return changes
