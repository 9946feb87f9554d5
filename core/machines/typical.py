"""Typical parameters of a rating, for a motor of which nothing but the nameplate is known.

Per unit of a winding's V^2 / P, the parameters of cage motors follow the rated power. The table is the trend
through published motors of 0.8 kW to 1.7 MW, which lie within its intervals:

- Krause, Wasynczuk, Sudhoff: Analysis of Electric Machinery and Drive Systems, 2nd edition, IEEE Press 2002,
  table 4.10-1: motors of 3, 50, 500 and 2250 hp at 220, 460 and 2300 V.
- The preset motors of 4 to 160 kW at 400 and 460 V of Simscape Electrical's asynchronous machine, which the
  Modelica Buildings library (lbl-srg) publishes as well.
- IEEE Task Force on Load Representation: Standard load models for power flow and dynamic performance
  simulation, IEEE Transactions on Power Systems 10 (1995) 1302-1313: small and large industrial motors.
- The motors of this project: 0.8 kW (the thesis, table 3.2), 7.5, 37 and 250 kW.

They are no more than a beginning. One motor of a rating differs from the next by a factor of two, an old one
of a high slip by more. Only a start of the motor itself, or its data sheet, tells its own parameters.
"""

from bisect import bisect
from dataclasses import dataclass, replace
from math import exp, log, sqrt

from core.machines.parameters import (
    MachineParameters,
    Motor,
    Nameplate,
    ParametersSource,
    ParameterTolerances,
    WoundRotor,
)

POWERS_W = (750.0, 7.5e3, 75e3, 750e3, 7.5e6)
STATOR_RESISTANCE_PU = (0.050, 0.027, 0.0145, 0.0090, 0.0060)
ROTOR_RESISTANCE_PU = (0.048, 0.025, 0.0115, 0.0085, 0.0060)
LEAKAGE_REACTANCE_PU = (0.060, 0.055, 0.060, 0.080, 0.085)
"""Of the stator, and as much of the rotor."""
MAGNETISING_REACTANCE_PU = (1.15, 1.75, 2.30, 3.40, 4.00)
INERTIA_CONSTANT_S = 0.3
"""H = J w_m^2 / (2 P) of rotor and load."""

RESISTANCE_FACTOR, ROTOR_RESISTANCE_FACTOR, REACTANCE_FACTOR, INERTIA_FACTOR = 2.2, 3.0, 2.1, 10.0
"""A motor of the rating lies within these factors of the typical parameters, either way."""
FACTORS = {
    "stator_resistance_ohm": RESISTANCE_FACTOR,
    "rotor_resistance_ohm": ROTOR_RESISTANCE_FACTOR,
    "stator_leakage_H": REACTANCE_FACTOR,
    "rotor_leakage_H": REACTANCE_FACTOR,
    "stator_self_inductance_H": REACTANCE_FACTOR,
    "inertia_kgm2": INERTIA_FACTOR,
}

PLATE_FACTOR = 1.6
"""The same of a wound rotor's resistance by its plate: speed and voltages are rounded, windings warm up."""
SLIP_TOLERANCE, SLIP_TOLERANCE_BELOW_1_KW = 0.2, 0.3
"""IEC 60034-1, table 20: how far the slip at rated power may be from that of the plate's speed."""
ROUNDING_RPM = 5.0
"""Plates round the speed to this at worst."""

ALL_ALIKE = 3
"""Impedances beyond what is typical that point to a common cause."""
STAR_FOR_DELTA = 3.0

TYPICAL_TOLERANCES = ParameterTolerances(
    **{name: log(factor) for name, factor in FACTORS.items() if name != "inertia_kgm2"}
)
COMMISSION = "collecting; commission me"
"""What a motor says whose parameters are typical ones."""
TYPICAL_REASON = (
    f"{COMMISSION}: the parameters are typical of the rating, not this motor's. Commission it from a "
    "recorded start (mcc commission) or give data-sheet values (mcc parameters); until then nothing is "
    "called a fault"
)


