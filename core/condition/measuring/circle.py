"""How far a record's forward-turning current lies beside the circle of its motor, and what moves it there.

The admittance I1/V1 lies on a circle whatever the load (`core.machines.current_locus`). The impedance of the
air gap has a circle whose diameter reaches from j X_m to j X_m parallel to j X_lr; R_s + j X_ls moves it, and
its inverse is the circle of the admittance.
"""

from math import cos, pi, sin, sqrt
from typing import Final, NamedTuple

from core.condition.observation import Observation
from core.diagnosis.priors import gain_deviation, offset_deviation_s
from core.machines.compiled import compiled_as_written as compiled
from core.machines.parameters import Connection, Motor

UNKNOWNS: Final = 6
"""Offset and gain over their standard deviations, relative errors of R_s, both leakages and L_s, and L_s lost
per relative rise of the flux."""
STEP: Final = 0.01
MOST_VOLTAGE: Final = 0.2
"""Largest relative error of the flux: a soft starter's is no matter of saturation."""

Slopes = tuple[float, float, float, float, float, float]


class BesideCircle(NamedTuple):
    """Where z I1/V1 lies beside the circle of the motor's file.

    Parameters
    ----------
    distance : float
        Outside the circle, below zero inside it.
    outwards : complex
        Direction in which the distance grows; 0 where nothing is measured.
    slopes : tuple of float
        By how much the distance grows with each of the unknowns.
    """

    distance: float
    outwards: complex
    slopes: Slopes


NOTHING: Final = BesideCircle(0.0, 0j, (0.0,) * 6)


def beside_circle(observation: Observation, motor: Motor, scale_ohm: float) -> BesideCircle:
    """Measure how far a record's current lies beside the circle.

    Parameters
    ----------
    observation : Observation
        Phasors of the record.
    motor : Motor
        The motor.
    scale_ohm : float
        Impedance z that makes currents dimensionless [ohm].

    Returns
    -------
    BesideCircle
        The distance.
    """
    machine, plate = motor.parameters, motor.nameplate
    w = 2.0 * pi * observation.frequency_hz
    volts = abs(observation.positive_voltage_V)
    per_line = sqrt(2.0) if plate.connection is Connection.DELTA else sqrt(2.0 / 3.0)
    flux = volts * plate.rated_frequency_Hz / (per_line * plate.rated_voltage_V * observation.frequency_hz)
    return _beside(
        observation.positive_current_A / observation.positive_voltage_V * scale_ohm,
        machine.stator_resistance_ohm / scale_ohm, w * machine.stator_leakage_H / scale_ohm,
        w * machine.rotor_leakage_H / scale_ohm, w * machine.magnetising_inductance_H / scale_ohm,
        w * offset_deviation_s(motor.sensors), gain_deviation(motor.sensors),
        min(max(flux - 1.0, -MOST_VOLTAGE), MOST_VOLTAGE),
    )  # fmt: skip


@compiled
def _circle(R_s: float, X_ls: float, X_lr: float, X_m: float) -> tuple[complex, float]:
    """Return centre and radius of the admittance's circle."""
    least = X_m * X_lr / (X_m + X_lr)
    radius = 0.5 * (X_m - least)
    centre = complex(R_s, X_ls + 0.5 * (X_m + least))
    square = centre.real**2 + centre.imag**2 - radius**2
    return centre.conjugate() / square, radius / square


@compiled
def _distance(Y: complex, R_s: float, X_ls: float, X_lr: float, X_m: float) -> float:
    centre, radius = _circle(R_s, X_ls, X_lr, X_m)
    return abs(Y - centre) - radius


@compiled
def _beside(
    Y: complex, R_s: float, X_ls: float, X_lr: float, X_m: float, angle: float, gain: float, flux: float
) -> BesideCircle:
    """Return distance, direction and slopes; a parameter that is larger lets the circle run away from Y."""
    centre, radius = _circle(R_s, X_ls, X_lr, X_m)
    away = Y - centre
    outwards = away / abs(away)
    here = abs(away) - radius
    more = 1.0 + STEP
    resistance = (_distance(Y, R_s * more, X_ls, X_lr, X_m) - here) / STEP
    leakage = (_distance(Y, R_s, X_ls * more, X_lr * more, X_m) - here) / STEP
    inductance = (_distance(Y, R_s, X_ls, X_lr, X_m * more) - here) / STEP
    turned = Y * complex(cos(angle), -sin(angle))
    return BesideCircle(
        here,
        outwards,
        (
            abs(turned - centre) - radius - here,
            gain * (outwards.conjugate() * Y).real,
            -resistance,
            -leakage,
            -inductance,
            flux * inductance,
        ),
    )
