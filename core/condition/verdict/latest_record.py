"""Why a motor's condition is milder than what its latest record says by itself."""

from typing import Final

from core.condition.kinds import State
from core.diagnosis.verdict import Verdict

_RANK: Final = {
    State.HEALTHY: 0,
    Verdict.HEALTHY: 0,
    State.WATCH: 1,
    Verdict.WATCH: 1,
    State.FAULT: 2,
    Verdict.FAULT: 2,
}


def why_milder(
    state: State,
    verdict: Verdict,
    level: float | None,
    phase: str | None,
    *,
    is_later: bool,
    is_complete: bool,
    is_accepted: bool,
) -> str | None:
    """Say why a condition is milder than the verdict of the latest record.

    Parameters
    ----------
    state : State
        State of the motor.
    verdict : Verdict
        Verdict of the latest record by itself.
    level : float or None
        Fault level by that record, a fraction of the phase turns.
    phase : str or None
        Phase that it names.
    is_later : bool
        Whether that record is later than all that the condition rests on.
    is_complete : bool
        Whether the motor has records enough to be compared with.
    is_accepted : bool
        Whether a person has declared healthy what stands from the first record on.

    Returns
    -------
    str or None
        A reason in words; None where the condition is not milder, unknown, or the record not judged.
    """
    if state not in _RANK or verdict not in _RANK or _RANK[verdict] <= _RANK[state]:
        return None
    where = "" if phase is None else f" in phase {phase}"
    size = "" if level is None else f", {level:.2%}{where}"
    told = f"the latest record by itself says {verdict}{size}"
    if is_later:
        return f"{told}; it is not in the condition: it is yet to be taken into account, or was left out"
    if is_accepted:
        return (
            f"{told}: a person has declared healthy what the motor showed when its reference was restarted, "
            "so that only what has changed since counts"
        )
    if not is_complete:
        return f"{told}: one record is not enough, and there are too few yet to judge them together"
    if state is State.HEALTHY:
        return (
            f"{told}: one record cannot tell shorted turns from errors of its channels and of the motor's "
            "figures; the records together show no change, and no more than such errors leave"
        )
    return (
        f"{told}: one record cannot tell shorted turns from errors of its channels and of the motor's "
        f"figures; the records together are sure of no more than {state}"
    )
