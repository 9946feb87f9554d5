"""The answer of a motor: its condition, its rotor, its starts and what its latest records say, together.

The condition stays what raises alarms.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, log
from statistics import median
from types import MappingProxyType
from typing import Final

from core.classification.amplitude import rotor_block
from core.classification.classification import Classification, classify
from core.classification.evidence import Block, Evidence, Verdict, only, together
from core.classification.phases import SOUND, kind_words, phases_block
from core.classification.record_answer import RecordAnswer, latest_figure, median_beside
from core.condition.kinds import Kind, State
from core.diagnosis.causes import NOTHING, PRIORS, Cause
from core.rotor.finding import RotorState
from core.rotor.trend import RotorCondition
from core.starts.compared import StartCause, StartChanges
from core.tracking.finding import DriftCause, TrackedParameters, TrackingState

FROM_STARTS, FROM_TRACKING = 5.0, 4.0
"""Evidence of a cause of other starts, and of a drift of a parameter: each is beyond its 95 % interval."""
MOST_RECORDS: Final = 5
"""Latest records whose answers take part."""
MOST_LOADS: Final = 60
"""Latest records whose loads are compared."""
FEWEST_LOADS, LATEST_LOADS = 8, 3
"""Earlier records that a load is compared with at least, and latest ones that have to agree."""
LOAD_SCATTER, LOAD_CHANGE = 0.03, 0.3
"""Least scatter of a load from record to record, and usual size of a change; over rated torque."""
NORMAL_OVER_MEDIAN = 1.4826


@dataclass(frozen=True, slots=True)
class MotorEvidence:
    """All that is known of a motor.

    Parameters
    ----------
    state : State
        State of its condition.
    kind : Kind
        What the condition says has changed.
    candidates : tuple of Kind
        What an unclear kind may be.
    phase : str or None
        Phase of the change.
    rotor : RotorCondition
        The condition of its rotor.
    records : sequence of RecordAnswer
        Answers of its latest records, oldest first.
    load_levels : sequence of float
        Loads of its records over rated torque, oldest first.
    starts : StartChanges or None, optional
        How its latest start compares with the first ones.
    tracked : TrackedParameters or None, optional
        Parameters followed while it runs.
    """

    state: State
    kind: Kind
    candidates: tuple[Kind, ...]
    phase: str | None
    rotor: RotorCondition
    records: Sequence[RecordAnswer]
    load_levels: Sequence[float]
    starts: StartChanges | None = None
    tracked: TrackedParameters | None = None


def classify_motor(known: MotorEvidence) -> Classification:
    """Weigh the causes by all that is known of a motor.

    Parameters
    ----------
    known : MotorEvidence
        What is known of it.

    Returns
    -------
    Classification
        The answer.
    """
    blocks: list[Block | None] = [
        phases_block(
            known.state, known.kind, known.candidates, known.phase, known.rotor.state, known.records
        ),
        rotor_block(known.rotor.severity_dB, known.rotor.severity_dB_ci95),
        *(_of_records(known.records, cause) for cause in (Cause.PULSATION, Cause.ECCENTRICITY)),
        _load(known.load_levels),
        *_starts(known.starts),
        *_tracked(known.tracked, known.rotor.state),
    ]
    told = tuple(block for block in blocks if block is not None)
    causes = frozenset[Cause]().union(*(block.causes for block in told))
    untold = {cause: _why_untold(cause) for cause in PRIORS if cause not in causes}
    return classify(Evidence(told, untold, _verdicts(known)))


def _of_records(records: Sequence[RecordAnswer], cause: Cause) -> Block | None:
    found = median_beside(records, cause, NOTHING)
    return None if found is None else only(cause, found, latest_figure(records, cause))


def _load(levels: Sequence[float]) -> Block | None:
    """Return the evidence of a load that is another in the latest records than in those before."""
    before, now = levels[:-LATEST_LOADS], levels[-LATEST_LOADS:]
    if len(before) < FEWEST_LOADS:
        return None
    usual = median(before)
    scatter = hypot(LOAD_SCATTER, NORMAL_OVER_MEDIAN * median(abs(one - usual) for one in before))
    # Of the latest ones that count which has changed least: all of them have to agree.
    change = min((one - usual for one in now), key=abs)
    with_change = hypot(scatter, LOAD_CHANGE)
    ratio = (
        0.5 * change**2 * (scatter**-2.0 - with_change**-2.0) - log(with_change / scatter)
        if abs(change) > 2.0 * scatter
        else SOUND
    )
    figure = f"the load is {change:+.0%} of the rated torque beside the usual {usual:.0%} (+-{scatter:.0%})"
    return only(Cause.LOAD, ratio, figure)


def _starts(changes: StartChanges | None) -> list[Block]:
    if changes is None:
        return []
    told = {StartCause.LOAD: Cause.LOAD, StartCause.ROTOR: Cause.ROTOR}
    words = "; ".join(changes.reasons)
    return [only(told[one], FROM_STARTS, f"starts: {words}") for one in changes.causes if one in told]


def _tracked(tracked: TrackedParameters | None, rotor: RotorState) -> list[Block]:
    """Return the evidence of parameters that drift: each of its causes explains one drift, not one each."""
    if tracked is None or tracked.state is not TrackingState.DRIFTING:
        return []
    causes = frozenset[Cause]().union(*(_OF_DRIFTS.get(one, NOTHING) for one in tracked.causes))
    if Cause.PARAMETERS in causes and rotor is RotorState.FAULT:
        causes |= {Cause.ROTOR}  # a cage with broken bars has another impedance
    if not causes:
        return []
    words = f"parameters drift: {' or '.join(one.words for one in tracked.causes)}"
    share = FROM_TRACKING / len(tracked.causes)
    likelihood = {some: share for some in together(causes) if some}
    # What is said of a gap, and of a rotor that is a fault, is what was measured of them.
    told = {Cause.PARAMETERS} if rotor is RotorState.FAULT else {Cause.PARAMETERS, Cause.ROTOR}
    return [Block(causes, likelihood, dict.fromkeys(causes & told, words))]


_OF_DRIFTS: Final = MappingProxyType(
    {
        DriftCause.ROTOR: frozenset({Cause.ROTOR}),
        DriftCause.RATIO: frozenset({Cause.PARAMETERS}),
        DriftCause.LEAKAGE: frozenset({Cause.PARAMETERS}),
        # The mean permeance of a gap with static eccentricity d_s is higher by 1 / sqrt(1 - d_s^2).
        DriftCause.MAGNETISING: frozenset({Cause.PARAMETERS, Cause.ECCENTRICITY}),
    }
)
"""Causes of a motor that make its parameters drift; hot windings are none of them."""


def _verdicts(known: MotorEvidence) -> tuple[Verdict, ...]:
    """Return what condition and rotor say for sure; both raise alarms."""
    rotor, found = known.rotor, []
    if known.state is State.FAULT and known.kind is Kind.SHORTED_TURNS:
        words = f"fault, {kind_words(known.kind, known.candidates, known.phase)}"
        found.append(Verdict(Cause.SHORTED_TURNS, is_there=True, words=words))
    if known.state is State.HEALTHY:
        found.append(Verdict(Cause.SHORTED_TURNS, is_there=False, words="no shorted turns"))
    if rotor.state is RotorState.FAULT:
        found.append(Verdict(Cause.ROTOR, is_there=True, words="fault of the rotor"))
    if rotor.state is RotorState.HEALTHY:
        found.append(Verdict(Cause.ROTOR, is_there=False, words="an even rotor"))
    return tuple(found)


def _why_untold(cause: Cause) -> str:
    if cause is Cause.LOAD:
        return f"it takes {FEWEST_LOADS + LATEST_LOADS} records to see a load that changes"
    return "no record tells"
