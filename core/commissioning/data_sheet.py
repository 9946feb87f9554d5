"""Impedances of a data sheet, in the forms that exist, as parameters of a motor's windings.

Data sheets give the equivalent circuit in ohm or per unit, for a phase of the star that stands for the motor
or for a winding of its delta, and resistances between two terminals. The motor file has windings.
"""

from dataclasses import fields
from math import inf

from core.commissioning.data_sheet_forms import Impedances, Reading, Unit, Values
from core.commissioning.errors import CommissioningError
from core.machines.parameters import Connection, MachineParameters, Nameplate
from core.machines.plausibility import (
    INERTIA_CONSTANT_S,
    LEAKAGE_REACTANCE_PU,
    MAGNETISING_REACTANCE_PU,
    RESISTANCE_PU,
)
from core.machines.typical import typical_parameters
from core.quantity_text import plain

DATA_SHEET = "data sheet"
WORKING_C = 75.0
"""Temperature of windings at work to which cold resistances are brought, as IEEE Std 112 has it [C]."""
COPPER_C, ALUMINIUM_C = 235.0, 225.0
"""Temperatures below zero at which the resistance would vanish (IEC 60034-1, 8.6.2.3) [C]."""
RESISTANCE_TOLERANCE, REACTANCE_TOLERANCE = 0.15, 0.20
"""Of designed values against one motor: IEC 60034-1 allows the locked-rotor current 20 %."""
INERTIA_TOLERANCE = 0.2
BASE_OVER_POWER = (0.5, 10.0)
"""Apparent power that per unit may be of, over the rated power."""
RANGES_PU = {
    "r1": RESISTANCE_PU,
    "r2": RESISTANCE_PU,
    "x1": LEAKAGE_REACTANCE_PU,
    "x2": LEAKAGE_REACTANCE_PU,
    "xm": MAGNETISING_REACTANCE_PU,
}
"""What motors have of each impedance, per unit of a winding's V^2 / P."""
OPTIONS = {
    "r1": "--r1, or by --terminal-resistance",
    **{name: f"--{name}" for name in ("r2", "x1", "x2", "xm")},
}


def winding_parameters(
    impedances: Impedances, nameplate: Nameplate, reading: Reading, *, inertia_kgm2: float | None = None
) -> MachineParameters:
    """Return the parameters of the windings.

    Parameters
    ----------
    impedances : Impedances
        What the data sheet says.
    nameplate : Nameplate
        Rated values of the motor.
    reading : Reading
        How it is to be read.
    inertia_kgm2 : float or None, optional
        Inertia of motor and load; typical of the rating if None [kg m^2].

    Returns
    -------
    MachineParameters
        The parameters.

    Raises
    ------
    CommissioningError
        If a figure is impossible, or something is missing without which the others mean nothing.
    """
    _check_impedances(impedances, nameplate, reading)
    factor, w = ohm_per_unit(nameplate, reading), nameplate.rated_angular_frequency
    typical = typical_parameters(nameplate).parameters
    return MachineParameters.from_magnetising_inductance(
        stator_resistance_ohm=impedances.r1 * factor * warmed(COPPER_C, reading.temperature_C),
        rotor_resistance_ohm=impedances.r2 * factor * warmed(ALUMINIUM_C, reading.temperature_C),
        stator_leakage_H=impedances.x1 * factor / w,
        rotor_leakage_H=impedances.x2 * factor / w,
        magnetising_inductance_H=impedances.xm * factor / w,
        inertia_kgm2=typical.inertia_kgm2 if inertia_kgm2 is None else inertia_kgm2,
    )


def _check_impedances(impedances: Impedances, nameplate: Nameplate, reading: Reading) -> None:
    """Raise CommissioningError for impedances that no motor of the rating has."""
    ohm = ohm_per_unit(nameplate, reading)
    factor = ohm / nameplate.base_impedance_ohm
    for field in fields(impedances):
        value, (least, most) = getattr(impedances, field.name), RANGES_PU[field.name]
        name = OPTIONS[field.name]
        positive(name, value)
        warm = warmed(COPPER_C if field.name == "r1" else ALUMINIUM_C, reading.temperature_C)
        found = value * factor * (warm if field.name.startswith("r") else 1.0)
        if not least <= found <= most:
            in_milliohm = reading.unit is Unit.OHM and least <= found / 1e3 <= most
            ends = " to ".join(plain(end * value / found, 4) for end in (least, most))
            raise CommissioningError(
                DATA_SHEET,
                name,
                expected=f"{ends} {reading.unit}, for this nameplate",
                found=plain(value, 6)
                + (f": is it in milliohm? then {plain(value / 1e3, 4)}" if in_milliohm else ""),
            )


