"""The figures behind a motor's trend, and the forms on its pages, which do what the API does."""

from http import HTTPStatus
from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, Form, Query
from fastapi.responses import JSONResponse
from starlette.responses import Response

from core.condition.events import EventKind
from core.units import NANOSECONDS_PER_SECOND
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.conditions.notes import keep_note
from service.api.conditions.planned_stops import keep_stop
from service.api.conditions.schemas import NoteRequest, RestartRequest, StopRequest, Withdrawal
from service.api.conditions.undo import undone
from service.api.document import Name
from service.api.problems import ProblemError
from service.api.recordings.diagnoses import queue_diagnosis
from service.api.recordings.diagnosis_schemas import DiagnosisRequest
from service.storage.records import StopOf
from service.storage.repository.sites import AtSite
from service.web.forms import document_of_form
from service.web.motor.page import LOGBOOK, OVERVIEW, RECORDINGS, Tab, tab_address
from service.web.motor.trend import trend_chart
from service.web.view import Looking, View
from service.web.words import phrase

router = APIRouter()

LATEST_S: Final = 9.2e9
"""Times are integers of 64 bits in the database."""

Seconds = Annotated[float, Query(ge=0.0, le=LATEST_S, allow_inf_nan=False)]
Text = Annotated[str, Form(max_length=2000)]


@router.get("/motors/{name}/trend", dependencies=[require(Permission.VIEW)])
def get_trend_piece(view: Looking, name: Name, from_s: Seconds, to_s: Seconds) -> Response:
    """Return the trend of a piece of time, which a chart shows when somebody looks closer."""
    if from_s > to_s:
        raise ProblemError(
            HTTPStatus.UNPROCESSABLE_ENTITY,
            f"query.to_s: expected a time after from_s, {from_s:g}, found {to_s:g}",
        )
    trend = view.context.repository.thinned_trend(
        name, from_ns=round(from_s * NANOSECONDS_PER_SECOND), to_ns=round(to_s * NANOSECONDS_PER_SECOND)
    )
    chart = trend_chart(name, trend)
    document = chart.document()
    return JSONResponse(
        {"x": document["x"], "series": document["series"], "summary": chart.summary},
        headers={"Cache-Control": "private, no-cache"},
    )


@router.post("/motors/{name}/recording-requests", dependencies=[require(Permission.TRIGGER)])
def record_motor(
    view: Looking, name: Name, seconds: Annotated[float | None, Form(ge=1.0, le=30.0)] = None
) -> Response:
    """Have the motor's relay make a recording, or a series that makes up so many seconds."""
    context = view.context
    context.repository.request_recording(
        name,
        by=view.asking.actor,
        now_ns=view.now_ns,
        most_open=context.settings.max_open_requests,
        seconds=seconds,
    )
    return _done(view, name, "recording-requested", RECORDINGS)


@router.post("/motors/{name}/diagnoses", dependencies=[require(Permission.RECORDINGS)])
def diagnose_again(view: Looking, name: Name, recording: Annotated[UUID, Form()]) -> Response:
    """Diagnose a recording again; its motor's condition follows."""
    view.asking.demand_here(view.context.repository, AtSite.RECORDING, str(recording))
    queue_diagnosis(view.context, view.asking.actor, str(recording), DiagnosisRequest())
    return _done(view, name, "diagnosis-requested", RECORDINGS)


@router.post("/motors/{name}/reference", dependencies=[require(Permission.CONFIGURE)])
def accept_as_reference(view: Looking, name: Name, reason: Text = "") -> Response:
    """Take the motor for healthy as it is."""
    wanted = document_of_form(RestartRequest, {"reason": reason})
    kind = EventKind.REFERENCE_RESTARTED
    keep_note(view.context, name, kind, wanted.reason, view.asking.actor, None, view.now_ns)
    return _done(view, name, "reference-restarted", LOGBOOK)


