"""The trend of a motor as a picture for mails."""

import structlog

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
    forecast = document.get("forecast")
    limit = forecast.get("limit") if isinstance(forecast, dict) else None
    svg = trend_picture(motor, points, limit=limit if isinstance(limit, float) else None, zone=time_zone)
    try:
        return png(svg)
    except PictureError as error:
        log.warning("a message goes without its picture", motor=motor, error=str(error))
        return None
