"""The pages of alarms, and the forms on them. The forms call what the API's routes call."""

from http import HTTPStatus
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Form, Query
from starlette.responses import Response

from core.units import NANOSECONDS_PER_HOUR
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.alarms import people
from service.api.alarms.schemas import (
    MOST_AT_ONCE,
    AcknowledgementRequest,
    Remark,
    ShelvingRequest,
    UndoRequest,
)
from service.api.problems import ProblemError
from service.api.times import rfc3339
from service.storage.errors import AlarmActionError
from service.timing.undo_time import UNDO_NS
from service.web.addresses import LONGEST, address, own_address
from service.web.alarms.details import SHELVING_HOURS, alarm_details
from service.web.alarms.lists import AlarmChoice, AlarmTab, alarm_list, look_of
from service.web.forms import document_of_form
from service.web.live.routes import live_address
from service.web.view import Looking, View
from service.web.words import phrase

router = APIRouter()

ACKNOWLEDGE = [require(Permission.ACKNOWLEDGE)]
CONFIGURE = [require(Permission.CONFIGURE)]

Text = Annotated[str | None, Query(max_length=200)]
Comment = Annotated[str, Form(max_length=2000)]
Next = Annotated[str | None, Form(alias="next", max_length=LONGEST)]


@router.get("/alarms", dependencies=[require(Permission.VIEW)])
def show_alarms(
    view: Looking,
    show: AlarmTab = AlarmTab.ACTIVE,
    site: Text = None,
    text: Text = None,
    motor: Text = None,
    relay: Text = None,
    cursor: Annotated[str | None, Query(max_length=1000)] = None,
    refused: Annotated[list[UUID] | None, Query(max_length=MOST_AT_ONCE)] = None,
) -> Response:
    """Show the alarms, what to act on first at the top."""
    choice = AlarmChoice(
        tab=show,
        site=site or None,
        text=(text or "").strip() or None,
        motor=motor or None,
        relay=relay or None,
        cursor=cursor or None,
    )
    live = live_address(view.request, "alarms")
    repository = view.context.repository
    found = alarm_list(repository, choice, refused=[str(one) for one in refused or ()])
    since_ns = view.now_ns - UNDO_NS
    own = repository.acknowledged_by(view.asking.actor.name, since_ns=since_ns, limit=MOST_AT_ONCE)
    return view.page("alarms/list.html", title="Alarms", found=found, own=own, live=live)


@router.post("/alarms/acknowledgements", dependencies=ACKNOWLEDGE)
def acknowledge_alarms(
    view: Looking,
    alarm: Annotated[list[str] | None, Form()] = None,
    only: Annotated[str | None, Form(max_length=36)] = None,
    comment: Comment = "",
    next_: Next = None,
) -> Response:
    """Take notice of the alarms that are chosen, or of the one whose button was pressed."""
    chosen = [only] if only else alarm or []
    wanted = document_of_form(AcknowledgementRequest, {"alarms": chosen, "comment": comment.strip()})
    try:
        done = people.acknowledge_alarms(view.context, view.asking, wanted)
    except ProblemError as error:
        if error.status is not HTTPStatus.CONFLICT:
            raise
        ids = list(dict.fromkeys(map(str, wanted.alarms)))
        if len(ids) == 1:
            return view.done(address("/alarms", ids[0]), "not-acknowledged")
        return view.done(own_address(next_, "/alarms"), "not-acknowledged", refused=ids)
    refused = [one.alarm for one in done.refused]
    what = "acknowledged-some" if refused else "acknowledged"
    return view.done(own_address(next_, "/alarms"), what, refused=refused or None)


@router.post("/alarms/acknowledgements/undo", dependencies=ACKNOWLEDGE)
def undo_acknowledgements(
    view: Looking, alarm: Annotated[list[str] | None, Form()] = None, next_: Next = None
) -> Response:
    """Have alarms call again that the same person has just acknowledged."""
    wanted = document_of_form(UndoRequest, {"alarms": alarm or []})
    people.undo_acknowledgements(view.context, view.asking, wanted)
    return view.done(own_address(next_, "/alarms"), "acknowledgement-undone")


