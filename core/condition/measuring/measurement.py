"""One record as the filter measures it: asymmetries as shares of the positive-sequence voltage."""

from math import sqrt
from typing import NamedTuple

from core.condition.errors import ObservationError
from core.condition.measuring.bounds import check
from core.condition.measuring.circle import BesideCircle, beside_circle
from core.condition.measuring.impedance import negative_impedance, slip_of
from core.condition.observation import Observation
from core.diagnosis.channel_errors import SIXTH
from core.machines.parameters import Connection, Motor
from core.quantity_text import with_unit

LEAST_CURRENT = 1e-3
"""Least |z I1 / V1|. A motor that runs takes a tenth; one that stands still takes none."""
LARGEST_UNBALANCE = 0.5
"""Largest |V2 / V1|: beyond it the supply lacks a phase, or the sequence is the other one."""


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
    circle : BesideCircle
        Where I1 lies beside the circle of the motor's file.
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
    circle: BesideCircle


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
    Z2n = negative_impedance(motor, f, slip_of(motor.parameters, f, 1.0 / i1))
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
        circle=beside_circle(observation, motor, scale_ohm),
    )
