"""Diagnoses of a recording: those made, and asking for another."""

import time
from http import HTTPStatus
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Query, Request, Response

from core.diagnosis.methods import resolved
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.context import ApiContext, Context, path_to
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.recordings.diagnosis_schemas import Diagnosis, DiagnosisRequest, DiagnosisRun
from service.storage.records import Actor, Job, JobResult

MOST_DIAGNOSES = 100
"""Most items of a page: each may have a result of some kilobytes."""

router = APIRouter(prefix="/recordings/{recording_id}/diagnoses", tags=["recordings"])


@router.post(
    "",
    status_code=HTTPStatus.ACCEPTED,
    responses=problems(400, 404, 409, 413, 429)
    | {202: {"headers": {"Location": {"schema": {"type": "string"}, "description": "The diagnosis."}}}},
    dependencies=[require(Permission.RECORDINGS)],
)
def request_diagnosis(
    context: Context,
    request: Request,
    response: Response,
    recording_id: UUID,
    caller: By,
    wanted: DiagnosisRequest | None = None,
) -> DiagnosisRun:
    """Queue another diagnosis of a stored recording; when done, it takes the place of the earlier one."""
    job = queue_diagnosis(context, caller, str(recording_id), wanted or DiagnosisRequest())
    path = path_to(request, "get_diagnosis", recording_id=recording_id, diagnosis_id=job.id)
    response.headers["Location"] = path
    return DiagnosisRun.model_validate(job)


def queue_diagnosis(context: ApiContext, by: Actor, recording_id: str, wanted: DiagnosisRequest) -> Job:
    """Queue another diagnosis and wake the runner. Raises NotFoundError, TooManyWaitingError."""
    method, model = resolved(wanted.method, wanted.model)
    job = context.repository.request_diagnosis(
        recording_id,
        by=by,
        method=method,
        model=model,
        now_ns=time.time_ns(),
        most_queued=context.settings.max_queued_diagnoses,
    )
    context.on_new_job()
    return job


@router.get("", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_diagnoses(
    context: Context,
    recording_id: UUID,
    limit: Annotated[Limit, Query(le=MOST_DIAGNOSES)] = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[DiagnosisRun]:
    """Return the diagnoses of a recording, latest first."""
    jobs = context.repository.jobs(str(recording_id), limit=limit, after=decode(cursor, int, str))
    return page(jobs, _run)


@router.get("/{diagnosis_id}", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_diagnosis(context: Context, recording_id: UUID, diagnosis_id: UUID) -> DiagnosisRun:
    """Return one diagnosis of a recording."""
    return _run(context.repository.job(str(recording_id), str(diagnosis_id)))


def _run(found: JobResult) -> DiagnosisRun:
    run = DiagnosisRun.model_validate(found.job)
    if found.diagnosis is None:
        return run
    return run.model_copy(update={"result": Diagnosis.model_validate(found.diagnosis.document)})
