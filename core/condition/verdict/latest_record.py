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
    state: State, verdict: Verdict, level: float | None, phase: str | None, *, is_later: bool
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
    if state is State.HEALTHY:
        return (
            f"{told}: one record cannot tell shorted turns from errors of its channels and of the motor's "
            "figures; the records together show no change, and no more than such errors leave"
        )
    return (
        f"{told}: one record cannot tell shorted turns from errors of its channels and of the motor's "
        f"figures; the records together are sure of no more than {state}"
    )
