"""The substation section (IEC 61850-6 clause 9.2): sites, bays and motors, and the relay of each motor."""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Equipment:
    """Primary equipment of a bay.

    Parameters
    ----------
    name : str
        Name of the equipment.
    type : str
        Type; "MOT" is a motor.
    description : str
        Description for people.
    ieds : tuple of str
        IEDs whose logical nodes are attached to the equipment.
    """

    name: str
    type: str
    description: str
    ieds: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Bay:
    """A bay of a substation.

    Parameters
    ----------
    name : str
        Name of the bay.
    description : str
        Description for people.
    voltage_level : str
        Name of its voltage level.
    equipment : tuple of Equipment
        Its conducting equipment.
    ieds : tuple of str
        IEDs attached to the bay itself.
    """

    name: str
    description: str
    voltage_level: str
    equipment: tuple[Equipment, ...]
    ieds: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Substation:
    """A substation, which stands for a site.

    Parameters
    ----------
    name : str
        Name of the substation.
    description : str
        Description for people.
    bays : tuple of Bay
        Bays of all its voltage levels.
    """

    name: str
    description: str
    bays: tuple[Bay, ...]


@dataclass(frozen=True, slots=True)
class MotorFeeder:
    """A motor, the relay that protects it, and the site and bay they stand in.

    Parameters
    ----------
    site : str
        Name of the substation.
    site_description : str
        Its description.
    bay : str
        Name of the bay.
    motor : str
        Name of the motor.
    motor_description : str
        Its description.
    ied : str
        Name of the relay's IED.
    """

    site: str
    site_description: str
    bay: str
    motor: str
    motor_description: str
    ied: str


def motor_feeders(substations: Iterable[Substation]) -> tuple[MotorFeeder, ...]:
    """List every motor with the IED attached to it or else to its bay.

    A motor is a ConductingEquipment of type MOT.

    Parameters
    ----------
    substations : iterable of Substation
        The substations.

    Returns
    -------
    tuple of MotorFeeder
        The motors in file order.
    """
    return tuple(
        MotorFeeder(
            site=substation.name,
            site_description=substation.description,
            bay=bay.name,
            motor=motor.name,
            motor_description=motor.description,
            ied=ieds[0],
        )
        for substation in substations
        for bay in substation.bays
        for motor in bay.equipment
        for ieds in [motor.ieds or bay.ieds]
        if motor.type == "MOT" and motor.name and ieds
    )
