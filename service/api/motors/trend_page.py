"""A page of a trend, written without a model for each of its thousand points."""

from collections.abc import Iterable, Mapping
from functools import partial
from typing import Literal

from fastapi import Response
from pydantic_core import to_json

from service.api.pages import encode
from service.api.times import rfc3339_of_all
from service.storage.records import ConditionPoint, Cursor, Page, TrendPoint

ConditionQuantity = Literal["condition_level", "change"]


def trend_of_recordings(stored: Page[TrendPoint]) -> Response:
    """Return a page of a figure of each recording."""
    times = rfc3339_of_all([point.recorded_ns for point in stored.items])
    return _document(map(_of_recording, stored.items, times), stored.next)


def trend_of_conditions(stored: Page[ConditionPoint], quantity: ConditionQuantity) -> Response:
    """Return a page of a figure of the motor's condition, from each recording on."""
    to_point = partial(_of_condition, quantity=quantity)
    times = rfc3339_of_all([point.time_ns for point in stored.items])
    return _document(map(to_point, stored.items, times), stored.next)


def _document(points: Iterable[Mapping[str, object]], after: Cursor | None) -> Response:
    """Return the document of `Page[TrendPoint]`: models would take longer than the query and the text."""
    document = {
        "items": list(points),
        "next_cursor": None if after is None else encode(after),
    }
    return Response(to_json(document, inf_nan_mode="null"), media_type="application/json")


def _of_recording(point: TrendPoint, time: str) -> Mapping[str, object]:
    return {
        "time": time,
        "value": point.value,
        "ci95": point.ci95,
        "scatter95": point.scatter95,
        "detection_limit": point.detection_limit,
        "verdict": point.verdict,
        "recording_id": point.recording_id,
    }


def _of_condition(point: ConditionPoint, time: str, quantity: ConditionQuantity) -> Mapping[str, object]:
    is_change = quantity == "change"
    return {
        "time": time,
        "value": point.change if is_change else point.mu_f,
        "ci95": point.change_ci95 if is_change else point.mu_f_ci95,
        "scatter95": None,
        "detection_limit": None,
        "verdict": None,
        "recording_id": point.recording_id,
        "state": point.state,
        "kind": point.kind,
        "phase": point.phase,
    }
