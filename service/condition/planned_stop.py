"""Whether a motor holds until its planned stop, from what the database keeps of it."""

from collections.abc import Mapping
from typing import Any, Final

from core.condition.forecast.outcome import Forecast
from core.condition.kinds import State
from core.motor_condition.parts import Part, PartCondition, parts_of
from core.motor_condition.until_stop import UntilStop, until_stop
from service.condition.staleness import is_stale
from service.storage import Repository
from service.storage.records import ConditionEntry, PlannedStop

MOST_RECORDS: Final = 200
"""Latest records from which the growth of a rotor's asymmetry is taken."""


def until_planned_stop(
    repository: Repository, entry: ConditionEntry, stop: PlannedStop, *, now_ns: int, oldest_ns: int
) -> UntilStop:
    """Return whether a motor holds until its planned stop. Raises NotFoundError.

    oldest_ns: age beyond which its latest record is too old.
    """
    parts, forecasts, as_of_ns = parts_of(entry.document), {}, {}
    if entry.document is not None and entry.as_of_ns is not None:
        forecasts[Part.STATOR], as_of_ns[Part.STATOR] = _of_stator(entry.document), entry.as_of_ns
    rotor = _of_rotor(repository, entry.motor, parts)
    if rotor is not None:
        forecasts[Part.ROTOR], as_of_ns[Part.ROTOR] = rotor
    return until_stop(
        stop.time_ns,
        parts,
        forecasts,
        as_of_ns=as_of_ns,
        stale=is_stale(entry, now_ns, oldest_ns),
        fault_level=_fault_level(repository, entry.motor),
    )


def _of_stator(document: Mapping[str, Any]) -> Forecast:
    forecast = document["forecast"]
    chances = forecast.get("chances")
    return Forecast(forecast["limit"], chances=None if chances is None else tuple(chances))


def _of_rotor(
    repository: Repository, motor: str, parts: tuple[PartCondition, ...]
) -> tuple[Forecast, int] | None:
    """Return the forecast of a rotor on watch, and the time of its latest record."""
    if not any(one.part is Part.ROTOR and one.state is State.WATCH for one in parts):
        return None
    from core.motor_condition.rotor_forecast import rotor_forecast  # numbers, where they are needed

    told = [
        (one.time_ns, one.finding.severity_dB)
        for one in repository.latest_rotor_findings(motor, limit=MOST_RECORDS)
        if one.finding.severity_dB is not None
    ]
    if not told:
        return None
    condition = repository.rotor_condition(motor)
    baselines = [one.baseline_dB for one in condition.bins if one.baseline_dB is not None]
    return rotor_forecast(told, condition.since_ns, baselines), told[-1][0]


def _fault_level(repository: Repository, motor: str) -> float | None:
    """Return the limit that the motors file says at last; None of a motor that it never had."""
    versions = repository.motor_versions(motor)
    if not versions:
        return None
    document: Mapping[str, Any] = versions[-1].document
    return float(document["limits"]["fault_level"])