def check_inertia(inertia_kgm2: float, nameplate: Nameplate) -> None:
    """Check that an inertia is one that a motor of the rating may turn.

    Parameters
    ----------
    inertia_kgm2 : float
        Inertia of motor and load [kg m^2].
    nameplate : Nameplate
        Rated values of the motor.

    Raises
    ------
    CommissioningError
        If it is not.
    """
    positive("inertia", inertia_kgm2)
    least, most = (one * nameplate.base_inertia_kgm2 for one in INERTIA_CONSTANT_S)
    if not least <= inertia_kgm2 <= most:
        raise CommissioningError(
            DATA_SHEET,
            "inertia",
            expected=f"{plain(least)} to {plain(most)} kg m^2, for this nameplate",
            found=plain(inertia_kgm2, 6),
        )


def winding_resistance_ohm(between_terminals_ohm: float, connection: Connection) -> float:
    """Return the resistance of a winding from that between two terminals.

    Parameters
    ----------
    between_terminals_ohm : float
        Resistance between two line terminals [ohm].
    connection : Connection
        Of the windings.

    Returns
    -------
    float
        Half of it in star, where two windings are in series; in delta three halves of it, where one is in
        parallel with two [ohm].
    """
    return between_terminals_ohm * (1.5 if connection is Connection.DELTA else 0.5)


def intervals_of_data_sheet(
    machine: MachineParameters, *, inertia_is_known: bool, nameplate: Nameplate
) -> dict[str, tuple[float, float]]:
    """Return how far one motor may be from its data sheet's impedances.

    Parameters
    ----------
    machine : MachineParameters
        The parameters.
    inertia_is_known : bool
        Whether the inertia is the data sheet's, not a typical one.
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    dict of str to tuple of float
        Lower and upper end by parameter.
    """
    found = {}
    for field in fields(machine):
        value = getattr(machine, field.name)
        tolerance = RESISTANCE_TOLERANCE if field.name.endswith("_ohm") else REACTANCE_TOLERANCE
        found[field.name] = (value * (1.0 - tolerance), value * (1.0 + tolerance))
    if not inertia_is_known:
        found["inertia_kgm2"] = typical_parameters(nameplate).intervals["inertia_kgm2"]
    return found


def ohm_per_unit(nameplate: Nameplate, reading: Reading) -> float:
    """Return the factor from a data sheet's unit to ohm of a winding.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.
    reading : Reading
        How the data sheet is to be read.

    Returns
    -------
    float
        The factor.

    Raises
    ------
    CommissioningError
        If the base of per unit, or what the values of a motor in delta are those of, is missing.
    """
    delta = nameplate.connection is Connection.DELTA
    if reading.unit is Unit.PER_UNIT:
        if reading.base_VA is None:
            raise CommissioningError(
                DATA_SHEET,
                "base of per unit",
                expected="the apparent power that per unit is of (--base-VA), or the rated current "
                "(--rated-current) for sqrt(3) V I",
                found="neither",
            )
        positive("base of per unit (--base-VA)", reading.base_VA)
        least, most = (share * nameplate.rated_power_W for share in BASE_OVER_POWER)
        if not least <= reading.base_VA <= most:
            in_kVA = least <= 1e3 * reading.base_VA <= most
            raise CommissioningError(
                DATA_SHEET,
                "base of per unit (--base-VA)",
                expected=f"{plain(least)} to {plain(most)} VA, for this nameplate",
                found=plain(reading.base_VA, 6)
                + (f": is it in kVA? then {plain(1e3 * reading.base_VA)}" if in_kVA else ""),
            )
        return nameplate.rated_voltage_V**2 / reading.base_VA * (3.0 if delta else 1.0)
    if reading.values is None and delta:
        raise CommissioningError(
            DATA_SHEET,
            "values",
            expected="what the ohms of this motor in delta are those of: --values star (a phase of the "
            "equivalent star, the usual form) or --values winding (a winding, three times as much)",
            found="nothing",
        )
    if reading.values is Values.STAR:
        return 3.0 if delta else 1.0
    if reading.values is Values.DELTA:
        return 1.0 if delta else 1.0 / 3.0
    return 1.0


def warmed(vanishes_C: float, temperature_C: float | None) -> float:
    """Return the factor from a cold resistance to one at work.

    Parameters
    ----------
    vanishes_C : float
        Temperature below zero at which it would vanish [C].
    temperature_C : float or None
        Temperature at which it was measured; None where it is one at work [C].

    Returns
    -------
    float
        The factor.

    Raises
    ------
    CommissioningError
        If no winding is so cold or so hot.
    """
    if temperature_C is None:
        return 1.0
    if not -50.0 <= temperature_C <= 200.0:
        raise CommissioningError(
            DATA_SHEET, "temperature", expected="-50 to 200 degrees C", found=f"{temperature_C:g}"
        )
    return (vanishes_C + WORKING_C) / (vanishes_C + temperature_C)


def positive(name: str, value: float) -> None:
    """Check that a figure is a number above zero.

    Parameters
    ----------
    name : str
        Its name.
    value : float
        The figure.

    Raises
    ------
    CommissioningError
        If it is not.
    """
    if not 0.0 < value < inf:
        raise CommissioningError(DATA_SHEET, name, expected="a number above zero", found=f"{value:g}")
