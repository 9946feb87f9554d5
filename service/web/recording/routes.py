"""The pages of recordings, and the forms on them. The forms call what the API's routes call."""

from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, File, Form, Query, UploadFile
from fastapi.concurrency import run_in_threadpool
from starlette.responses import Response

from core.operation import Operation
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.pages import decode, encode
from service.api.problems import ProblemError, WrongFieldError
from service.api.recordings.deletions import undone_deletion
from service.api.recordings.diagnoses import queue_diagnosis
from service.api.recordings.diagnosis_schemas import DiagnosisRequest
from service.api.recordings.routes import FORM_LIMITS, store_upload
from service.api.samples.opening import in_turn
from service.retention.deletion import delete_recording
from service.storage.states import RecordingState
from service.timing.undo_time import UNDO_NS
from service.web.addresses import address
from service.web.choices import motor_names
from service.web.recording.comparison import comparison
from service.web.recording.drawn_model import drawn_model
from service.web.recording.page_data import MOST_CHOICES, cursor_of, recording_page
from service.web.recording.verdicts import look_of, page_look, page_words, sentence, words_of
from service.web.view import Looking, View

router = APIRouter()

UPLOADS: Final = frozenset({("POST", "/recordings")})
"""Routes that take files."""
ROWS: Final = 50
MOST_UNDONE: Final = 10
"""So many deletions are offered to be undone, each by a button."""
FARTHEST_S: Final = 1e6
VIEW = [require(Permission.VIEW)]
CHANGE = [require(Permission.RECORDINGS)]

Text = Annotated[str | None, Query(max_length=200)]
Seconds = Annotated[float | None, Query(ge=-FARTHEST_S, le=FARTHEST_S)]


@dataclass(frozen=True, slots=True)
class Refused:
    """Files that were brought and not taken, and why."""

    names: tuple[str, ...]
    why: str


@router.get("/recordings", dependencies=VIEW)
def show_recordings(
    view: Looking,
    motor: Text = None,
    show: Annotated[str | None, Query(max_length=40)] = None,
    with_: Annotated[UUID | None, Query(alias="with")] = None,
    cursor: Annotated[str | None, Query(max_length=1000)] = None,
) -> Response:
    """Show recordings, latest first, of one motor or of all; and the form that brings one."""
    return _list(view, motor or None, show or None, with_, cursor or None)


def _list(
    view: View,
    motor: str | None,
    show: str | None = None,
    with_: UUID | None = None,
    cursor: str | None = None,
    refused: Refused | None = None,
) -> Response:
    """Return the list. refused: files that were brought and not taken. Raises NotFoundError, ProblemError."""
    context = view.context.within(view.asking.sites)  # also where a form that changes something shows it
    repository = context.repository
    context.require_motor(motor)
    state = next((one for one in RecordingState if one == show), None)
    operation = None if state is not None else next((one for one in Operation if one == show), None)
    if show is not None and state is None and operation is None:
        expected = ", ".join(dict.fromkeys([*RecordingState, *Operation]))
        raise WrongFieldError("query.show", f"expected one of {expected}, found {show!r}")
    found = repository.recordings(
        motor=motor, state=state, operation=operation, limit=ROWS, after=decode(cursor, int, str)
    )
    verdicts = repository.verdicts([one.id for one in found.items])
    later = None if found.next is None else encode(found.next)
    return view.page(
        "recording/list.html",
        status=HTTPStatus.OK if refused is None else HTTPStatus.UNPROCESSABLE_ENTITY,
        refused=refused,
        own_deletions=repository.deleted_by(
            view.asking.actor.name, since_ns=view.now_ns - UNDO_NS, limit=MOST_UNDONE
        ),
        title="Recordings" if motor is None else f"Recordings of {motor}",
        recordings=found.items,
        verdicts=verdicts,
        motors=motor_names(repository),
        motor=motor,
        chosen_show=state or operation,
        states=[*RecordingState],
        operations=[*Operation],
        compared=None if with_ is None else str(with_),
        is_later_page=bool(cursor),
        next_page=None
        if later is None
        else address("/recordings", motor=motor, show=state or operation, cursor=later, **{"with": with_}),
        look_of=look_of,
        words_of=words_of,
    )


