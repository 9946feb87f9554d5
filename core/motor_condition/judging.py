"""What each part of a motor is judged by: its stator's condition, its rotor's, its starts, its parameters."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from core.classification.classification import Classification
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.condition.verdict.phase_words import kinds_in_words
from core.diagnosis.causes import Cause
from core.motor_condition.parts import Part, PartCondition
from core.motor_condition.supply import ADVICE as SUPPLY_ADVICE
from core.motor_condition.supply import SupplyCondition
from core.rotor.advice import rotor_advice
from core.rotor.finding import RotorState
from core.rotor.trend import RotorCondition
from core.starts.notable import HARD_STARTS_ADVICE, NotableChange, StartSeen, hard_starts
from core.terms import phrase
from core.tracking.advice import drift_advice, drift_reason
from core.tracking.finding import DriftCause, TrackedParameters, TrackingState

OF_CHANNELS: Final = (Kind.VOLTAGE_CHANNEL, Kind.CURRENT_CHANNEL)
NOT_ASSESSED: Final = "not assessed"
AIR_GAP_ADVICE: Final = (
    "Have the bearings and the alignment of the coupling checked at the next planned stop, and the air gap "
    "measured if the motor is opened."
)
_OF_KINDS: Final = {
    **dict.fromkeys((*OF_CHANNELS, Kind.OTHER_LOAD), Part.MEASUREMENT),
    Kind.SUPPLY: Part.SUPPLY,
    Kind.PARAMETERS: Part.PARAMETERS,
    Kind.ROTOR: Part.ROTOR,
}
"""Parts that a change of the stator's condition is of; that of all others is the stator."""
_OF_ROTOR: Final = {
    RotorState.HEALTHY: (State.HEALTHY, "even"),
    RotorState.WATCH: (State.WATCH, "possible rotor bar or end-ring defect"),
    RotorState.FAULT: (State.FAULT, "broken rotor bars or rings, or bad contacts of a wound rotor"),
    RotorState.UNSUPPORTED: (State.UNKNOWN, NOT_ASSESSED),
}
_OF_DRIFTS: Final = {
    DriftCause.WINDING_HOT: Part.THERMAL,
    DriftCause.RATIO: Part.MEASUREMENT,
}
"""Parts that a drift of parameters is of; that of all others is the parameters."""


def stator_parts(stator: Condition) -> tuple[PartCondition, ...]:
    """Return what the condition of the stator tells: of the stator, and of the part that has changed.

    Parameters
    ----------
    stator : Condition
        The condition of the stator, which tells changes of channels and of the supply as well.

    Returns
    -------
    tuple of PartCondition
        The stator, and the other part where the change is not of the stator.
    """
    if stator.state is State.UNKNOWN:
        return (PartCondition(Part.STATOR, State.UNKNOWN, NOT_ASSESSED, None, stator.advice, stator.reasons),)
    if stator.state is State.HEALTHY:
        return (PartCondition(Part.STATOR, State.HEALTHY, "no shorted turns", None, "", stator.reasons),)
    part = _OF_KINDS.get(stator.kind, Part.STATOR)
    found = PartCondition(
        part, stator.state, _finding(stator), stator.since_ns, stator.advice, stator.reasons
    )
    if part is Part.STATOR:
        return (found,)
    return PartCondition(Part.STATOR, State.HEALTHY, _hidden(stator)), found


def rotor_part(rotor: RotorCondition) -> PartCondition:
    """Return what is said of the rotor.

    Parameters
    ----------
    rotor : RotorCondition
        The condition that its records tell.

    Returns
    -------
    PartCondition
        The part.
    """
    state, finding = _OF_ROTOR[rotor.state]
    figures = [] if rotor.severity_dB is None else [f"rotor bar severity {rotor.severity_dB:.1f} dB"]
    if rotor.change_dB is not None:
        figures.append(f"{rotor.change_dB:+.1f} dB against the baseline of its load")
    todo = "" if state is State.HEALTHY else rotor_advice(rotor.state)
    since_ns = rotor.since_ns if state in (State.WATCH, State.FAULT) else None
    return PartCondition(Part.ROTOR, state, finding, since_ns, todo, (*figures, *rotor.reasons))


