"""A page of a trend, written without a model for each of its thousand points."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from fastapi import Response
from pydantic_core import to_json

from core.quantities import BY_NAME, Subject
from service.api.pages import encode
from service.api.times import rfc3339_of_all
from service.storage.records import Page
from service.storage.records.history import TrendPoint

_BESIDE: Final[Mapping[Subject, Sequence[str]]] = {
    Subject.STATOR: (),
    Subject.CONDITION: ("state", "kind", "phase"),
    Subject.ROTOR: ("state", "reasons"),
    Subject.PARAMETERS: (),
}
"""What is said beside figures of a subject, besides the verdict of the recording; its reasons otherwise."""


def trend_page(stored: Page[TrendPoint], quantity: str) -> Response:
    """Return the document of `Page[TrendPoint]`: models would take longer than the query and the text."""
    times = rfc3339_of_all([point.time_ns for point in stored.items])
    points: Iterable[Mapping[str, object]] = map(_point, stored.items, times)
    beside = _BESIDE.get(BY_NAME[quantity].subject, ("reasons",))
    if beside:
        points = (
            {**document, **{name: getattr(point, name) for name in beside}}
            for document, point in zip(points, stored.items, strict=True)
        )
    document = {
        "items": list(points),
        "next_cursor": None if stored.next is None else encode(stored.next),
    }
    return Response(to_json(document, inf_nan_mode="null"), media_type="application/json")


def _point(point: TrendPoint, time: str) -> Mapping[str, object]:
    return {
        "time": time,
        "value": point.value,
        "ci95": point.ci95,
        "scatter95": point.scatter95,
        "detection_limit": point.detection_limit,
        "verdict": point.verdict,
        "recording_id": point.recording_id,
    }