@router.post("/recordings", dependencies=CHANGE, form_limits=FORM_LIMITS)
async def bring_recording(
    view: Looking,
    motor: Annotated[str, Form(min_length=1, max_length=200)],
    files: Annotated[list[UploadFile] | None, File()] = None,
) -> Response:
    """Store the files of one recording and queue its diagnosis.

    What is wrong with the files stands beside their field, with the motor chosen as it was.
    """
    context = view.context
    given = [one for one in files or () if one.filename]
    names = tuple((one.filename or "")[:100] for one in given)
    if not given:
        refused = Refused((), "choose the files of one recording first")
        return await run_in_threadpool(_list, view, motor, refused=refused)
    try:
        async with context.uploads.admitted():
            added, _ = await run_in_threadpool(store_upload, context, view.asking, motor, given)
    except ProblemError as error:
        about_files = [one.message for one in error.errors or () if one.location == "body.files"]
        if not about_files:
            raise
        return await run_in_threadpool(_list, view, motor, refused=Refused(names, "; ".join(about_files)))
    what = "recording-added" if added.created else "recording-known"
    return view.done(address("/recordings", added.recording.id), what)


@router.get("/recordings/{recording_id}", dependencies=VIEW)
async def show_recording(
    view: Looking,
    recording_id: UUID,
    at_s: Seconds = None,
    with_: Annotated[UUID | None, Query(alias="with")] = None,
    model: Annotated[bool, Query(description="With what the model leaves of the currents.")] = False,
) -> Response:
    """Show one recording. A script asks for what the model leaves; without one, a link does."""
    context = view.context

    def seen() -> Response:
        page = recording_page(context, str(recording_id), at_s)
        drawn = drawn_model(context, page.entry) if model and page.waveforms is not None else None
        compared = None if with_ is None else comparison(context, page.entry, str(with_))
        choices = context.repository.recordings(motor=page.entry.motor, limit=MOST_CHOICES).items
        return view.page(
            "recording/recording.html",
            title=f"{page.entry.motor}: recording {page.entry.name}",
            page=page,
            said=sentence(page.entry, page.diagnosis),
            look=page_look(page.diagnosis),
            words=page_words(page.diagnosis),
            cursor=None if page.waveforms is None else page.waveforms.cursor,
            compared=compared,
            drawn=drawn,
            live=None if page.diagnosis is not None else address("/live", topic=f"motor:{page.entry.motor}"),
            choices=[one for one in choices if one.id != page.entry.id and one.digest is not None],
        )

    return await in_turn(context, seen)


@router.get("/recordings/{recording_id}/phasors", dependencies=VIEW)
async def show_phasors(view: Looking, recording_id: UUID, at_s: Seconds = 0.0) -> Response:
    """Show the phasors at the cursor, as a part of the page."""
    context = view.context

    def seen() -> Response:
        cursor = cursor_of(context, str(recording_id), at_s or 0.0)
        return view.fragment("recording/phasors.html", cursor=cursor)

    return await in_turn(context, seen)


@router.get("/recordings/{recording_id}/model", dependencies=VIEW)
async def show_model(view: Looking, recording_id: UUID) -> Response:
    """Show what the model leaves of the currents, as a part of the page: a worker draws it anew."""
    context = view.context

    def seen() -> Response:
        entry = context.repository.recording(str(recording_id))
        return view.fragment("recording/model.html", drawn=drawn_model(context, entry))

    return await in_turn(context, seen)


@router.post("/recordings/{recording_id}/diagnoses", dependencies=CHANGE)
def diagnose_again(view: Looking, recording_id: UUID) -> Response:
    """Queue another diagnosis of the recording with the usual method and model."""
    queue_diagnosis(view.context, view.asking.actor, str(recording_id), DiagnosisRequest())
    return view.done(address("/recordings", str(recording_id)), "diagnosis-queued")


@router.post("/recordings/{recording_id}/deletion", dependencies=CHANGE)
def remove_recording(
    view: Looking,
    recording_id: UUID,
    reason: Annotated[str, Form(min_length=1, max_length=500, pattern=r"^[^\x00]*[^\x00\s][^\x00]*$")],
) -> Response:
    """Delete a recording that should not be there, as one of another motor."""
    deletion = delete_recording(
        view.context.repository, str(recording_id), reason.strip(), by=view.asking.actor, now_ns=view.now_ns
    )
    return view.done(address("/recordings", motor=deletion.motor), "recording-deleted")


@router.post("/deletions/{recording_id}/undo", dependencies=CHANGE)
def undo_deletion(view: Looking, recording_id: UUID) -> Response:
    """Have a recording back that the same person has just deleted."""
    entry = undone_deletion(view.context, str(recording_id), view.asking.actor)
    return view.done(address("/recordings", entry.id), "deletion-undone")
