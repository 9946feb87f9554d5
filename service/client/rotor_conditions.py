"""The condition of a motor's rotor, as the API answers it, as text for people."""

from rich.text import Text

from core.rotor.finding import RotorState
from service.client.conditions import STATE_COLOURS
from service.client.rest_client import Document, ServiceClient
from service.client.rotor_and_supply import STATES
from service.client.verdicts import local_time

LOAD_OSCILLATION = "load oscillation"
"""So begins the reason that tells of a load that swings at twice the slip."""


def rotor_of(service: ServiceClient, motor: str) -> Document:
    """Return the condition of a motor's rotor. Raises ServiceError."""
    return service.get_rotor(motor)


def rotor_text(rotor: Document) -> Text:
    """Return state and severity in the state's colour: "fault, -29.0 dB"; and whether the load swings."""
    words = STATES[RotorState(str(rotor["state"]))]
    severity_dB = rotor["severity_dB"]
    if isinstance(severity_dB, int | float):
        words += f", {severity_dB:.1f} dB"
    if any(reason.startswith(LOAD_OSCILLATION) for reason in _reasons(rotor)):
        words += f", {LOAD_OSCILLATION}"
    return Text(words, style=STATE_COLOURS.get(str(rotor["state"]), ""))


def rotor_lines(rotor: Document) -> list[tuple[str, Text]]:
    """Return what is said of the rotor as lines of a name and a text."""
    lines = [("rotor", rotor_text(rotor))]
    is_ill = rotor["state"] in (RotorState.WATCH, RotorState.FAULT)
    if is_ill:
        lines.append(("what to do", Text(str(rotor["advice"]))))
        lines.append(("since", Text(str(local_time(rotor["since"])))))
    lines += [("why" if number == 0 else "", Text(one)) for number, one in enumerate(_reasons(rotor))]
    start = rotor.get("start")
    if isinstance(start, dict):
        lines.append(("latest start", Text(f"{local_time(start['time'])}: {start['words']}")))
    return lines


def _reasons(rotor: Document) -> list[str]:
    found = rotor["reasons"]
    return [str(one) for one in found] if isinstance(found, list) else []
