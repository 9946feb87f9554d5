"""From what the database keeps of a motor's condition to the document of the API."""

from collections.abc import Mapping

from core.condition.kinds import Kind, State
from core.condition.verdict.advice import advice
from core.condition.verdict.latest_record import why_milder
from core.machines.parameters import ParametersSource
from core.machines.typical import TYPICAL_REASON
from core.motor_condition.condition import Urgency
from core.motor_condition.parts import Part
from service.api.conditions.schemas import Condition, ConditionReference, UntilStop
from service.condition.planned_stop import until_planned_stop
from service.condition.staleness import is_stale
from service.storage import Repository
from service.storage.records import ConditionEntry, LatestDiagnosis

NOT_JUDGED = "no valid record of the motor has been judged yet"

NOT_FOLDED = (
    "what came after the latest record is not taken into account: {}; it is tried again with the next record,"
    " with another diagnosis, and when the service starts"
)

_NO_REFERENCE: Mapping[str, object] = {
    **dict.fromkeys(ConditionReference.model_fields),
    "records": 0,
    "complete": False,
    "from_bus": False,
    "accepted": False,
}
_NOTHING: Mapping[str, object] = {
    **dict.fromkeys(Condition.model_fields),
    "state": State.UNKNOWN,
    "kind": Kind.NONE,
    "candidates": [],
    "forecast": {"limit": None, "days": None, "chances": None},
    "finding": "",
    "urgency": Urgency.NONE,
    "causes": [],
    "parts": [],
    "reference": {},
    "advice": advice(State.UNKNOWN, Kind.NONE),
    "reasons": [NOT_JUDGED],
}
_OF_TYPICAL: Mapping[str, object] = {
    **_NOTHING,
    "advice": advice(State.UNKNOWN, Kind.NONE, is_typical=True),
    "reasons": [TYPICAL_REASON, NOT_JUDGED],
}


def condition_document(
    entry: ConditionEntry,
    now_ns: int,
    stale_after_ns: int,
    latest: LatestDiagnosis | None = None,
    *,
    source: ParametersSource,
) -> Condition:
    """Return a motor's condition as it is seen now: a condition gets stale without any record.

    latest: of the motor's records. Where the condition is milder, a reason says why.
    source: where the motor's parameters come from.
    """
    nothing = _OF_TYPICAL if source is ParametersSource.TYPICAL else _NOTHING
    document = {**nothing, **(entry.document or {})}
    reference = document["reference"]
    known = reference if isinstance(reference, Mapping) else {}
    stale = is_stale(entry, now_ns, stale_after_ns)
    told = document["reasons"]
    reasons = told if isinstance(told, list) and entry.document is not None else []
    milder = None if latest is None else _why_milder(entry, latest, {**_NO_REFERENCE, **known})
    if entry.problem is not None:
        document["reasons"] = [NOT_FOLDED.format(entry.problem), *reasons]
    elif milder is not None:
        document["reasons"] = [milder, *reasons]
    return Condition.model_validate(
        {**document, "motor": entry.motor, "stale": stale, "reference": {**_NO_REFERENCE, **known}}
    )


def until_stop_document(
    repository: Repository, entry: ConditionEntry, now_ns: int, oldest_ns: int
) -> UntilStop | None:
    """Return whether a motor holds until its planned stop; None where none is ahead. Raises NotFoundError."""
    stop = repository.planned_stop(entry.motor, now_ns=now_ns)
    if stop is None:
        return None
    answer = until_planned_stop(repository, entry, stop, now_ns=now_ns, oldest_ns=oldest_ns)
    return UntilStop.model_validate({**answer.as_dict(), "of": stop.of})


def _why_milder(
    entry: ConditionEntry, latest: LatestDiagnosis, reference: Mapping[str, object]
) -> str | None:
    return why_milder(
        entry.state_of(Part.STATOR),
        latest.verdict,
        latest.mu_f,
        latest.phase,
        is_later=entry.as_of_ns is None or latest.recorded_ns > entry.as_of_ns,
        is_complete=bool(reference["complete"]),
        is_accepted=bool(reference["accepted"]),
    )
