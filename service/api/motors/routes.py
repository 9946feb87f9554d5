"""Sites and motors; their condition."""

import time
from functools import partial
from typing import Annotated

from fastapi import APIRouter, Query, Response
from fastapi.responses import StreamingResponse

from core.machines.parameters import ParametersSource
from core.operation import Operation
from core.quantities import TrendedName
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.conditions.documents import condition_document
from service.api.context import Context
from service.api.document import Name
from service.api.exports.answers import FILES, ListAnswer
from service.api.motors.commissioning import offer
from service.api.motors.schemas import (
    Health,
    ListedMotor,
    Motor,
    PlantMotor,
    RecordedStarts,
    Site,
    TrendPoint,
    Winding,
)
from service.api.motors.trend_page import trend_page
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.recordings.listed import listed
from service.api.recordings.schemas import ListedRecording, Recording
from service.api.times import From, To, rfc3339
from service.condition.staleness import stale_after_ns
from service.configuration.settings import Settings
from service.exports import recordings, trends
from service.storage.records import MotorHealth

router = APIRouter()


@router.get("/sites", responses=problems(), tags=["plant"], dependencies=[require(Permission.VIEW)])
def list_sites(context: Context, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None) -> Page[Site]:
    """Return the sites (substations of the plant's SCD), by name."""
    return page(context.repository.sites(limit=limit, after=decode(cursor, str)), Site.model_validate)


@router.get(
    "/motors",
    responses=problems(),
    tags=["plant"],
    response_model_exclude_unset=True,
    dependencies=[require(Permission.VIEW)],
)
def list_motors(
    context: Context,
    health: Annotated[bool, Query(description="With the health of each, as `motors/{name}/health`.")] = False,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[ListedMotor]:
    """Return the motors, by name."""
    after = decode(cursor, str)
    if health:
        healths = context.repository.health_of_motors(limit=limit, after=after)
        return page(healths, partial(_with_health, now_ns=time.time_ns(), settings=context.settings))
    return page(context.repository.motors(limit=limit, after=after), ListedMotor.model_validate)


@router.get(
    "/motors/{name}", responses=problems(404), tags=["plant"], dependencies=[require(Permission.VIEW)]
)
def get_motor(context: Context, name: Name) -> Motor:
    """Return one motor, with its stator winding where that is known."""
    motor = PlantMotor.model_validate(context.repository.motor(name))
    versions = context.repository.motor_versions(name)
    winding = versions[-1].document.get("winding") if versions else None
    return Motor(**motor.model_dump(), winding=None if winding is None else Winding.model_validate(winding))


@router.get(
    "/motors/{name}/health",
    responses=problems(404),
    tags=["condition"],
    dependencies=[require(Permission.VIEW)],
)
def get_health(context: Context, name: Name) -> Health:
    """Return a motor's condition, what its latest recording says by itself, and whether its relay answers."""
    return _health(context.repository.health(name), time.time_ns(), context.settings)


@router.get(
    "/motors/{name}/trend",
    response_model=Page[TrendPoint],
    responses=problems(404) | FILES,
    tags=["condition"],
    dependencies=[require(Permission.VIEW)],
)
def get_trend(
    context: Context,
    name: Name,
    file: ListAnswer,
    quantity: TrendedName = "mu_f",
    from_: From = None,
    to: To = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Response:
    """Return one figure for each recording of a motor, oldest first.

    `condition_level`, `change` and those that end with `_change` are what was said of the motor from that
    recording on; the others are what the recording says by itself. A file has them all, whatever `quantity`
    is.
    """
    if file is not None:
        context.require_motor(name)
        rows = trends.trends(context.repository, [name], from_ns=from_, to_ns=to)
        return file.of(trends.TABLE, rows, [name])
    after = decode(cursor, int, str)
    points = context.repository.trend(name, quantity, from_ns=from_, to_ns=to, limit=limit, after=after)
    return trend_page(points, quantity)


@router.get(
    "/motors/{name}/recordings",
    response_model=Page[ListedRecording],
    responses=problems(404) | FILES,
    tags=["recordings"],
    dependencies=[require(Permission.VIEW)],
)
def list_recordings_of_motor(
    context: Context,
    name: Name,
    file: ListAnswer,
    operation: Annotated[Operation | None, Query(description="What the motor does in them.")] = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[ListedRecording] | StreamingResponse:
    """Return the recordings of a motor, latest first."""
    context.require_motor(name)
    if file is not None:
        rows = recordings.recordings(context.repository, [name], operation=operation)
        return file.of(recordings.TABLE, rows, [name])
    found = context.repository.recordings(
        motor=name, operation=operation, limit=limit, after=decode(cursor, int, str)
    )
    return listed(context, found)


def _starts(health: MotorHealth) -> RecordedStarts | None:
    """Return the starts that the motor's parameters follow from, with the command that estimates them."""
    if health.starts is None:
        return None
    known = health.motor.parameters_source is ParametersSource.COMMISSIONED
    number, latest_ns = health.starts.number, health.starts.latest_ns
    return RecordedStarts(
        number=number,
        latest_time=rfc3339(latest_ns),
        advice=None if known else offer(health.motor.name, number),
    )


def _with_health(health: MotorHealth, now_ns: int, settings: Settings) -> ListedMotor:
    return ListedMotor.model_validate(health.motor).model_copy(
        update={"health": _health(health, now_ns, settings)}
    )


def _health(health: MotorHealth, now_ns: int, settings: Settings) -> Health:
    oldest_ns = stale_after_ns(health.motor.schedule, settings.stale_after_days)
    diagnosis = health.diagnosis
    link = health.ied
    last = health.last_recording
    return Health(
        motor=health.motor.name,
        site=health.motor.site,
        ied=health.motor.ied,
        parameters_source=health.motor.parameters_source,
        condition=condition_document(
            health.condition, now_ns, oldest_ns, diagnosis, source=health.motor.parameters_source
        ),
        verdict=None if diagnosis is None else diagnosis.verdict,
        mu_f=None if diagnosis is None else diagnosis.mu_f,
        mu_f_ci95=None if diagnosis is None else diagnosis.mu_f_ci95,
        mu_f_scatter95=None if diagnosis is None else diagnosis.mu_f_scatter95,
        detection_limit=None if diagnosis is None else diagnosis.detection_limit,
        phase=None if diagnosis is None else diagnosis.phase,
        load_level=None if diagnosis is None else diagnosis.load_level,
        load_level_ci95=None if diagnosis is None else diagnosis.load_level_ci95,
        reasons=[] if diagnosis is None else list(diagnosis.reasons),
        recording_id=None if diagnosis is None else diagnosis.recording_id,
        recorded_time=None if diagnosis is None else rfc3339(diagnosis.recorded_ns),
        link_state=link.link_state,
        link_reason=link.link_reason,
        last_success_time=None if link.last_success_ns is None else rfc3339(link.last_success_ns),
        last_recording=None if last is None else Recording.model_validate(last),
        starts=_starts(health),
        stood_time=None if health.condition.stood_ns is None else rfc3339(health.condition.stood_ns),
    )
