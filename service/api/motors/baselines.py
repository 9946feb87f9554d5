"""A motor's baseline: its own healthy recordings, whose standing asymmetry is taken off later ones."""

import time
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Query

from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name, Person, Reason
from service.api.motors.schemas import Baseline, BaselineRequest
from service.api.problems import problems

router = APIRouter(prefix="/motors/{name}/baseline", tags=["condition"])


@router.get("", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_baseline(context: Context, name: Name) -> Baseline:
    """Return the recordings of a motor's baseline, oldest first; none where it has no baseline."""
    return Baseline.model_validate(context.repository.baseline(name))


@router.put("", responses=problems(400, 404, 409, 413), dependencies=[require(Permission.CONFIGURE)])
def set_baseline(context: Context, name: Name, wanted: BaselineRequest, caller: By) -> Baseline:
    """Replace a motor's baseline by recordings known to be healthy, for diagnoses from now on.

    Recordings in doubt need a reason; it is kept with who asks, in a note of the motor too.
    """
    ids = sorted(str(one) for one in wanted.recording_ids)
    baseline = context.repository.set_baseline(
        name,
        ids,
        reason=wanted.reason,
        by=caller,
        on_behalf_of=wanted.on_behalf_of,
        now_ns=time.time_ns(),
    )
    return Baseline.model_validate(baseline)


@router.delete(
    "",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.CONFIGURE)],
)
def drop_baseline(
    context: Context,
    name: Name,
    caller: By,
    reason: Annotated[Reason | None, Query(description="Why; it is kept.")] = None,
    on_behalf_of: Annotated[
        Person | None, Query(description="Whom who asks does it for; it is kept beside their account.")
    ] = None,
) -> None:
    """Delete a motor's baseline; its recordings stay, and a note of the motor keeps who did so and why."""
    context.repository.delete_baseline(
        name, by=caller, reason=reason, on_behalf_of=on_behalf_of, now_ns=time.time_ns()
    )
