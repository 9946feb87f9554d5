"""Doubts about a data sheet's circuit: what it does and is, against what motors of the rating do and are."""

from collections.abc import Iterable, Mapping

from core.commissioning.catalogue import Compared
from core.commissioning.catalogue_data import FIGURES
from core.machines.parameters import MachineParameters, Nameplate
from core.machines.typical import typical_parameters
from core.quantity_text import plain

USUAL = {
    "locked_rotor_current": (3.0, 12.0),
    "locked_rotor_torque": (0.15, 5.0),
    "breakdown_torque": (1.5, 6.5),
}
"""What cage motors have, over rated current and torque; without saturation a circuit has more torque."""

AT_STANDSTILL = ("locked_rotor_current", "breakdown_torque", "locked_rotor_torque")
"""Figures that tell the leakage, and with it all of USUAL."""

SHOWN_BY = {
    "stator_resistance_ohm": ("stator_resistance_ohm", "efficiency"),
    "rotor_resistance_ohm": ("rated_speed_rpm", "locked_rotor_torque"),
    "stator_leakage_H": ("locked_rotor_current", "breakdown_torque"),
    "stator_self_inductance_H": ("power_factor", "rated_current_A"),
}
"""Figures of a catalogue that tell a parameter; the leakage of the rotor goes with that of the stator."""

WORDS = {
    "stator_resistance_ohm": "stator resistance",
    "rotor_resistance_ohm": "rotor resistance",
    "stator_leakage_H": "leakage reactances",
    "stator_self_inductance_H": "magnetising reactance",
}


def circuit_doubts(
    machine: MachineParameters, compared: Iterable[Compared], nameplate: Nameplate
) -> tuple[str, ...]:
    """Say what of a circuit from a catalogue is not as motors of the rating have it.

    Parameters
    ----------
    machine : MachineParameters
        Parameters of a winding.
    compared : iterable of Compared
        The figures of the catalogue beside those of the circuit.
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    tuple of str
        Sentences, each with the figures of the catalogue to check.
    """
    by_name = {one.name: one for one in compared}
    typical = typical_parameters(nameplate)
    doubts = []
    for name, (least, most) in USUAL.items():
        found = by_name[name].computed
        if not least <= found <= most:
            doubts.append(
                f"{FIGURES[name]}: the circuit has {plain(found)} times the rated one, motors have "
                f"{plain(least)} to {plain(most)} times: check {_given(by_name, (name, *AT_STANDSTILL))}"
            )
    for parameter, figures in SHOWN_BY.items():
        value, (low, high) = getattr(machine, parameter), typical.intervals[parameter]
        if not low <= value <= high:
            usual = plain(value / getattr(typical.parameters, parameter), 2)
            doubts.append(
                f"{WORDS[parameter]} of the circuit: {usual} times what is typical of the rating: check "
                f"{_given(by_name, figures)} and the nameplate"
            )
    return tuple(doubts)


def _given(compared: Mapping[str, Compared], names: Iterable[str]) -> str:
    """Return those of the figures that are given, with what they are; all that are given if none is."""
    found = [name for name in dict.fromkeys(names) if compared[name].given is not None]
    found = found or [name for name, one in compared.items() if one.given is not None]
    return ", ".join(f"{FIGURES[name]} ({_shown(compared[name])})" for name in found)


def _shown(one: Compared) -> str:
    value = 0.0 if one.given is None else one.given
    return f"{plain(100.0 * value, 4)} %" if one.name == "efficiency" else plain(value, 4)