@dataclass(frozen=True, slots=True)
class TypicalParameters:
    """Typical parameters of a rating, with what they are worth.

    Parameters
    ----------
    parameters : MachineParameters
        The middle of what motors of the rating have.
    intervals : dict of str to tuple of float
        Lower and upper end of what they have, by parameter.
    """

    parameters: MachineParameters
    intervals: dict[str, tuple[float, float]]


def typical_parameters(nameplate: Nameplate, wound_rotor: WoundRotor | None = None) -> TypicalParameters:
    """Return the parameters that are typical of a nameplate.

    Between the powers of the table the logarithm of a parameter goes evenly with that of the power. Beyond
    them the last one holds. Where the plate has a speed, the rotor's resistance follows from it.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.
    wound_rotor : WoundRotor or None, optional
        The rotor's winding; None of a cage.

    Returns
    -------
    TypicalParameters
        Parameters and intervals.
    """
    base_ohm, w_b = nameplate.base_impedance_ohm, nameplate.rated_angular_frequency
    leakage_H = _at(LEAKAGE_REACTANCE_PU, nameplate) * base_ohm / w_b
    parameters = MachineParameters.from_magnetising_inductance(
        stator_resistance_ohm=_at(STATOR_RESISTANCE_PU, nameplate) * base_ohm,
        rotor_resistance_ohm=_at(ROTOR_RESISTANCE_PU, nameplate) * base_ohm,
        stator_leakage_H=leakage_H,
        rotor_leakage_H=leakage_H,
        magnetising_inductance_H=_at(MAGNETISING_REACTANCE_PU, nameplate) * base_ohm / w_b,
        inertia_kgm2=INERTIA_CONSTANT_S * nameplate.base_inertia_kgm2,
    )
    factors = FACTORS
    told = _of_plate(nameplate, wound_rotor, parameters)
    if told is not None:
        plate_ohm, factor = told
        parameters = replace(parameters, rotor_resistance_ohm=plate_ohm)
        factors = FACTORS | {"rotor_resistance_ohm": factor}
    intervals = {
        name: (getattr(parameters, name) / factor, getattr(parameters, name) * factor)
        for name, factor in factors.items()
    }
    return TypicalParameters(parameters, intervals)


def _of_plate(
    nameplate: Nameplate, wound_rotor: WoundRotor | None, known: MachineParameters
) -> tuple[float, float] | None:
    """Return the rotor's resistance by the plate's speed [ohm], and the factor within which it is."""
    if wound_rotor is not None:
        wound_ohm = plate_resistance_ohm(nameplate, wound_rotor)
        return None if wound_ohm is None else (wound_ohm, PLATE_FACTOR)
    slip, slip_rpm = nameplate.rated_slip, nameplate.synchronous_rpm - (nameplate.rated_speed_rpm or 0.0)
    if slip is None:
        return None
    tolerance = SLIP_TOLERANCE if nameplate.rated_power_W >= 1e3 else SLIP_TOLERANCE_BELOW_1_KW
    return cage_resistance_ohm(nameplate, known, slip), 1.0 + tolerance + ROUNDING_RPM / slip_rpm


def cage_resistance_ohm(nameplate: Nameplate, machine: MachineParameters, slip: float) -> float:
    """Return the resistance at which a cage takes up rated power at a slip.

    Behind the stator, a source V_th with the impedance R_th + j X_th feeds R_r/s + j X_lr, which takes
    P / (1 - s). Of the two resistances that do, a motor runs at the greater one.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.
    machine : MachineParameters
        Its other parameters.
    slip : float
        Slip at rated power.

    Returns
    -------
    float
        R_r' at a small slip [ohm].
    """
    w = nameplate.rated_angular_frequency
    z = complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H)
    X_m = 1j * w * machine.magnetising_inductance_H
    behind = z * X_m / (z + X_m)
    volts = abs(X_m / (z + X_m)) * nameplate.winding_voltage_V
    R, X = behind.real, behind.imag + w * machine.rotor_leakage_H
    half = 1.5 * volts**2 * (1.0 - slip) / nameplate.rated_power_W - R
    return slip * (half + sqrt(max(half**2 - R**2 - X**2, 0.0)))


