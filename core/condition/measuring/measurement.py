"""One record as the filter measures it: asymmetries as shares of the positive-sequence voltage."""

from cmath import exp as cexp
from math import pi, sqrt
from typing import NamedTuple

from core.condition.errors import ObservationError
from core.condition.observation import Observation
from core.machines.parameters import Connection, MachineParameters, Motor
from core.quantity_text import plain, with_unit

WARM = 1.2
"""Resistance of a winding at work over that of the motor's file, where it is that of a cold one."""
RATED_SLIP = 0.02
LARGEST_SLIP = 0.1
LEAST_CURRENT = 1e-3
"""Least |z I1 / V1|. A motor that runs takes a tenth; one that stands still takes none."""
LARGEST_UNBALANCE = 0.5
"""Largest |V2 / V1|: beyond it the supply lacks a phase, or the sequence is the other one."""
SIXTH = cexp(1j * pi / 6.0)


class Measurement(NamedTuple):
    """What of a record enters the filter.

    Parameters
    ----------
    elapsed_s : float
        Time since the record before [s].
    y : complex
        Asymmetry v2 - Z2n i2 of the windings.
    j1, j2 : complex
        Currents z I1/V1 and z I2/V1 of the windings.
    v2 : complex
        V2/V1 of the terminals.
    v0 : complex
        V0/V1 of the terminals; 0 where it is not measured.
    i0, i2 : complex
        I0/I1 and I2/I1 of the terminals.
    bus : complex
        How far v2 has moved from that of the bus's other motors; 0 where there are none.
    scatter : float
        Variance of y from the record's own noise.
    has_v0, has_bus : bool
        Whether `v0` and `bus` are measured.
    """

    elapsed_s: float
    y: complex
    j1: complex
    j2: complex
    v2: complex
    v0: complex
    i0: complex
    i2: complex
    bus: complex
    scatter: float
    has_v0: bool
    has_bus: bool


def negative_impedance(machine: MachineParameters, frequency_hz: float, slip: float = RATED_SLIP) -> complex:
    """Return the nominal negative-sequence impedance of a warm motor.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of the machine.
    frequency_hz : float
        Supply frequency [Hz].
    slip : float, default RATED_SLIP
        Slip of the rotor against the positive sequence.

    Returns
    -------
    complex
        Z2n = 1.2 (R_s + R_r / (2 - s)) + j 2 pi f (L_ls + L_lr) [ohm].
    """
    resistance = WARM * (machine.stator_resistance_ohm + machine.rotor_resistance_ohm / (2.0 - slip))
    reactance = 2.0 * pi * frequency_hz * (machine.stator_leakage_H + machine.rotor_leakage_H)
    return complex(resistance, reactance)


def slip_of(machine: MachineParameters, frequency_hz: float, impedance: complex) -> float:
    """Return the slip at which a motor shows an impedance to the positive sequence.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of the machine.
    frequency_hz : float
        Supply frequency [Hz].
    impedance : complex
        V1/I1 of the windings [ohm].

    Returns
    -------
    float
        Slip, between 0 and 0.1.
    """
    w = 2.0 * pi * frequency_hz
    air_gap = impedance - complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H)
    if air_gap == 0.0:
        return LARGEST_SLIP
    admittance = 1.0 / air_gap + 1j / (w * machine.magnetising_inductance_H)
    if admittance == 0.0:
        return 0.0
    resistance = (1.0 / admittance).real
    if resistance <= 0.0:
        return LARGEST_SLIP
    return min(WARM * machine.rotor_resistance_ohm / resistance, LARGEST_SLIP)


