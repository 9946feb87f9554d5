"""What a model tells of a start, read back from the document that is stored."""

from collections.abc import Mapping
from typing import Any

from core.rotor.finding import RotorState
from core.rotor.start_finding import StartSideband
from core.starts.examined import ExaminedStart, StartParameters, StartStress, StartTorque
from core.starts.figures import MotorStart


def examined_start(figures: MotorStart, document: Mapping[str, Any] | None) -> ExaminedStart:
    """Return a start with what its model tells; starts of earlier versions have figures alone."""
    if document is None:
        return ExaminedStart(figures)
    torque, parameters, sideband, stress = (
        document[part] for part in ("torque", "parameters", "sideband", "stress")
    )
    return ExaminedStart(
        figures,
        None if torque is None else StartTorque(**_with_tuples(torque)),
        None if parameters is None else _parameters(parameters),
        None if sideband is None else StartSideband(**_with_tuples(sideband) | _state(sideband)),
        None if stress is None else StartStress(**stress),
        document["remark"],
    )


def start_parameters(document: Mapping[str, Any]) -> StartParameters | None:
    """Return what a start tells of the motor's parameters; None where it tells nothing."""
    parameters = document["parameters"]
    return None if parameters is None else _parameters(parameters)


def _parameters(document: Mapping[str, Any]) -> StartParameters:
    ends = {name: tuple(interval) for name, interval in document["ci95"].items()}
    return StartParameters(**_with_tuples(document) | {"ci95": ends})


def _state(document: Mapping[str, Any]) -> dict[str, RotorState]:
    return {"state": RotorState(document["state"])}


def _with_tuples(document: Mapping[str, Any]) -> dict[str, Any]:
    return {name: tuple(value) if isinstance(value, list) else value for name, value in document.items()}
