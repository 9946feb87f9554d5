"""Recordings: list, look at, take away, bring."""

import shutil
import time
from collections.abc import AsyncIterator
from dataclasses import replace
from http import HTTPStatus
from pathlib import PurePosixPath
from typing import Annotated, Final, TypedDict
from uuid import UUID

from fastapi import APIRouter, Depends, File, Form, Query, Request, Response, UploadFile
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import StreamingResponse

from core.machines.motor_tables import layout_of
from core.operation import Operation
from core.recordings import Envelope, RecordingError, read_envelope
from core.recordings.reading import recording_name
from service.access.permissions import Permission
from service.api.access.callers import Asking, Caller
from service.api.access.requirements import require
from service.api.context import ApiContext, Context, path_to
from service.api.exports.answers import FILES, ListAnswer
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode
from service.api.problems import ProblemError, WrongFieldError, problems
from service.api.recordings.archive import file_stem, zipped
from service.api.recordings.diagnosis_schemas import Diagnosis
from service.api.recordings.listed import listed
from service.api.recordings.schemas import ListedRecording, Recording, RecordingDetails, RecordingFile
from service.api.recordings.waveform import MAX_POINTS, Waveform, WaveformResponse, intervals_within
from service.exports import recordings as table
from service.recording_store.contents import WAVEFORM_SUFFIXES
from service.recording_store.errors import RecordingStoreError
from service.recording_store.recording import StoredRecording
from service.retention.deletion import remove_discarded_folder_if_possible
from service.storage.errors import FolderGoneError, TooManyWaitingError
from service.storage.records import Actor, RecordingEntry
from service.storage.repository.recordings.recordings import AddedRecording
from service.storage.repository.sites import AtSite
from service.storage.states import RecordingState

router = APIRouter(tags=["recordings"])

UPLOAD_SUFFIXES = {*WAVEFORM_SUFFIXES, ".HDR", ".INF"}
MAX_UPLOAD_FILES = 4


class FormLimits(TypedDict, total=False):
    """Limits of a form with files, as the parser takes them."""

    max_files: int
    max_fields: int
    max_part_size: int


FORM_LIMITS: Final[FormLimits] = {"max_files": 2 * MAX_UPLOAD_FILES, "max_fields": 4, "max_part_size": 4096}
"""Beyond these the parser gives up; up to them the route says which field is wrong."""
UPLOAD_ROUTES = frozenset({("POST", "/recordings")})
"""Routes that take files; bodies of others are small."""


