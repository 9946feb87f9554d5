"""The conditions of motors over time, and their history."""

import time
from typing import Annotated

from fastapi import APIRouter, Query

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.conditions.documents import condition_document, until_stop_document
from service.api.conditions.schemas import ConditionChange, ConditionDetails, ConditionPoint
from service.api.context import Context
from service.api.document import Name
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.condition.staleness import stale_after_ns

LATEST_POINTS = 20
MOST_POINTS = 100

router = APIRouter(prefix="/motors/{name}", tags=["condition"])


@router.get("/condition", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_condition(
    context: Context,
    name: Name,
    history: Annotated[
        int, Query(ge=0, le=MOST_POINTS, description="With so many of the latest records.")
    ] = LATEST_POINTS,
) -> ConditionDetails:
    """Return the condition of a motor over time, with what was said from each of its latest records on."""
    now_ns = time.time_ns()
    health = context.repository.health(name)
    oldest_ns = stale_after_ns(health.motor.schedule, context.settings.stale_after_days)
    condition = condition_document(
        health.condition, now_ns, oldest_ns, health.diagnosis, source=health.motor.parameters_source
    )
    points = context.repository.latest_condition_points(name, limit=history)
    return ConditionDetails(
        **dict(condition),
        until_stop=until_stop_document(context.repository, health.condition, now_ns, oldest_ns),
        history=[ConditionPoint.model_validate(point) for point in points],
    )


@router.get("/condition/history", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_condition_history(
    context: Context, name: Name, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[ConditionChange]:
    """Return the changes of a motor's condition with what caused each, latest first."""
    changes = context.repository.condition_history(name, limit=limit, after=decode(cursor, int, str))
    return page(changes, ConditionChange.model_validate)
