"""The pages of a motor: an overview, and a tab for each part of it and for what is kept of it."""

from typing import Annotated, Any, Final

from fastapi import APIRouter, Query
from starlette.responses import Response

from core.condition.events import EventKind
from core.condition.kinds import Kind
from core.machines.parameters import MachineKind
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.conditions.undo import latest_to_undo
from service.api.document import Name
from service.api.load.routes import MOST_DAYS
from service.storage.states import InspectionOutcome
from service.web.live.routes import live_address
from service.web.load.load import load_page
from service.web.motor.answer import answer_section
from service.web.motor.drawings import MotorDrawings, motor_drawings
from service.web.motor.measured import MEASURED_WITHIN_NS, measured_values
from service.web.motor.overview import overview
from service.web.motor.page import (
    LOAD,
    LOGBOOK,
    NAMEPLATE,
    OVERVIEW,
    RECORDINGS,
    ROTOR,
    STARTS,
    STATOR,
    SUPPLY,
    MotorHead,
    Tab,
    motor_head,
)
from service.web.motor.parameters import parameters_section
from service.web.motor.rotor import rotor_section
from service.web.motor.supply import supply_section
from service.web.motor.swings import swing_section
from service.web.motor.time_range import USUAL
from service.web.starts.starts import starts_of_motor
from service.web.view import Looking, View

MOST_NOTES: Final = 20
MOST_CHANGES: Final = 10
MOST_INSPECTIONS: Final = 10
MOST_RECORDINGS: Final = 12
MOST_REQUESTS: Final = 3

router = APIRouter()

VIEW: Final = [require(Permission.VIEW)]
Days = Annotated[str, Query(max_length=10)]
Cursor = Annotated[str | None, Query(max_length=1000)]


@router.get("/motors/{name}", dependencies=VIEW)
def show_motor(view: Looking, name: Name, days: Days = USUAL) -> Response:
    """Show a motor: what is wrong with it, by part, and how that came."""
    live, head = _begun(view, name, OVERVIEW, days)
    page = overview(view.context.repository, head)
    long_s = view.context.settings.long_record_s
    return _tab(view, head, "motor/overview.html", live, page=page, long_record_s=long_s)


@router.get("/motors/{name}/stator", dependencies=VIEW)
def show_stator(view: Looking, name: Name, days: Days = USUAL) -> Response:
    """Show how the condition of the stator is known."""
    live, head = _begun(view, name, STATOR, days)
    repository = view.context.repository
    return _tab(
        view,
        head,
        "motor/stator.html",
        live,
        answer=answer_section(repository, name),
        drawings=_drawings(view, head),
        changes=repository.condition_history(name, limit=MOST_CHANGES).items,
    )


@router.get("/motors/{name}/rotor", dependencies=VIEW)
def show_rotor(view: Looking, name: Name, days: Days = USUAL) -> Response:
    """Show what records say of the rotor, of the air gap and of a load that swings."""
    live, head = _begun(view, name, ROTOR, days)
    repository = view.context.repository
    kind = MachineKind.CAGE if head.known is None else head.known.motor.kind
    return _tab(
        view,
        head,
        "motor/rotor.html",
        live,
        rotor=rotor_section(repository, name, kind, head.shown),
        swings=swing_section(repository, name, head.shown),
    )


@router.get("/motors/{name}/supply", dependencies=VIEW)
def show_supply(view: Looking, name: Name, days: Days = USUAL) -> Response:
    """Show the supply of a motor, and what its relay measured last."""
    live, head = _begun(view, name, SUPPLY, days)
    repository = view.context.repository
    latest = repository.latest_sample(name, since_ns=view.now_ns - MEASURED_WITHIN_NS)
    return _tab(
        view,
        head,
        "motor/supply.html",
        live,
        supply=supply_section(repository, name, head.shown),
        drawings=_drawings(view, head),
        measured=measured_values(latest),
    )