def measure(observation: Observation, motor: Motor, scale_ohm: float, elapsed_s: float) -> Measurement:
    """Turn an observation into what the filter measures.

    Parameters
    ----------
    observation : Observation
        Phasors of the record.
    motor : Motor
        The motor.
    scale_ohm : float
        Impedance z that makes currents dimensionless [ohm].
    elapsed_s : float
        Time since the record before [s].

    Returns
    -------
    Measurement
        The record's measurement.

    Raises
    ------
    ObservationError
        If a number is missing, infinite or impossible, or the motor was not running on three phases.
    """
    check(observation)
    V1, I1 = observation.positive_voltage_V, observation.positive_current_A
    v2, i1, i2 = observation.negative_voltage_V / V1, I1 / V1, observation.negative_current_A / V1
    if abs(v2) >= LARGEST_UNBALANCE:
        raise ObservationError(
            f"negative_voltage_V is {abs(v2):.0%} of positive_voltage_V: expected less than"
            f" {LARGEST_UNBALANCE:.0%}. Check the record's phases and its sequence"
        )
    if scale_ohm * abs(i1) < LEAST_CURRENT:
        raise ObservationError(
            f"positive_current_A is {with_unit(abs(I1), 'A')} at {with_unit(abs(V1), 'V', 4)}: "
            "expected that of a running motor"
        )
    f = observation.frequency_hz
    Z2n = negative_impedance(motor.parameters, f, slip_of(motor.parameters, f, 1.0 / i1))
    # A delta's windings see V1 a twelfth of a turn ahead and sqrt 3 higher, V2 as much behind; the currents
    # are sqrt 3 lower. Channels belong to terminals.
    delta = motor.nameplate.connection is Connection.DELTA
    back = SIXTH * SIXTH if delta else 1.0
    v0_turn = SIXTH * sqrt(3.0) if delta else 1.0
    i0_turn = SIXTH / sqrt(3.0) if delta else 1.0
    V0 = observation.zero_voltage_V
    return Measurement(
        elapsed_s=elapsed_s,
        y=v2 - Z2n * i2,
        j1=scale_ohm * i1,
        j2=scale_ohm * i2,
        v2=v2 * back,
        v0=0j if V0 is None else V0 / V1 * v0_turn,
        i0=observation.zero_current_A / I1 * i0_turn,
        i2=observation.negative_current_A / I1 * back,
        bus=0j,
        scatter=observation.scatter,
        has_v0=V0 is not None,
        has_bus=False,
    )


LARGEST_VOLTAGE_V = 1e9
LARGEST_CURRENT_A = 1e9
LEAST_VOLTAGE_V = 1e-6
"""Peak values that no motor has; what lies beyond is a fault of the record."""
FREQUENCIES_HZ = (5.0, 500.0)
LARGEST_SCATTER = 1.0
"""The noise is then as large as the voltage."""
LARGEST_LOAD = 100.0
LONGEST_RECORDER = 200
"""Characters of the recorder's name: it is part of every state that is saved."""

_BOUNDS = {
    "positive_voltage_V": LARGEST_VOLTAGE_V,
    "negative_voltage_V": LARGEST_VOLTAGE_V,
    "zero_voltage_V": LARGEST_VOLTAGE_V,
    "positive_current_A": LARGEST_CURRENT_A,
    "negative_current_A": LARGEST_CURRENT_A,
    "zero_current_A": LARGEST_CURRENT_A,
    "scatter": LARGEST_SCATTER,
    "load_level": LARGEST_LOAD,
}
"""Largest absolute values; a number that is none is beyond them too."""


def check(observation: Observation) -> None:
    """Check that all numbers of an observation are finite and possible.

    Parameters
    ----------
    observation : Observation
        Phasors of the record.

    Raises
    ------
    ObservationError
        If a number is missing, infinite or impossible, or a text too long; the message names it.
    """
    for name, largest in _BOUNDS.items():
        value = getattr(observation, name)
        if value is not None and not (abs(value.real) <= largest and abs(value.imag) <= largest):
            raise ObservationError(f"{name} is {value:.4g}: expected a finite number, at most {largest:.4g}")
    lowest, highest = FREQUENCIES_HZ
    if not lowest <= observation.frequency_hz <= highest:
        raise ObservationError(
            f"frequency_hz is {plain(observation.frequency_hz, 4)}: expected {lowest:g} Hz to {highest:g} Hz"
        )
    if observation.scatter < 0.0:
        raise ObservationError(f"scatter is {observation.scatter}: expected a variance, not below 0")
    if observation.cycles < 1:
        raise ObservationError(f"cycles is {observation.cycles}: expected at least 1")
    if len(observation.recorder) > LONGEST_RECORDER:
        raise ObservationError(
            f"recorder has {len(observation.recorder)} characters: expected at most {LONGEST_RECORDER}"
        )
    if abs(observation.positive_voltage_V) < LEAST_VOLTAGE_V:
        raise ObservationError(
            f"positive_voltage_V is {observation.positive_voltage_V:.4g}: expected that of a running motor"
        )
