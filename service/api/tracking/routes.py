"""The parameters of a motor, followed while it runs."""

from fastapi import APIRouter

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.times import From, To
from service.api.tracking.schemas import TrackedMotor, TrackedTrendPoint, tracked_motor, tracked_trend_point

router = APIRouter(prefix="/motors/{name}", tags=["condition"])


@router.get("/parameters", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_tracked_parameters(context: Context, name: Name) -> TrackedMotor:
    """Return resistances and inductances of a motor as its recordings tell them, and what has drifted."""
    return tracked_motor(name, context.repository.tracked_parameters(name))


@router.get("/parameters/trend", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_tracked_trend(
    context: Context,
    name: Name,
    from_: From = None,
    to: To = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[TrackedTrendPoint]:
    """Return the changes of a motor's parameters after each recording, oldest first."""
    after = decode(cursor, int, str)
    found = context.repository.tracked_trend(name, from_ns=from_, to_ns=to, limit=limit, after=after)
    return page(found, tracked_trend_point)