def plate_resistance_ohm(nameplate: Nameplate, wound_rotor: WoundRotor) -> float | None:
    """Return the resistance of a wound rotor that its plate tells, referred to the stator.

    Of the power that crosses the air gap, P / (1 - s), the share s is lost in the rotor: 3 R_2 I_2^2. The
    ratio of turns is that of the stator winding's voltage over the open rotor winding's.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.
    wound_rotor : WoundRotor
        Its rotor.

    Returns
    -------
    float or None
        R_r' [ohm]; None where the plate has no speed.
    """
    slip = nameplate.rated_slip
    if slip is None:
        return None
    own_ohm = slip / (1.0 - slip) * nameplate.rated_power_W / (3.0 * wound_rotor.rated_current_A**2)
    turns_ratio = sqrt(3.0) * nameplate.winding_voltage_V / wound_rotor.open_circuit_voltage_V
    return turns_ratio**2 * own_ohm


def atypical(motor: Motor) -> tuple[str, ...]:
    """Say which parameters of a motor lie beyond what is typical of its rating.

    They need not be wrong. But a factor of three in all impedances is star for delta, and one of a thousand
    is another unit.

    Parameters
    ----------
    motor : Motor
        The motor.

    Returns
    -------
    tuple of str
        Sentences; none of a motor with typical parameters.
    """
    found = typical_parameters(motor.nameplate, motor.wound_rotor)
    beyond = {}
    for name, (low, high) in found.intervals.items():
        value = getattr(motor.parameters, name)
        if not low <= value <= high:
            beyond[name] = value / getattr(found.parameters, name)
    told = [
        f"{name} is {factor:.2g} times what is typical of the rating ({_ends(found.intervals[name])})"
        for name, factor in beyond.items()
    ]
    impedances = [factor for name, factor in beyond.items() if name != "inertia_kgm2"]
    if len(impedances) >= ALL_ALIKE and max(impedances) < STAR_FOR_DELTA * min(impedances):
        told.append(
            "all impedances are off alike: check connection, whether they are a winding's, and the unit"
        )
    return tuple(told)


def tolerances_of(
    parameters: MachineParameters, source: ParametersSource, intervals: dict[str, tuple[float, float]]
) -> ParameterTolerances:
    """Return how far a motor's parameters may be off.

    Parameters
    ----------
    parameters : MachineParameters
        The parameters.
    source : ParametersSource
        Where they come from.
    intervals : dict of str to tuple of float
        95 % intervals of some or all of them.

    Returns
    -------
    ParameterTolerances
        Those of typical parameters, or of any others: what is usual, or the interval where it is wider.
    """
    if source is ParametersSource.TYPICAL:
        return TYPICAL_TOLERANCES
    usual = ParameterTolerances()
    wider = {}
    for name in ParameterTolerances.names():
        if name in intervals:
            low, high = intervals[name]
            value = getattr(parameters, name)
            wider[name] = max(getattr(usual, name), log(high / value), log(value / low))
    return ParameterTolerances(**wider)


def _ends(interval: tuple[float, float]) -> str:
    return f"{interval[0]:.3g} to {interval[1]:.3g}"


def _at(per_unit: tuple[float, ...], nameplate: Nameplate) -> float:
    """Return a value at a motor's power: its log lies on a line in the log of the power."""
    power_W = nameplate.rated_power_W
    place = bisect(POWERS_W, power_W, 1, len(POWERS_W) - 1)
    (low_W, high_W), (low, high) = POWERS_W[place - 1 : place + 1], per_unit[place - 1 : place + 1]
    share = log(min(max(power_W, low_W), high_W) / low_W) / log(high_W / low_W)
    return low * exp(share * log(high / low))