@router.get(
    "/recordings",
    response_model=Page[ListedRecording],
    responses=problems(404) | FILES,
    dependencies=[require(Permission.VIEW)],
)
def list_recordings(
    context: Context,
    file: ListAnswer,
    motor: Annotated[str | None, Query(max_length=200)] = None,
    state: RecordingState | None = None,
    operation: Annotated[Operation | None, Query(description="What the motor does in them.")] = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[ListedRecording] | StreamingResponse:
    """Return recordings, of one motor or of all, in one state or in any, of any operation, latest first."""
    context.require_motor(motor)
    if state is not None and operation is not None:
        message = "expected state or operation, found both: a recording has an operation once it is diagnosed"
        raise WrongFieldError("query.operation", message)
    if file is not None:
        chosen = None if motor is None else [motor]
        rows = table.recordings(context.repository, chosen, state=state, operation=operation)
        return file.of(table.TABLE, rows, chosen)
    recordings = context.repository.recordings(
        motor=motor, state=state, operation=operation, limit=limit, after=decode(cursor, int, str)
    )
    return listed(context, recordings)


@router.post(
    "/recordings",
    status_code=HTTPStatus.CREATED,
    form_limits=FORM_LIMITS,
    responses=problems(400, 404, 408, 413, 415, 429)
    | {
        200: {
            "model": RecordingDetails,
            "description": "The motor has this recording already.",
        },
        201: {"headers": {"Location": {"schema": {"type": "string"}, "description": "The recording."}}},
    },
    dependencies=[require(Permission.RECORDINGS)],
)
async def upload_recording(
    context: Context,
    request: Request,
    response: Response,
    asking: Asking,
    motor: Annotated[str, Form(min_length=1, max_length=200, description="Name of the motor recorded.")],
    files: Annotated[
        list[UploadFile],
        File(
            description="COMTRADE: .CFG and .DAT, or .CFF; or a .CEV; or a table of samples (.CSV, .PARQUET, "
            ".MAT, .H5, .TDMS, .NPY, .NPZ).",
            json_schema_extra={"maxItems": MAX_UPLOAD_FILES},
        ),
    ],
) -> RecordingDetails:
    """Store the files of one recording and queue its diagnosis; one the motor has stays as it is."""
    async with context.uploads.admitted():
        added, details = await run_in_threadpool(store_upload, context, asking, motor, files)
    if not added.created:
        response.status_code = HTTPStatus.OK
    response.headers["Location"] = path_to(request, "get_recording", recording_id=added.recording.id)
    return details


@router.get("/recordings/{recording_id}", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_recording(context: Context, recording_id: UUID) -> RecordingDetails:
    """Return one recording with its files and its latest diagnosis."""
    return _details(context, context.repository.recording(str(recording_id)))


async def _sending_turn(context: Context) -> AsyncIterator[None]:
    """Hold one of the places for waveforms until the answer has been sent."""
    async with context.waveforms_sent.admitted():
        yield


@router.get(
    "/recordings/{recording_id}/waveform",
    response_model=Waveform,
    dependencies=[require(Permission.VIEW), Depends(_sending_turn)],
    responses=problems(404, 409),
)
async def get_waveform(
    context: Context,
    recording_id: UUID,
    points: Annotated[int, Query(ge=2, le=MAX_POINTS, description="Most intervals a channel.")] = 2000,
) -> WaveformResponse:
    """Return the samples of a recording as the smallest and largest value of up to `points` intervals.

    Records of many channels have fewer intervals (setting max_waveform_values).
    """
    async with context.waveforms_read.admitted():
        envelope = await run_in_threadpool(_envelope, context, str(recording_id), points)
    return WaveformResponse(str(recording_id), envelope)


@router.get(
    "/recordings/{recording_id}/file",
    response_class=StreamingResponse,
    responses=problems(404, 409)
    | {200: {"content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}}}},
    dependencies=[require(Permission.VIEW)],
)
def download_recording(context: Context, recording_id: UUID) -> StreamingResponse:
    """Return the files of a recording as they came from the relay, in a ZIP archive.

    The archive is named by the motor and the time of the recording.
    """
    entry = context.repository.recording(str(recording_id))
    stored = context.store.find(_digest(entry))
    return StreamingResponse(
        zipped(context.store, stored),
        media_type="application/zip",
        headers={"Content-Disposition": f'attachment; filename="{file_stem(entry)}.zip"'},
    )


def _envelope(context: ApiContext, recording_id: str, points: int) -> Envelope:
    entry = context.repository.recording(recording_id)
    within = intervals_within(points, context.settings.max_waveform_values)
    try:
        with context.store.opened(_digest(entry)) as file:
            envelope = read_envelope(file, within, layout_of(context.motors.get(entry.motor)))
    except RecordingError as error:
        raise ProblemError(HTTPStatus.CONFLICT, f"the recording cannot be read: {error}") from error
    if entry.recorded_ns is None:
        return envelope
    # The file may have local time; its diagnosis found out the UTC.
    ahead_ns = envelope.trigger_time_ns - entry.recorded_ns
    return replace(
        envelope, start_time_ns=envelope.start_time_ns - ahead_ns, trigger_time_ns=entry.recorded_ns
    )


def store_upload(
    context: ApiContext, asking: Caller, motor: str, files: list[UploadFile]
) -> tuple[AddedRecording, RecordingDetails]:
    """Store the files of one recording and queue its diagnosis, in a thread that may wait for the disk.

    Raises ProblemError, NotFoundError, TooManyWaitingError, OSError.
    """
    asking.demand_here(context.repository, AtSite.MOTOR, motor)
    context.repository.motor(motor)
    try:
        added = _add(context, asking.actor, motor, files)
    except FolderGoneError:  # a recording of the same content was deleted just now
        added = _add(context, asking.actor, motor, files)
    context.on_new_job()
    return added, _details(context, added.recording)


def _add(context: ApiContext, by: Actor, motor: str, files: list[UploadFile]) -> AddedRecording:
    stored = _store_upload(context, files)
    now_ns = time.time_ns()
    try:
        added = context.repository.add_recording(
            stored, motor=motor, by=by, now_ns=now_ns, most_queued=context.settings.max_queued_diagnoses
        )
    except TooManyWaitingError:
        context.repository.discard_stored(stored.digest, now_ns=now_ns)
        remove_discarded_folder_if_possible(context.repository, context.store, stored.digest, now_ns)
        raise
    if not added.created:
        remove_discarded_folder_if_possible(context.repository, context.store, stored.digest, now_ns)
    return added


def _digest(entry: RecordingEntry) -> str:
    if entry.digest is None:
        reason = "" if entry.reason is None else f": {entry.reason}"
        raise ProblemError(HTTPStatus.CONFLICT, f"the recording is {entry.state}, not stored{reason}")
    return entry.digest


def _details(context: ApiContext, entry: RecordingEntry) -> RecordingDetails:
    diagnosis = context.repository.current_diagnosis(entry.id)
    files = context.repository.recording_files(entry.id)
    return RecordingDetails(
        **Recording.model_validate(entry).model_dump(),
        copies=[one.id for one in context.repository.copies_of(entry.id)],
        files=[RecordingFile.model_validate(file) for file in files],
        diagnosis=None if diagnosis is None else Diagnosis.model_validate(diagnosis.document),
    )


def _store_upload(context: ApiContext, files: list[UploadFile]) -> StoredRecording:
    if len(files) > MAX_UPLOAD_FILES:
        raise _refused(f"expected at most {MAX_UPLOAD_FILES} files of one recording, found {len(files)}")
    names = [recording_name(file.filename or "") for file in files]
    suffixes = sorted(PurePosixPath(name).suffix.upper() for name in names)
    for name, suffix in zip(names, (PurePosixPath(name).suffix.upper() for name in names), strict=True):
        if suffix not in UPLOAD_SUFFIXES:
            raise _refused(f"{name[:100]!r}: expected a file ending in {', '.join(sorted(UPLOAD_SUFFIXES))}")
    if ".CFG" in suffixes and ".DAT" not in suffixes:
        raise _refused("expected the .DAT file that belongs to the .CFG file, found none")
    _require_one_record(names)
    try:
        with context.store.incoming() as incoming:
            for name, file in zip(names, files, strict=True):
                with incoming.create(name) as sink:
                    file.file.seek(0)
                    shutil.copyfileobj(file.file, sink)
            return incoming.keep()
    except RecordingStoreError as error:
        raise _refused(str(error)) from error


def _require_one_record(names: list[str]) -> None:
    """Raise ProblemError where a .CFG and a .DAT file are of different records, by their names."""
    parts = [name for name in names if PurePosixPath(name).suffix.upper() in (".CFG", ".DAT")]
    if len({PurePosixPath(name).stem.casefold() for name in parts}) > 1:
        found = " and ".join(repr(name[:100]) for name in sorted(parts))
        raise _refused(
            f"expected a .CFG and a .DAT file of one record, which have the same name, found {found}"
        )


def _refused(message: str) -> ProblemError:
    return WrongFieldError("body.files", message)
