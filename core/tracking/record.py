"""What the follower takes from one record: impedance, asymmetry, and how sure both are."""

from dataclasses import dataclass
from math import pi, sqrt
from typing import Final

import numpy as np

from core.condition.observation import Observation
from core.machines.base import Array
from core.machines.parameters import Connection, Motor
from core.thermal.full_load import full_load_current_A
from core.tracking.circuit import RUNNING_SLIP, TerminalCircuit, distance_from_circle, terminal_circuit
from core.tracking.unknowns import STATES, Unknown

LEAST_NOISE: Final = 5e-4
"""Standard deviation of Z1 over |Z1| that no model does without: harmonics, slots, wandering
transformers."""
LEAST_ASYMMETRY_NOISE: Final = 2e-5
"""The same of the asymmetry, a share of the voltage."""
ROTOR_SHARE: Final = 1.0 / (2.0 - RUNNING_SLIP)
"""Of R_R in Z2."""
_OF_R_S: Final = [Unknown.STATOR_RESISTANCE, Unknown.STATOR_RESISTANCE_CHANGE, Unknown.WARMTH]

_OF_L_SIGMA: Final = [Unknown.LEAKAGE, Unknown.LEAKAGE_CHANGE]
_OF_L_M: Final = [Unknown.MAGNETISING, Unknown.MAGNETISING_CHANGE]


@dataclass(frozen=True, slots=True)
class Rated:
    """Figures of a motor that records are seen against.

    Parameters
    ----------
    circuit : TerminalCircuit
        The motor file's circuit.
    flux_Vs : float
        Rated voltage of a winding over the angular frequency, peak [V s].
    current_A : float
        Full-load current of a winding, peak [A].
    """

    circuit: TerminalCircuit
    flux_Vs: float
    current_A: float


def rated_figures(motor: Motor) -> Rated:
    """Return the figures of a motor.

    Parameters
    ----------
    motor : Motor
        The motor.

    Returns
    -------
    Rated
        Its figures.
    """
    plate = motor.nameplate
    delta = plate.connection is Connection.DELTA
    winding_V = sqrt(2.0) * plate.rated_voltage_V / (1.0 if delta else sqrt(3.0))
    winding_A = sqrt(2.0) * full_load_current_A(motor) / (sqrt(3.0) if delta else 1.0)
    return Rated(terminal_circuit(motor.parameters), winding_V / plate.rated_angular_frequency, winding_A)


@dataclass(frozen=True, slots=True)
class Row:
    """One real measurement.

    Parameters
    ----------
    surprise : float
        What was measured less what the state expects.
    slopes : ndarray, shape (STATES,)
        How the expectation follows the state.
    variance : float
        Variance of the noise that is known from the record.
    """

    surprise: float
    slopes: Array
    variance: float


def distance_row(V: complex, current: complex, w: float, rated: Rated, x: Array) -> tuple[float, Array]:
    """Return how far an impedance lies outside the circle of a state, and how that follows the state.

    Parameters
    ----------
    V, current : complex
        V1 and I1 of a winding, peak [V, A].
    w : float
        Angular frequency of the supply [rad/s].
    rated : Rated
        Figures of the motor.
    x : ndarray, shape (STATES,)
        State.

    Returns
    -------
    float
        Distance over |V / I|.
    ndarray, shape (STATES,)
        Its slopes.
    """
    of, Z = rated.circuit, V / current
    heat = (abs(current) / rated.current_A) ** 2
    flux = abs(V) / (w * rated.flux_Vs) - 1.0
    resistance = 1.0 + x[_OF_R_S].sum() + x[Unknown.HEATING] * heat
    leakage = 1.0 + x[_OF_L_SIGMA].sum()
    magnetising = 1.0 + x[_OF_L_M].sum() - x[Unknown.SATURATION] * flux
    figures = np.array([of.R_s, w * of.L_sigma, w * of.L_M])
    distance, slopes = distance_from_circle(Z, *(figures * (resistance, leakage, magnetising)))
    by_R_s, by_L_sigma, by_L_M = slopes * figures / abs(Z)
    h = np.zeros(STATES)
    h[_OF_R_S], h[Unknown.HEATING] = by_R_s, by_R_s * heat
    h[_OF_L_SIGMA] = by_L_sigma
    h[_OF_L_M], h[Unknown.SATURATION] = by_L_M, -by_L_M * flux
    return distance / abs(Z), h


