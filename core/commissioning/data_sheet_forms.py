"""Forms in which data sheets give a motor's equivalent circuit."""

from dataclasses import dataclass
from enum import StrEnum


class Unit(StrEnum):
    """Unit of a data sheet's impedances."""

    OHM = "ohm"
    PER_UNIT = "pu"


class Values(StrEnum):
    """What a data sheet's impedances are those of."""

    STAR = "star"
    """A phase of the star that stands for the motor, however it is connected."""
    DELTA = "delta"
    """A winding of the delta that stands for the motor."""
    WINDING = "winding"
    """A winding of the motor as it is connected."""


@dataclass(frozen=True, slots=True)
class Impedances:
    """Equivalent circuit of a data sheet, reactances at rated frequency, in its own unit.

    Parameters
    ----------
    r1, r2 : float
        Resistances of the stator, and of the rotor referred to it.
    x1, x2 : float
        Leakage reactances of the stator, and of the rotor referred to it.
    xm : float
        Magnetising reactance.
    """

    r1: float
    r2: float
    x1: float
    x2: float
    xm: float


@dataclass(frozen=True, slots=True)
class Reading:
    """How a data sheet is to be read.

    Parameters
    ----------
    unit : Unit, default Unit.OHM
        Unit of its impedances.
    values : Values or None, optional
        What they are those of; only a motor in star needs not be told.
    base_VA : float or None, optional
        Apparent power that per unit is of [VA].
    temperature_C : float or None, optional
        Temperature of the resistances, where they are cold ones [C].
    """

    unit: Unit = Unit.OHM
    values: Values | None = None
    base_VA: float | None = None
    temperature_C: float | None = None
