"""The trend of a motor as a picture for mails: what the chart of its page shows."""

from collections.abc import Mapping

import structlog

from service.condition.motor_data import motor_known
from service.condition.trend_marks import trend_marks
from service.pictures.png import PictureError, png
from service.pictures.trend import TrendPoint, trend_picture
from service.storage import NotFoundError, Repository

log = structlog.get_logger(__name__)

MOST_POINTS = 5000
"""The latest records that a picture shows."""


def trend_of(repository: Repository, motor: str, time_zone: str) -> bytes | None:
    """Return the picture as PNG; None where there is nothing to show, or it cannot be made.

    A message without its picture is better than none. Raises sqlalchemy.exc.SQLAlchemyError.
    """
    svg = trend_drawing(repository, motor, time_zone)
    if svg is None:
        return None
    try:
        return png(svg)
    except PictureError as error:
        log.warning("a message goes without its picture", motor=motor, error=str(error))
        return None


def trend_drawing(repository: Repository, motor: str, time_zone: str) -> str | None:
    """Return the picture as SVG; None where there is nothing to show."""
    try:
        seen = repository.latest_condition_points(motor, limit=MOST_POINTS)
        document = repository.condition(motor).document or {}
    except NotFoundError:
        return None
    points = [
        TrendPoint(point.time_ns, point.mu_f, point.mu_f_ci95_low, point.mu_f_ci95_high, point.state.value)
        for point in seen
        if point.mu_f is not None
    ]
    if not points:
        return None
    versions = repository.motor_versions(motor)
    return trend_picture(
        motor,
        points,
        limit=motor_known(motor, versions[-1].document).limits.fault_level if versions else None,
        ahead=_level(document, "forecast", "limit"),
        detectable=_level(document, "reference", "detectable"),
        marks=trend_marks(repository, motor, points[0].time_ns, points[-1].time_ns + 1),
        zone=time_zone,
    )


def _level(document: Mapping[str, object], part: str, name: str) -> float | None:
    """Return a figure of a condition's document; None where it has none."""
    found = document.get(part)
    level = found.get(name) if isinstance(found, Mapping) else None
    return level if isinstance(level, float) else None
