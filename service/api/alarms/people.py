"""What people do about alarms: acknowledge, shelve, take out of service, and the ways back.

A step that is not possible in the alarm's state is answered with 409 and with what is possible.
"""

import time
from http import HTTPStatus
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Body, Query
from pydantic import StringConstraints

from core.units import NANOSECONDS_PER_DAY
from service.access.permissions import Permission
from service.api.access.callers import Asking, By
from service.api.access.requirements import require
from service.api.alarms.schemas import (
    AcknowledgementRequest,
    Acknowledgements,
    Alarm,
    Refusal,
    Remark,
    ShelvingRequest,
    UndoneAcknowledgements,
    UndoRequest,
)
from service.api.context import Context
from service.api.problems import FieldError, ProblemError, WrongFieldError, problems
from service.api.times import rfc3339
from service.storage.repository.sites import AtSite
from service.timing.undo_time import UNDO_NS

LONGEST_SHELVING_DAYS = 90
"""What is set aside for longer is forgotten: it is taken out of service, which the lists tell apart."""

router = APIRouter(tags=["alarms"])

Comment = Annotated[
    str | None,
    Query(description="Why; it is kept."),
    StringConstraints(min_length=1, max_length=500, strip_whitespace=True, pattern=r"^[^\x00]+$"),
]
Said = Annotated[Remark | None, Body()]


@router.post(
    "/alarms/acknowledgements",
    responses=problems(400, 409, 413),
    dependencies=[require(Permission.ACKNOWLEDGE)],
)
def acknowledge_alarms(context: Context, asking: Asking, wanted: AcknowledgementRequest) -> Acknowledgements:
    """Take notice of several alarms, of all for which that is possible; 409 where it is for none."""
    ids = list(dict.fromkeys(str(one) for one in wanted.alarms))
    asking.demand_here(context.repository, AtSite.ALARM, *ids)
    done = context.repository.acknowledge_alarms(
        ids, by=asking.actor, now_ns=time.time_ns(), comment=wanted.comment
    )
    if not done.alarms:
        errors = [
            FieldError(location=f"body.alarms.{ids.index(one)}", message=why)
            for one, why in list(done.refused.items())[:100]
        ]
        raise ProblemError(
            HTTPStatus.CONFLICT, f"nothing was acknowledged: {errors[0].message}", errors=errors
        )
    return Acknowledgements(
        acknowledged=[Alarm.model_validate(alarm) for alarm in done.alarms],
        refused=[Refusal(alarm=one, detail=why) for one, why in done.refused.items()],
    )


@router.post(
    "/alarms/acknowledgements/undo",
    responses=problems(400, 409, 413),
    dependencies=[require(Permission.ACKNOWLEDGE)],
)
def undo_acknowledgements(context: Context, asking: Asking, wanted: UndoRequest) -> UndoneAcknowledgements:
    """Have alarms call again that the same account has acknowledged in the last ten minutes.

    One whose cause went meanwhile is over, and stays so. 409 where it is possible for none.
    """
    ids = list(dict.fromkeys(str(one) for one in wanted.alarms))
    asking.demand_here(context.repository, AtSite.ALARM, *ids)
    now_ns = time.time_ns()
    done = context.repository.undo_acknowledgements(
        ids, by=asking.actor, since_ns=now_ns - UNDO_NS, now_ns=now_ns
    )
    if not done.alarms:
        raise ProblemError(HTTPStatus.CONFLICT, f"nothing was undone: {next(iter(done.refused.values()))}")
    return UndoneAcknowledgements(
        undone=[Alarm.model_validate(alarm) for alarm in done.alarms],
        refused=[Refusal(alarm=one, detail=why) for one, why in done.refused.items()],
    )


@router.post(
    "/alarms/{alarm_id}/acknowledgements",
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.ACKNOWLEDGE)],
)
def acknowledge_alarm(context: Context, by: By, alarm_id: UUID, said: Said = None) -> Alarm:
    """Take notice of an alarm. One whose cause is gone is over then."""
    alarm = context.repository.acknowledge_alarm(
        str(alarm_id), by=by, now_ns=time.time_ns(), comment=_comment(said)
    )
    return Alarm.model_validate(alarm)


@router.put(
    "/alarms/{alarm_id}/shelving",
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.ACKNOWLEDGE)],
)
def shelve_alarm(context: Context, by: By, alarm_id: UUID, wanted: ShelvingRequest) -> Alarm:
    """Set an alarm aside until a time, until its value has grown by so much, or what comes first.

    Of one that is shelved, this is the new end.
    """
    now_ns = time.time_ns()
    latest_ns = now_ns + LONGEST_SHELVING_DAYS * NANOSECONDS_PER_DAY
    if wanted.until is not None and not now_ns < wanted.until <= latest_ns:
        message = (
            f"expected a time from now to {LONGEST_SHELVING_DAYS} days ahead, found {rfc3339(wanted.until)};"
            " for longer, take the alarm out of service"
        )
        raise WrongFieldError("body.until", message)
    alarm = context.repository.shelve_alarm(
        str(alarm_id),
        by=by,
        now_ns=now_ns,
        until_ns=wanted.until,
        growth=wanted.growth,
        comment=wanted.comment,
    )
    return Alarm.model_validate(alarm)


@router.delete(
    "/alarms/{alarm_id}/shelving",
    responses=problems(404, 409),
    dependencies=[require(Permission.ACKNOWLEDGE)],
)
def unshelve_alarm(context: Context, by: By, alarm_id: UUID, comment: Comment = None) -> Alarm:
    """End the shelving of an alarm: it calls for somebody again if its cause stands, and is over if not."""
    alarm = context.repository.unshelve_alarm(str(alarm_id), by=by, now_ns=time.time_ns(), comment=comment)
    return Alarm.model_validate(alarm)


@router.put(
    "/alarms/{alarm_id}/out-of-service",
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.CONFIGURE)],
)
def take_alarm_out_of_service(context: Context, by: By, alarm_id: UUID, said: Said = None) -> Alarm:
    """Set an alarm aside until somebody puts it back, whatever its cause does meanwhile."""
    alarm = context.repository.take_alarm_out_of_service(
        str(alarm_id), by=by, now_ns=time.time_ns(), comment=_comment(said)
    )
    return Alarm.model_validate(alarm)


@router.delete(
    "/alarms/{alarm_id}/out-of-service",
    responses=problems(404, 409),
    dependencies=[require(Permission.CONFIGURE)],
)
def put_alarm_back_in_service(context: Context, by: By, alarm_id: UUID, comment: Comment = None) -> Alarm:
    """Put an alarm back in service: it calls for somebody if its cause stands, and is over if not."""
    alarm = context.repository.put_alarm_back_in_service(
        str(alarm_id), by=by, now_ns=time.time_ns(), comment=comment
    )
    return Alarm.model_validate(alarm)


def _comment(said: Remark | None) -> str | None:
    return None if said is None else said.comment