@router.post("/motors/{name}/notes", dependencies=[require(Permission.NOTE)])
def write_note(
    view: Looking,
    name: Name,
    text: Text = "",
    kind: Annotated[str, Form(max_length=50)] = EventKind.NOTE.value,
    time: Annotated[str, Form(max_length=40)] = "",
    anew: Annotated[bool, Form()] = False,
) -> Response:
    """Write into the motor's logbook. All kinds but a plain note change what its condition follows from."""
    wanted = document_of_form(NoteRequest, {"text": text, "kind": kind, "time": utc(time)})
    if wanted.kind is not EventKind.NOTE:
        view.asking.demand(Permission.CONFIGURE, f"tell of {wanted.kind.value}")
        if not anew:
            raise ProblemError(
                HTTPStatus.UNPROCESSABLE_ENTITY,
                f"{phrase(wanted.kind)} has the motor judged anew: what stands of it, its alarms too, may go "
                "until new records show it again. Tick 'Restart assessment', or write a note",
            )
    keep_note(view.context, name, wanted.kind, wanted.text, view.asking.actor, None, wanted.time)
    return _done(view, name, "note-kept", LOGBOOK)


@router.post("/motors/{name}/notes/{note_id}/withdrawal", dependencies=[require(Permission.CONFIGURE)])
def withdraw_note(view: Looking, name: Name, note_id: UUID, reason: Text = "") -> Response:
    """Let a note that was wrong count no more."""
    wanted = document_of_form(Withdrawal, {"reason": reason})
    view.context.repository.withdraw_event(
        name, str(note_id), by=view.asking.actor, reason=wanted.reason, now_ns=view.now_ns
    )
    view.context.on_new_job()
    return _done(view, name, "note-withdrawn", LOGBOOK)


@router.post("/motors/{name}/notes/{note_id}/undo", dependencies=[require(Permission.CONFIGURE)])
def undo_note(view: Looking, name: Name, note_id: UUID) -> Response:
    """Undo what the same person has just done: withdraw a note, or keep one again that was withdrawn."""
    undone(view.context, name, str(note_id), view.asking.actor, view.now_ns)
    return _done(view, name, "undone", LOGBOOK)


@router.post("/motors/{name}/planned-stop", dependencies=[require(Permission.NOTE)])
def plan_stop(
    view: Looking,
    name: Name,
    time: Annotated[str, Form(max_length=40)],
    of: Annotated[StopOf, Form()] = StopOf.MOTOR,
) -> Response:
    """Plan when the motor, or its whole site, stops next."""
    wanted = document_of_form(StopRequest, {"time": utc(time)})
    keep_stop(view.context, of, _named(view, name, of), wanted.time, view.asking.actor)
    return _done(view, name, "stop-planned", OVERVIEW)


@router.post("/motors/{name}/planned-stop/cancellation", dependencies=[require(Permission.NOTE)])
def cancel_stop(view: Looking, name: Name, of: Annotated[StopOf, Form()] = StopOf.MOTOR) -> Response:
    """Drop the plan of a stop, of the motor or of its site."""
    keep_stop(view.context, of, _named(view, name, of), None, view.asking.actor)
    return _done(view, name, "stop-cancelled", OVERVIEW)


def _named(view: View, motor: str, of: StopOf) -> str:
    """Return the name of what is meant: the motor, or its site. Who sees a motor may see its site."""
    return motor if of is StopOf.MOTOR else view.context.repository.motor(motor).site


def utc(text: str) -> str:
    """Return the time of a form's field, which is in UTC and has no offset, as the API takes it."""
    if "T" not in text or text.endswith("Z"):
        return text
    has_seconds = text.count(":") > 1
    return f"{text}Z" if has_seconds else f"{text}:00Z"


def _done(view: View, name: str, what: str, tab: Tab) -> Response:
    """Return the way to the tab that shows what became of a form."""
    return view.done(tab_address(name, tab), what)
