"""The substation section (IEC 61850-6 clause 9.2): sites, bays and motors, and the relay of each motor."""

from dataclasses import dataclass

MOTOR = "MOT"
"""Type of a motor among the conducting equipment."""


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
    nodes : tuple of str
        Path names of the connectivity nodes at its terminals.
    """

    name: str
    type: str
    description: str
    ieds: tuple[str, ...]
    nodes: tuple[str, ...]


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
    nodes : tuple of str
        Path names of its connectivity nodes.
    """

    name: str
    description: str
    voltage_level: str
    equipment: tuple[Equipment, ...]
    ieds: tuple[str, ...]
    nodes: tuple[str, ...]


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
    bus : str or None
        Path name of the bus's connectivity node; None where the file does not tell it.
    """

    site: str
    site_description: str
    bay: str
    motor: str
    motor_description: str
    ied: str
    bus: str | None
