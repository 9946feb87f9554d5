"""Lists of alarms, one alarm with its history, and key figures."""

import time
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Query
from fastapi.responses import StreamingResponse

from core.units import NANOSECONDS_PER_DAY
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.alarms.schemas import Alarm, AlarmChange, AlarmFigures
from service.api.context import Context
from service.api.exports.answers import FILES, ListAnswer
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.exports import alarms as table
from service.storage.states import AlarmState

router = APIRouter(tags=["alarms"])

MOST_DAYS = 366

OfRelay = Annotated[
    str | None, Query(max_length=200, description="Only alarms of this relay and its motors.")
]
OfMotor = Annotated[str | None, Query(max_length=200, description="Only alarms of this motor.")]


@router.get(
    "/alarms",
    response_model=Page[Alarm],
    responses=problems(404) | FILES,
    dependencies=[require(Permission.VIEW)],
)
def list_alarms(
    context: Context,
    file: ListAnswer,
    ied: OfRelay = None,
    motor: OfMotor = None,
    standing: Annotated[
        bool | None,
        Query(description="true: those whose cause stands; false: those whose is gone; without: both."),
    ] = None,
    part_of: Annotated[
        UUID | None, Query(description="Only those that this alarm tells in one line.")
    ] = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[Alarm] | StreamingResponse:
    """Return the alarms, over or not, latest first."""
    context.require_motor(motor)
    if ied is not None:
        context.repository.relay(ied)
    group = None if part_of is None else str(part_of)
    if file is not None:
        chosen = None if motor is None else [motor]
        rows = table.alarms(context.repository, chosen, relay=ied, standing=standing, part_of=group)
        return file.of(table.TABLE, rows, chosen)
    alarms = context.repository.alarms(
        relay=ied,
        motor=motor,
        standing=standing,
        part_of=group,
        limit=limit,
        after=decode(cursor, int, str),
    )
    return page(alarms, Alarm.model_validate)


@router.get(
    "/alarms/open",
    response_model=Page[Alarm],
    responses=problems(404) | FILES,
    dependencies=[require(Permission.VIEW)],
)
def list_open_alarms(
    context: Context,
    file: ListAnswer,
    site: Annotated[str | None, Query(max_length=200, description="Only alarms of this site.")] = None,
    ied: OfRelay = None,
    motor: OfMotor = None,
    state: Annotated[AlarmState | None, Query(description="Only alarms in this state.")] = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[Alarm] | StreamingResponse:
    """Return the alarms that are not over, what to act on first at the top.

    Those that nobody has taken notice of come first, then those acknowledged, those whose cause is gone, and
    those set aside; in each, the highest priority first, and of those the latest.
    """
    context.require_motor(motor)
    if ied is not None:
        context.repository.relay(ied)
    if file is not None:
        rows = table.open_alarms(context.repository, site=site, relay=ied, motor=motor, state=state)
        return file.of(table.TABLE, rows, None if motor is None else [motor])
    alarms = context.repository.open_alarms(
        site=site, relay=ied, motor=motor, state=state, limit=limit, after=decode(cursor, int, int, str)
    )
    return page(alarms, Alarm.model_validate)


@router.get("/alarms/figures", responses=problems(), dependencies=[require(Permission.VIEW)])
def get_alarm_figures(
    context: Context,
    days: Annotated[int, Query(ge=1, le=MOST_DAYS, description="So many days of UTC, with today.")] = 30,
) -> AlarmFigures:
    """Return how many alarms a day there were, the most frequent, chattering and long-standing ones."""
    now_ns = time.time_ns()
    from_ns = (now_ns // NANOSECONDS_PER_DAY - days + 1) * NANOSECONDS_PER_DAY
    figures = context.repository.alarm_figures(from_ns=from_ns, now_ns=now_ns)
    return AlarmFigures.model_validate(figures)


@router.get("/alarms/{alarm_id}", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_alarm(context: Context, alarm_id: UUID) -> Alarm:
    """Return one alarm."""
    return Alarm.model_validate(context.repository.alarm(str(alarm_id)))


@router.get("/alarms/{alarm_id}/changes", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_alarm_changes(
    context: Context, alarm_id: UUID, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[AlarmChange]:
    """Return what happened to an alarm, and by whom, latest first; the latest thousand are kept."""
    changes = context.repository.alarm_changes(str(alarm_id), limit=limit, after=decode(cursor, int))
    return page(changes, AlarmChange.model_validate)
