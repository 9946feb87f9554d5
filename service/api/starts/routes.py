"""The starts of a motor."""

from dataclasses import asdict
from uuid import UUID

from fastapi import APIRouter

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.starts.schemas import StartDetails, StartSummary
from service.storage.records import StartEntry, StartReference

router = APIRouter(prefix="/motors/{name}/starts", tags=["motors"])


@router.get("", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_starts(
    context: Context, name: Name, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[StartSummary]:
    """Return the starts of a motor, latest first, each beside the reference."""
    found = context.repository.starts(name, limit=limit, after=decode(cursor, int, str))
    reference = context.repository.start_reference(name)
    counts = context.repository.starts_within_hour(found.items)
    return page(
        found,
        lambda entry: StartSummary.model_validate(_summary(entry, reference, counts[entry.recording_id])),
    )


@router.get("/{recording_id}", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_start(context: Context, name: Name, recording_id: UUID) -> StartDetails:
    """Return one start with its curves, and what the motor's model tells of it."""
    entry = context.repository.start(name, str(recording_id))
    reference = context.repository.start_reference(name)
    counts = context.repository.starts_within_hour([entry])
    return StartDetails.model_validate(
        _summary(entry, reference, counts[entry.recording_id])
        | entry.filled.model_as_dict()
        | {"curve": asdict(entry.start.curve)}
    )


def _summary(entry: StartEntry, reference: StartReference, within: int) -> dict[str, object]:
    filled = entry.filled
    start, torque, stress, sideband = filled.figures, filled.torque, filled.stress, filled.sideband
    changes = reference.compared([entry])
    return {
        "id": entry.recording_id,
        "source": entry.source,
        "recording_id": entry.recording,
        "time": entry.time_ns,
        "is_from_rest": start.is_from_rest,
        "is_reference": any(entry.recording_id == one.recording_id for one in reference.starts),
        "acceleration_s": start.acceleration_s,
        "peak_current_A": start.peak_current_A,
        "mean_current_A": start.mean_current_A,
        "crest_current_A": start.crest_current_A,
        "running_current_A": start.running_current_A,
        "lowest_voltage_V": start.lowest_voltage_V,
        "i2t_A2s": start.i2t_A2s,
        "i2t_over_s": start.i2t_over_s,
        "from_report": entry.from_report,
        "share_of_hot_limit": None if stress is None else stress.share_of_hot,
        "starts_within_hour": within,
        "starts_allowed": None if stress is None else stress.starts_per_hour,
        "mean_torque_Nm": None if torque is None else torque.mean_torque_Nm,
        "load_torque_Nm": None if torque is None else torque.load_torque_Nm,
        "load_torque_Nm_ci95": None if torque is None else torque.load_torque_Nm_ci95,
        "rotor_state": None if sideband is None else sideband.state,
        "comparison": None if changes is None else changes.as_dict(),
    }