@router.get("/motors/{name}/load", dependencies=VIEW)
def show_load(view: Looking, name: Name, days: Days = USUAL) -> Response:
    """Show how a motor was loaded, and how hot that makes it."""
    live, head = _begun(view, name, LOAD, days)
    context = view.context
    here = context.motors.get(name)
    found = load_page(
        context.repository,
        name,
        days=min(round(head.shown.span.days or MOST_DAYS), MOST_DAYS),
        now_ns=view.now_ns,
        energy=context.settings.energy,
        thermal=None if here is None else here.thermal,
    )
    return _tab(view, head, "load/page.html", live, found=found, most_days=MOST_DAYS)


@router.get("/motors/{name}/starts", dependencies=VIEW)
def show_starts_of_motor(view: Looking, name: Name, days: Days = USUAL, cursor: Cursor = None) -> Response:
    """Show a motor's starts, the latest ones over its reference."""
    live, head = _begun(view, name, STARTS, days)
    found = starts_of_motor(view.context.repository, name, cursor or None)
    return _tab(view, head, "starts/motor.html", live, found=found)


@router.get("/motors/{name}/recordings", dependencies=VIEW)
def show_recordings_of_motor(view: Looking, name: Name, days: Days = USUAL) -> Response:
    """Show a motor's latest recordings, and those that were asked for."""
    live, head = _begun(view, name, RECORDINGS, days)
    repository = view.context.repository
    found = repository.recordings(motor=name, limit=MOST_RECORDINGS).items
    return _tab(
        view,
        head,
        "motor/recordings.html",
        live,
        recordings=found,
        verdicts=repository.verdicts([one.id for one in found]),
        requests=repository.recording_requests(motor=name, limit=MOST_REQUESTS).items,
        long_record_s=view.context.settings.long_record_s,
    )


@router.get("/motors/{name}/logbook", dependencies=VIEW)
def show_logbook(view: Looking, name: Name, days: Days = USUAL) -> Response:
    """Show what people wrote of a motor, and what inspections found."""
    live, head = _begun(view, name, LOGBOOK, days)
    repository = view.context.repository
    notes = repository.events(name, limit=MOST_NOTES)
    return _tab(
        view,
        head,
        "motor/logbook.html",
        live,
        notes=notes.items,
        more_notes=notes.next is not None,
        inspections=repository.inspections(name, limit=MOST_INSPECTIONS).items,
        alarms=repository.open_alarms(motor=name, limit=MOST_INSPECTIONS).items,
        kinds=_kinds(view),
        told_kinds=list(Kind),
        outcomes=list(InspectionOutcome),
    )


@router.get("/motors/{name}/nameplate", dependencies=VIEW)
def show_nameplate(view: Looking, name: Name, days: Days = USUAL) -> Response:
    """Show the nameplate and the parameters of a motor, and how those change."""
    live, head = _begun(view, name, NAMEPLATE, days)
    parameters = parameters_section(view.context.repository, name, head.shown)
    return _tab(view, head, "motor/nameplate.html", live, parameters=parameters)


def _begun(view: View, name: str, tab: Tab, days: str) -> tuple[str, MotorHead]:
    """Return where the page is told of changes, from what it is about to show on, and its top."""
    live = live_address(view.request, f"motor:{name}", "alarms")
    return live, motor_head(view.context, name, tab, days, view.now_ns)


def _tab(view: View, head: MotorHead, template: str, live: str, **data: Any) -> Response:
    undo = latest_to_undo(
        view.context.repository.events(head.name, limit=MOST_NOTES).items, view.asking.actor.name, view.now_ns
    )
    title = head.name if head.tab is OVERVIEW else f"{head.name}: {head.tab.words}"
    return view.page(template, title=title, live=live, head=head, here=head.here, undo=undo, **data)


def _drawings(view: View, head: MotorHead) -> MotorDrawings | None:
    if head.known is None:
        return None
    since_ns = head.health.condition.since_ns
    return motor_drawings(view.context.repository, head.known.motor, head.condition, since_ns, head.shown)


def _kinds(view: View) -> list[EventKind]:
    """Return what somebody may write into the logbook; what the file tells, the service notes by itself."""
    if not view.may(Permission.CONFIGURE):
        return [EventKind.NOTE]
    left_out = (EventKind.PARAMETERS_EDITED, EventKind.REFERENCE_RESTARTED)
    return [EventKind.NOTE, *(kind for kind in EventKind if kind not in (*left_out, EventKind.NOTE))]
