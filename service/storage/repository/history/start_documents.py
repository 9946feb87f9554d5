"""Starts as they are stored: figures in columns; curve, model and the relay's report as documents."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from core.rotor.finding import RotorState
from core.rotor.start_finding import StartSideband
from core.starts.examined import ExaminedStart, StartParameters, StartStress, StartTorque
from core.starts.figures import MotorStart, StartCurve
from service.storage.models import StartRow
from service.storage.records import ReportedStart, StartEntry
from service.storage.states import StartSource

FIGURES = (
    "is_from_rest",
    "acceleration_s",
    "peak_current_A",
    "crest_current_A",
    "running_current_A",
    "lowest_voltage_V",
    "i2t_A2s",
    "i2t_over_s",
    "rated_current_A",
    "rated_voltage_V",
)
"""Columns that are called as the fields of a MotorStart are."""


def start_row(recording_id: str, motor: str, time_ns: int, start: ExaminedStart) -> StartRow:
    """Return the row of a recorded start."""
    model = start.model_as_dict()
    return StartRow(
        recording_id=recording_id,
        motor=motor,
        time_ns=time_ns,
        curve=asdict(start.figures.curve),
        model=model if _is_storable(model) else None,
        source=StartSource.RECORDING,
        **{name: getattr(start.figures, name) for name in FIGURES},
    )


def start_entry(row: StartRow, *_: object) -> StartEntry:
    """Return a start as the repository hands it out."""
    figures: dict[str, Any] = {name: getattr(row, name) for name in FIGURES}
    examined = examined_start(start_figures(figures, row.curve), row.model)
    # The row of a report that has no recording says the same.
    told = row.report if row.source is StartSource.RECORDING else None
    reported = None if told is None else reported_start(told).examined
    return StartEntry(row.recording_id, row.motor, row.time_ns, examined, row.source, reported)


def report_document(start: ReportedStart) -> Mapping[str, Any]:
    """Return what a relay reports of a start as the database gives it back."""
    figures = asdict(start.examined.figures)
    document = {"time_ns": start.time_ns, "figures": figures, "model": start.examined.model_as_dict()}
    stored: Mapping[str, Any] = json.loads(json.dumps(document, allow_nan=False))
    return stored


def reported_start(document: Mapping[str, Any]) -> ReportedStart:
    """Return what a relay reports of a start."""
    figures = dict(document["figures"])
    start = start_figures(figures, figures.pop("curve"))
    return ReportedStart(document["time_ns"], examined_start(start, document["model"]))


def start_figures(figures: Mapping[str, Any], curve: Mapping[str, Any]) -> MotorStart:
    """Return the figures of a start with its curve."""
    return MotorStart(**figures, curve=StartCurve(**_with_tuples(curve)))


def examined_start(figures: MotorStart, document: Mapping[str, Any] | None) -> ExaminedStart:
    """Return a start with what its model tells; without that document, with its figures alone."""
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


def _is_storable(model: Mapping[str, object]) -> bool:
    """Return whether a document has nothing but numbers in it that JSON has, too."""
    try:
        json.dumps(model, allow_nan=False)
    except ValueError:
        return False
    return True