def impedance_row(observation: Observation, rated: Rated, x: Array) -> Row:
    """Return what a record's positive sequence tells: its distance from the circle, which is to be zero.

    Parameters
    ----------
    observation : Observation
        The record.
    rated : Rated
        Figures of the motor.
    x : ndarray, shape (STATES,)
        State.

    Returns
    -------
    Row
        The distance over |Z1|.
    """
    w = 2.0 * pi * observation.frequency_hz
    V, current = observation.positive_voltage_V, observation.positive_current_A
    distance, slopes = distance_row(V, current, w, rated, x)
    # The scatter of V2/V1 - Z2 I2/V1 is that of both voltages and currents.
    noise = 0.5 * observation.scatter * (1.0 + abs(V / current / rated.circuit.negative_impedance(w)) ** 2)
    return Row(-distance, slopes, LEAST_NOISE**2 + noise)


@dataclass(frozen=True, slots=True)
class Asymmetry:
    """A record's negative sequence.

    Parameters
    ----------
    drop : complex
        Z2 I2/V1.
    rows : tuple of Row
        Real and imaginary part of V2/V1 - Z2 I2/V1.
    """

    drop: complex
    rows: tuple[Row, Row]


def asymmetry(observation: Observation, rated: Rated, x: Array) -> Asymmetry:
    """Return what a record's negative sequence tells: its impedance, where the supply's unbalance varies.

    Parameters
    ----------
    observation : Observation
        The record.
    rated : Rated
        Figures of the motor.
    x : ndarray, shape (STATES,)
        State.

    Returns
    -------
    Asymmetry
        Real and imaginary part of V2/V1 - Z2 I2/V1, with Z2 of the motor's file. The state expects
        E + C Z2 I1/V1 + (Z2 of the state - Z2 of the file) I2/V1.
    """
    of, w = rated.circuit, 2.0 * pi * observation.frequency_hz
    Z2, V1 = of.negative_impedance(w), observation.positive_voltage_V
    i1, i2 = observation.positive_current_A / V1, observation.negative_current_A / V1
    y = observation.negative_voltage_V / V1 - Z2 * i2
    heat = (abs(observation.positive_current_A) / rated.current_A) ** 2
    rotor = ROTOR_SHARE * of.R_R
    both = (of.R_s + rotor) * i2
    columns = np.zeros(STATES, complex)
    columns[[Unknown.STATOR_RESISTANCE_CHANGE, Unknown.WARMTH]] = both
    columns[Unknown.HEATING] = both * heat
    columns[[Unknown.ROTOR_RESISTANCE, Unknown.ROTOR_RESISTANCE_CHANGE]] = rotor * i2
    columns[[Unknown.NEGATIVE_LEAKAGE, Unknown.LEAKAGE_CHANGE]] = 1j * w * of.L_sigma * i2
    columns[[Unknown.E_REAL, Unknown.E_IMAGINARY]] = 1.0, 1j
    columns[[Unknown.C_REAL, Unknown.C_IMAGINARY]] = Z2 * i1, 1j * Z2 * i1
    left = y - complex(columns @ x)
    variance = LEAST_ASYMMETRY_NOISE**2 + 0.5 * observation.scatter
    rows = Row(left.real, columns.real.copy(), variance), Row(left.imag, columns.imag.copy(), variance)
    return Asymmetry(Z2 * i2, rows)