@router.get("/alarms/{alarm_id}", dependencies=[require(Permission.VIEW)])
def show_alarm(view: Looking, alarm_id: UUID) -> Response:
    """Show one alarm with its history."""
    live = live_address(view.request, "alarms")
    details = alarm_details(view.context.repository, str(alarm_id), with_messages=view.may(Permission.NOTIFY))
    alarm = details.alarm
    return view.page(
        "alarms/alarm.html",
        title=f"{alarm.place}: {phrase(alarm.kind)}",
        details=details,
        live=live,
        look=look_of(alarm),
        shelving_hours=SHELVING_HOURS,
    )


@router.post("/alarms/{alarm_id}/acknowledgement", dependencies=ACKNOWLEDGE)
def acknowledge_alarm(view: Looking, alarm_id: UUID, comment: Comment = "", next_: Next = None) -> Response:
    """Take notice of one alarm."""
    try:
        people.acknowledge_alarm(view.context, view.asking.actor, alarm_id, _remark(comment))
    except AlarmActionError:
        return _done(view, alarm_id, "not-acknowledged")
    return _done(view, alarm_id, "acknowledged", next_)


@router.post("/alarms/{alarm_id}/shelving", dependencies=ACKNOWLEDGE)
def shelve_alarm(
    view: Looking,
    alarm_id: UUID,
    hours: Annotated[int | None, Form(ge=1, le=24 * people.LONGEST_SHELVING_DAYS)] = None,
    growth_percent: Annotated[str, Form(max_length=20)] = "",
    comment: Comment = "",
) -> Response:
    """Set an alarm aside for a time, until it has grown by so much, or what comes first."""
    until = None if hours is None else rfc3339(view.now_ns + hours * NANOSECONDS_PER_HOUR)
    fields = {"until": until, "growth": _share(growth_percent), "comment": comment.strip()}
    wanted = document_of_form(ShelvingRequest, fields)
    people.shelve_alarm(view.context, view.asking.actor, alarm_id, wanted)
    return _done(view, alarm_id, "shelved")


@router.post("/alarms/{alarm_id}/unshelving", dependencies=ACKNOWLEDGE)
def unshelve_alarm(view: Looking, alarm_id: UUID, comment: Comment = "") -> Response:
    """End the shelving of an alarm."""
    said = _remark(comment).comment
    people.unshelve_alarm(view.context, view.asking.actor, alarm_id, said)
    return _done(view, alarm_id, "unshelved")


@router.post("/alarms/{alarm_id}/out-of-service", dependencies=CONFIGURE)
def take_alarm_out_of_service(view: Looking, alarm_id: UUID, comment: Comment = "") -> Response:
    """Set an alarm aside until somebody puts it back."""
    people.take_alarm_out_of_service(view.context, view.asking.actor, alarm_id, _remark(comment))
    return _done(view, alarm_id, "out-of-service")


@router.post("/alarms/{alarm_id}/back-in-service", dependencies=CONFIGURE)
def put_alarm_back_in_service(view: Looking, alarm_id: UUID, comment: Comment = "") -> Response:
    """Put an alarm back in service."""
    said = _remark(comment).comment
    people.put_alarm_back_in_service(view.context, view.asking.actor, alarm_id, said)
    return _done(view, alarm_id, "back-in-service")


def _remark(comment: str) -> Remark:
    return document_of_form(Remark, {"comment": comment.strip()})


def _share(percent: str) -> object:
    """Return a figure in per cent as a fraction; what is no figure stays, for the answer that says so."""
    try:
        return float(percent.replace(",", ".")) / 100.0 if percent.strip() else None
    except ValueError:
        return percent


def _done(view: View, alarm_id: UUID, what: str, next_: str | None = None) -> Response:
    return view.done(own_address(next_, address("/alarms", str(alarm_id))), what)
