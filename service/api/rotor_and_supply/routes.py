"""What the recordings of a motor show of its rotor, its air gap and load, and its supply, over time."""

from fastapi import APIRouter

from core.rotor.advice import rotor_advice
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.rotor_and_supply.schemas import (
    RotorCondition,
    RotorTrendPoint,
    SupplyTrendPoint,
    SwingTrendPoint,
)
from service.api.rotor_and_supply.start_agreement import StartAgreement, start_agreement
from service.api.times import From, To
from service.storage.records import RotorEntry, SupplyEntry, SwingEntry

router = APIRouter(prefix="/motors/{name}", tags=["condition"])


@router.get("/rotor", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_rotor(context: Context, name: Name) -> RotorCondition:
    """Return the condition of a motor's rotor, from all its recordings."""
    condition = context.repository.rotor_condition(name)
    return RotorCondition.model_validate(
        {
            **condition.as_dict(),
            "motor": name,
            "since": condition.since_ns,
            "start": _of_start(start_agreement(context.repository, name)),
            "advice": rotor_advice(condition.state),
        }
    )


@router.get("/rotor/trend", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_rotor_trend(
    context: Context,
    name: Name,
    from_: From = None,
    to: To = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[RotorTrendPoint]:
    """Return what each recording of a motor shows of its rotor, oldest first."""
    after = decode(cursor, int, str)
    found = context.repository.rotor_trend(name, from_ns=from_, to_ns=to, limit=limit, after=after)
    return page(found, _rotor_point)


@router.get("/swings/trend", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_swing_trend(
    context: Context,
    name: Name,
    from_: From = None,
    to: To = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[SwingTrendPoint]:
    """Return what each recording of a motor shows of its air gap and of a load that swings, oldest first."""
    after = decode(cursor, int, str)
    found = context.repository.swing_trend(name, from_ns=from_, to_ns=to, limit=limit, after=after)
    return page(found, _swing_point)


@router.get("/supply/trend", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_supply_trend(
    context: Context,
    name: Name,
    from_: From = None,
    to: To = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[SupplyTrendPoint]:
    """Return what each recording of a motor shows of its supply, oldest first."""
    after = decode(cursor, int, str)
    found = context.repository.supply_trend(name, from_ns=from_, to_ns=to, limit=limit, after=after)
    return page(found, _supply_point)


def _of_start(found: StartAgreement | None) -> dict[str, object] | None:
    if found is None:
        return None
    return {
        "recording_id": found.start.recording_id,
        "time": found.start.time_ns,
        "state": found.sideband.state,
        "severity_dB": found.sideband.severity_dB,
        "agrees": found.agrees,
        "words": found.words,
    }


def _rotor_point(entry: RotorEntry) -> RotorTrendPoint:
    return RotorTrendPoint.model_validate(
        {**entry.finding.as_dict(), "time": entry.time_ns, "recording_id": entry.recording_id}
    )


def _swing_point(entry: SwingEntry) -> SwingTrendPoint:
    return SwingTrendPoint.model_validate(
        {
            "time": entry.time_ns,
            "recording_id": entry.recording_id,
            "eccentricity": entry.eccentricity.as_dict(),
            "pulsation": entry.pulsation.as_dict(),
        }
    )


def _supply_point(entry: SupplyEntry) -> SupplyTrendPoint:
    return SupplyTrendPoint.model_validate(
        {**entry.figures.as_dict(), "time": entry.time_ns, "recording_id": entry.recording_id}
    )
