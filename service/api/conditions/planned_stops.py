"""When motors and sites stop next, as people plan it."""

import time
from http import HTTPStatus

from fastapi import APIRouter

from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.conditions.schemas import PlannedStop, StopRequest
from service.api.context import ApiContext, Context
from service.api.document import Name
from service.api.problems import WrongFieldError, problems
from service.api.times import rfc3339
from service.storage.records import Actor, StopOf
from service.storage.records import PlannedStop as StoredStop

router = APIRouter(tags=["condition"])


@router.get("/motors/{name}/planned-stop", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_planned_stop(context: Context, name: Name) -> PlannedStop:
    """Return when a motor stops next: by its own plan, or by that of its site where it is earlier."""
    return _document(context.repository.planned_stop(name, now_ns=time.time_ns()))


@router.put(
    "/motors/{name}/planned-stop",
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.NOTE)],
)
def plan_stop(context: Context, name: Name, wanted: StopRequest, caller: By) -> PlannedStop:
    """Plan when a motor stops next, in place of an earlier plan; its condition answers for that time."""
    keep_stop(context, StopOf.MOTOR, name, wanted.time, caller)
    return _document(StoredStop(wanted.time, StopOf.MOTOR))


@router.delete(
    "/motors/{name}/planned-stop",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404, 409),
    dependencies=[require(Permission.NOTE)],
)
def cancel_stop(context: Context, name: Name, caller: By) -> None:
    """Drop the plan of a motor's stop; that of its site stays."""
    keep_stop(context, StopOf.MOTOR, name, None, caller)


@router.get("/sites/{name}/planned-stop", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_planned_stop_of_site(context: Context, name: Name) -> PlannedStop:
    """Return when all motors of a site stop next."""
    return _document(context.repository.planned_stop_of_site(name, now_ns=time.time_ns()))


@router.put(
    "/sites/{name}/planned-stop",
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.NOTE)],
)
def plan_stop_of_site(context: Context, name: Name, wanted: StopRequest, caller: By) -> PlannedStop:
    """Plan when all motors of a site stop next, in place of an earlier plan."""
    keep_stop(context, StopOf.SITE, name, wanted.time, caller)
    return _document(StoredStop(wanted.time, StopOf.SITE))


@router.delete(
    "/sites/{name}/planned-stop",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404, 409),
    dependencies=[require(Permission.NOTE)],
)
def cancel_stop_of_site(context: Context, name: Name, caller: By) -> None:
    """Drop the plan of a site's stop; those of its motors stay."""
    keep_stop(context, StopOf.SITE, name, None, caller)


def keep_stop(context: ApiContext, of: StopOf, name: str, time_ns: int | None, by: Actor) -> None:
    """Keep when something stops next; None: it has no plan any more.

    Raises NotFoundError, OutOfServiceError, ProblemError.
    """
    now_ns = time.time_ns()
    if time_ns is not None and time_ns <= now_ns:
        raise WrongFieldError("body.time", f"expected a time ahead, found {rfc3339(time_ns)}")
    context.repository.plan_stop(of, name, time_ns, by=by, now_ns=now_ns)


def _document(stop: StoredStop | None) -> PlannedStop:
    return PlannedStop(time=None, of=None) if stop is None else PlannedStop.model_validate(stop)
