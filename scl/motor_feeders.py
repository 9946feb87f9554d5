"""The motors of a substation section: relay and bus of each (IEC 61850-6 clause 9.2)."""

from collections.abc import Iterable

from scl.substation_model import MOTOR, Bay, Equipment, MotorFeeder, Substation


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
            bus=buses.get(motor.name),
        )
        for substation in substations
        for bay in substation.bays
        for buses in [buses_of(bay)]
        for motor in bay.equipment
        for ieds in [motor.ieds or bay.ieds]
        if motor.type == MOTOR and motor.name and ieds
    )


def buses_of(bay: Bay) -> dict[str, str]:
    """Find the bus of each motor of a bay.

    The bus is the nearest connectivity node of another bay. Where the motors of a bay reach none, it is the
    node of the bay at which the motor meets another one. Between a motor and its bus lie switches and what
    else of the bay has two terminals; the positions of switches are not looked at.

    Parameters
    ----------
    bay : Bay
        The bay.

    Returns
    -------
    dict of str to str
        Path name of the bus's node by the name of the motor; without motors whose bus the file does not tell,
        or that may be fed from several.
    """
    reached = {motor.name: _reached(motor, bay) for motor in bay.equipment if motor.type == MOTOR}
    buses = {}
    for motor, nodes in reached.items():
        distance = {node: steps for node, steps in nodes.items() if node not in bay.nodes}
        if not distance:
            others = [found for name, found in reached.items() if name != motor]
            distance = {
                node: max(steps, min(found[node] for found in others if node in found))
                for node, steps in nodes.items()
                if any(node in found for found in others)
            }
        nearest = [node for node, steps in distance.items() if steps == min(distance.values())]
        if len(nearest) == 1:
            buses[motor] = nearest[0]
    return buses


def _reached(motor: Equipment, bay: Bay) -> dict[str, int]:
    """Return the nodes that the motor reaches in its bay and just outside, and over how much equipment."""
    between = [one for one in bay.equipment if one.type != MOTOR]
    reached: dict[str, int] = {}
    frontier: Iterable[str] = motor.nodes
    steps = 0
    while frontier := [node for node in dict.fromkeys(frontier) if node not in reached]:
        reached |= dict.fromkeys(frontier, steps)
        inside = {node for node in frontier if node in bay.nodes}
        frontier = [node for one in between if inside.intersection(one.nodes) for node in one.nodes]
        steps += 1
    return reached
