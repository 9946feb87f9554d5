"""From what the database keeps of a motor's condition to the document of the API."""

from core.condition import condition as conditions
from core.condition.advice import advice
from core.condition.kinds import Kind, State
from service.api.condition_schemas import Condition, ConditionReference, Forecast
from service.storage.records import ConditionEntry

NOT_JUDGED = "no valid record of the motor has been judged yet"

NO_REFERENCE = ConditionReference(
    records=0,
    complete=False,
    standing=None,
    standing_deviation=None,
    standing_phase=None,
    standing_path_ratio=None,
    standing_score=None,
    detectable=None,
    since=None,
    from_bus=False,
)


def condition_document(entry: ConditionEntry, now_ns: int, stale_after_ns: int) -> Condition:
    """Return a motor's condition as it is seen now: a condition gets stale without any record."""
    if entry.document is None:
        return _unknown(entry.motor)
    condition = conditions.Condition.from_dict(entry.document).seen_at(now_ns, stale_after_ns)
    document = condition.as_dict()
    if condition.reference is None:
        document["reference"] = NO_REFERENCE
    return Condition.model_validate(document)


def _unknown(motor: str) -> Condition:
    return Condition(
        motor=motor,
        state=State.UNKNOWN,
        kind=Kind.NONE,
        candidates=[],
        phase=None,
        mu_f=None,
        mu_f_ci95=None,
        change=None,
        change_ci95=None,
        size=None,
        since=None,
        growth_per_day=None,
        forecast=Forecast(limit=None, days=None),
        reference=NO_REFERENCE,
        as_of=None,
        stale=True,
        advice=advice(State.UNKNOWN, Kind.NONE),
        reasons=[NOT_JUDGED],
    )