def parameters_part(tracked: TrackedParameters | None) -> PartCondition:
    """Return what is said of the parameters; of one cause alone, the part that it is of.

    Parameters
    ----------
    tracked : TrackedParameters or None
        What the records tell of them; None where none was followed yet.

    Returns
    -------
    PartCondition
        The part: parameters, windings that are too hot, or a transformer's ratio.
    """
    if tracked is None or tracked.state is TrackingState.UNDETERMINED:
        reasons = () if tracked is None else tracked.reasons
        return PartCondition(Part.PARAMETERS, State.UNKNOWN, NOT_ASSESSED, reasons=reasons)
    if tracked.state is TrackingState.STEADY:
        return PartCondition(Part.PARAMETERS, State.HEALTHY, "steady", reasons=tracked.reasons)
    parts = {_OF_DRIFTS.get(cause, Part.PARAMETERS) for cause in tracked.causes}
    part = parts.pop() if len(parts) == 1 else Part.PARAMETERS
    since = [one.since_ns for one in tracked.parameters if one.since_ns is not None]
    causes = " or ".join(cause.words for cause in tracked.causes)
    return PartCondition(
        part,
        State.WATCH,
        causes or "parameters of the motor drift",
        min(since, default=None),
        drift_advice(tracked.causes),
        (drift_reason(tracked), *tracked.reasons),
    )


def starts_part(
    latest: Sequence[StartSeen], change: NotableChange | None, since_ns: int | None
) -> PartCondition:
    """Return what is said of the starts.

    Parameters
    ----------
    latest : sequence of StartSeen
        The latest starts, latest first; none where none was recorded.
    change : NotableChange or None
        What has changed in them, against the first ones.
    since_ns : int or None
        When the first start was that shows the change, UTC [ns].

    Returns
    -------
    PartCondition
        The part.
    """
    if not latest:
        return PartCondition(Part.STARTS, State.UNKNOWN, NOT_ASSESSED, reasons=("no start was recorded",))
    hard = hard_starts(latest)
    findings, reasons, todo = [], [reason for one in hard for reason in one.reasons], []
    if hard:
        findings.append("hard starts")
        todo.append(HARD_STARTS_ADVICE)
    if change is not None:
        causes = " and ".join(one.words for one in change.causes) or "not told apart why"
        findings.append(f"starts are others than they were ({causes})")
        reasons += change.changes.reasons
        todo.append(change.advice)
    if not findings:
        return PartCondition(Part.STARTS, State.HEALTHY, "as before")
    times = [one.time_ns for one in hard] + ([] if since_ns is None else [since_ns])
    return PartCondition(
        Part.STARTS, State.WATCH, " and ".join(findings), min(times), " ".join(todo), tuple(reasons)
    )


def voltages_agree(stator: Condition) -> bool:
    """Return whether no voltage channel is known, or suspected, to be wrong.

    Parameters
    ----------
    stator : Condition
        The condition of the stator, which tells changes of channels.

    Returns
    -------
    bool
        Whether the unbalance of the voltages is the supply's.
    """
    return stator.state is State.HEALTHY or Kind.VOLTAGE_CHANNEL not in (stator.kind, *stator.candidates)


def supply_part(supply: SupplyCondition) -> PartCondition:
    """Return what is said of the supply.

    Parameters
    ----------
    supply : SupplyCondition
        The supply over the latest records.

    Returns
    -------
    PartCondition
        The part.
    """
    finding = " and ".join(supply.findings)
    if not finding:
        finding = NOT_ASSESSED if supply.state is State.UNKNOWN else "within its limits"
    return PartCondition(
        Part.SUPPLY, supply.state, finding, None, SUPPLY_ADVICE.get(supply.state, ""), supply.reasons
    )


