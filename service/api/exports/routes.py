"""Files of several motors, or of all: trends, recordings, starts, measurements and alarms."""

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.responses import StreamingResponse
from pydantic import StringConstraints

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import ApiContext, Context
from service.api.exports.answers import FILES, FileOnly
from service.api.problems import problems
from service.api.times import From, To
from service.exports import alarms, inspections, measurements, recordings, starts, trends
from service.plant import AveragingStep

MOST_MOTORS = 1000
"""Of names that are not too long: the head of a request has at most 64 KiB, beyond that it gets 400."""

router = APIRouter(
    prefix="/exports",
    tags=["exports"],
    dependencies=[require(Permission.VIEW)],
    responses=FILES | problems(400),
    default_response_class=StreamingResponse,  # or the document would say that it answers JSON too
)

Motors = Annotated[
    list[Annotated[str, StringConstraints(max_length=200)]] | None,
    Query(alias="motor", max_length=MOST_MOTORS, description="Only these, in this order; without: all."),
]


@router.get("/trend")
def export_trend(
    context: Context, answer: FileOnly, motor: Motors = None, from_: From = None, to: To = None
) -> StreamingResponse:
    """Return what each recording says, of one motor after another, oldest first."""
    rows = trends.trends(context.repository, _chosen(context, motor), from_ns=from_, to_ns=to)
    return answer.of(trends.TABLE, rows, motor)


@router.get("/measurements")
def export_measurements(
    context: Context,
    answer: FileOnly,
    motor: Motors = None,
    step: Annotated[
        AveragingStep, Query(description="0: as sampled; 60, 900: means of so many seconds, kept for longer.")
    ] = AveragingStep.AS_SAMPLED,
    from_: From = None,
    to: To = None,
) -> StreamingResponse:
    """Return what the relays measure all the time, of one motor after another, oldest first."""
    chosen = _chosen(context, motor)
    rows = measurements.measurements(context.repository, chosen, step, from_ns=from_, to_ns=to)
    return answer.of(measurements.TABLE, rows, motor)


@router.get("/recordings")
def export_recordings(context: Context, answer: FileOnly, motor: Motors = None) -> StreamingResponse:
    """Return the recordings with their verdicts, of one motor after another or of all, latest first."""
    _require(context, motor)
    return answer.of(recordings.TABLE, recordings.recordings(context.repository, motor), motor)


@router.get("/starts")
def export_starts(context: Context, answer: FileOnly, motor: Motors = None) -> StreamingResponse:
    """Return the starts with their figures, of one motor after another or of all, latest first."""
    _require(context, motor)
    return answer.of(starts.TABLE, starts.starts(context.repository, motor), motor)


@router.get("/alarms")
def export_alarms(context: Context, answer: FileOnly, motor: Motors = None) -> StreamingResponse:
    """Return the alarms, of one motor after another or of all, latest first."""
    _require(context, motor)
    return answer.of(alarms.TABLE, alarms.alarms(context.repository, motor), motor)


@router.get("/inspections")
def export_inspections(context: Context, answer: FileOnly, motor: Motors = None) -> StreamingResponse:
    """Return what inspections found, of one motor after another or of all, latest first."""
    _require(context, motor)
    return answer.of(inspections.TABLE, inspections.inspections(context.repository, motor), motor)


def _require(context: ApiContext, motors: Sequence[str] | None) -> None:
    for name in motors or ():
        context.require_motor(name)


def _chosen(context: ApiContext, motors: Sequence[str] | None) -> Sequence[str]:
    """Return these motors, each of which there is, or all in service, by name."""
    _require(context, motors)
    return motors or sorted(context.repository.schedules())