def classified_parts(classification: Classification) -> tuple[PartCondition, ...]:
    """Return what the evidence tells of the air gap and of the load.

    A load that pulsates or changes is no state of the motor: it is named, and nothing follows.

    Parameters
    ----------
    classification : Classification
        The causes of all that is measured.

    Returns
    -------
    tuple of PartCondition
        Both parts.
    """
    known = {one.cause: one for one in classification.likelihoods if one.log_likelihood_ratio is not None}
    answer = classification.answer.causes if classification.is_told else frozenset()
    gap = known.get(Cause.ECCENTRICITY)
    swings = [known[cause] for cause in (Cause.PULSATION, Cause.LOAD) if cause in known]
    if gap is None:
        air_gap = PartCondition(Part.AIR_GAP, State.UNKNOWN, NOT_ASSESSED)
    elif Cause.ECCENTRICITY in answer:
        air_gap = PartCondition(
            Part.AIR_GAP, State.WATCH, "uneven air gap", None, AIR_GAP_ADVICE, (gap.figure,)
        )
    else:
        air_gap = PartCondition(Part.AIR_GAP, State.HEALTHY, "even", reasons=(gap.figure,))
    named = [one for one in swings if one.cause in answer]
    words = {Cause.PULSATION: "it pulsates", Cause.LOAD: "it is another than it was"}
    load = PartCondition(
        Part.LOAD,
        State.HEALTHY if swings else State.UNKNOWN,
        " and ".join(words[one.cause] for one in named) or ("steady" if swings else NOT_ASSESSED),
        reasons=tuple(one.figure for one in swings),
    )
    return air_gap, load


def merged(parts: Sequence[PartCondition]) -> tuple[PartCondition, ...]:
    """Return one condition of each part, in the order of `Part`, and what explains which.

    Parameters
    ----------
    parts : sequence of PartCondition
        What was judged; of one part by several figures, maybe.

    Returns
    -------
    tuple of PartCondition
        One of each part that was judged.
    """
    found: dict[Part, PartCondition] = {}
    for one in parts:
        before = found.get(one.part)
        found[one.part] = one if before is None else _worse(before, one)
    rotor = found.get(Part.ROTOR)
    # A cage with broken bars has more resistance and more leakage than a whole one.
    if rotor is not None and rotor.counts:
        parameters = found.get(Part.PARAMETERS)
        if parameters is not None and parameters.counts:
            found[Part.PARAMETERS] = replace(parameters, explained_by=Part.ROTOR)
    return tuple(found[part] for part in Part if part in found)


def _worse(one: PartCondition, other: PartCondition) -> PartCondition:
    """Return the worse of two findings of a part; with equal states, both."""
    first, second = (one, other) if _need(one) >= _need(other) else (other, one)
    if not (first.counts and second.counts):
        return first
    times = [each.since_ns for each in (first, second) if each.since_ns is not None]
    return replace(
        first,
        finding=f"{first.finding}; {second.finding}",
        since_ns=min(times, default=None),
        advice=" ".join(dict.fromkeys((first.advice, second.advice))),
        reasons=(*first.reasons, *second.reasons),
    )


def _need(part: PartCondition) -> int:
    return (State.UNKNOWN, State.HEALTHY, State.WATCH, State.FAULT).index(part.state)


def _finding(stator: Condition) -> str:
    """Return what has changed, with its phase."""
    if stator.kind is Kind.NONE:
        return "an asymmetry that its sensors do not explain"
    if stator.kind is Kind.UNCLEAR and not stator.candidates:
        return "a change that another record has to confirm"
    kinds = stator.candidates if stator.kind is Kind.UNCLEAR else (stator.kind,)
    words = kinds_in_words(kinds, stator.phase, stator.phase_probabilities, phrase)
    return words if stator.phase is None else f"{words} in phase {stator.phase}"


def _hidden(stator: Condition) -> str:
    """Return what a finding of another part hides of the stator."""
    if stator.mu_f_ci95 is None:
        return "no shorted turns are seen beside it"
    return f"no shorted turns are seen; beside it, {stator.mu_f_ci95[1]:.2%} of the turns would not be"
