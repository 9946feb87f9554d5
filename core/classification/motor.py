"""The answer of a motor: its condition, its rotor, its starts and what its latest records say, together.

The condition knows changes of the phases far better than single records do, so that its kinds take the place
of what records say of shorted turns, joints and channels. It stays what raises alarms.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import hypot, log
from statistics import median
from types import MappingProxyType
from typing import Final

from core.classification.amplitude import rotor_block
from core.classification.causes import PRIORS, Cause, Causes
from core.classification.classification import Classification, classify
from core.classification.evidence import Block, Evidence, Verdict, only, together
from core.condition.kinds import Kind, State
from core.rotor.finding import RotorState
from core.rotor.trend import RotorCondition
from core.starts.compared import StartCause, StartChanges
from core.terms import phrase
from core.tracking.finding import DriftCause, TrackedParameters, TrackingState

OF_KINDS: Final = MappingProxyType(
    {
        Kind.SHORTED_TURNS: Cause.SHORTED_TURNS,
        Kind.VOLTAGE_CHANNEL: Cause.VOLTAGE_CHANNEL,
        Kind.CURRENT_CHANNEL: Cause.CURRENT_CHANNEL,
        Kind.CONNECTION: Cause.CONNECTION,
        Kind.SUPPLY: Cause.SUPPLY,
        Kind.PARAMETERS: Cause.PARAMETERS,
        Kind.ROTOR: Cause.ROTOR,
    }
)
NAMED, CANDIDATE, SOUND = 8.0, 6.0, -3.0
"""Evidence of the condition: for the kind that it names, which takes a probability of 0.98; for each of
several candidates; and against what it would have seen."""
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
class RecordAnswer:
    """What the answer of one record keeps for that of its motor.

    Parameters
    ----------
    log_likelihood_ratios : mapping of Cause to float
        Of each cause alone; those that the record tells [nats].
    figures : mapping of Cause to str
        What was measured of each, in words.
    """

    log_likelihood_ratios: Mapping[Cause, float]
    figures: Mapping[Cause, str]

    @classmethod
    def from_dict(cls, document: Mapping[str, object]) -> "RecordAnswer":
        """Return what the document of a record's answer keeps.

        Parameters
        ----------
        document : mapping
            What `Classification.as_dict` returned.

        Returns
        -------
        RecordAnswer
            What it keeps.

        Raises
        ------
        KeyError, TypeError, ValueError
            If it is no such document.
        """
        likelihoods = document["likelihoods"]
        if not isinstance(likelihoods, list):
            raise TypeError(f"likelihoods: expected a list, found {type(likelihoods).__name__}")
        told = [one for one in likelihoods if one["log_likelihood_ratio"] is not None]
        return cls(
            {Cause(one["cause"]): float(one["log_likelihood_ratio"]) for one in told},
            {Cause(one["cause"]): str(one["figure"]) for one in told},
        )


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
        _phases(known),
        rotor_block(known.rotor.severity_dB, known.rotor.severity_dB_ci95),
        *(_of_records(known.records, cause) for cause in (Cause.PULSATION, Cause.ECCENTRICITY)),
        _load(known.load_levels),
        *_starts(known.starts),
        *_tracked(known.tracked),
    ]
    told = tuple(block for block in blocks if block is not None)
    causes = frozenset[Cause]().union(*(block.causes for block in told))
    untold = {cause: _why_untold(cause) for cause in PRIORS if cause not in causes}
    return classify(Evidence(told, untold, _verdicts(known)))


def _phases(known: MotorEvidence) -> Block | None:
    """Return the evidence of unlike phases, from the condition or, where it names nothing, the records."""
    if known.state is State.UNKNOWN:
        return None
    named = known.candidates if known.kind is Kind.UNCLEAR else (known.kind,)
    said = f"the condition is {known.state}, {_kind_words(known)}"
    suspected = frozenset(OF_KINDS[kind] for kind in named if kind in OF_KINDS)
    ratios: dict[Cause, float] = {}
    figures: dict[Cause, str] = {}
    for cause in OF_KINDS.values():
        of_records = _median(known.records, cause)
        if cause in suspected:
            ratios[cause] = NAMED if len(suspected) == 1 else CANDIDATE
            figures[cause] = said
        elif cause in (Cause.SHORTED_TURNS, Cause.CONNECTION) or (suspected and cause in _OF_CHANGES):
            ratios[cause] = SOUND if known.kind is not Kind.UNCLEAR or suspected else 0.0
            figures[cause] = said
        elif cause is not Cause.ROTOR and of_records is not None:
            ratio, figures[cause] = of_records
            ratios[cause] = _beyond(ratio, known.records, suspected)
    likelihood = {some: _joined(some, ratios, suspected) for some in together(ratios) if some}
    return Block(frozenset(ratios), likelihood, figures)


_OF_CHANGES: Final = frozenset(
    {Cause.SHORTED_TURNS, Cause.CONNECTION, Cause.VOLTAGE_CHANNEL, Cause.CURRENT_CHANNEL}
)


def _beyond(ratio: float, records: Sequence[RecordAnswer], suspected: Causes) -> float:
    """Return what records say of a cause beyond what a change explains that the condition sees.

    Each cause is weighed alone in a record, so that shorted turns, say, speak for wrong parameters as well.
    """
    found = [_median(records, cause) for cause in suspected]
    explained = max((one[0] for one in found if one is not None), default=0.0)
    return max(ratio - max(explained, 0.0), min(ratio, 0.0))


def _joined(causes: Causes, ratios: Mapping[Cause, float], suspected: Causes) -> float:
    """Return the evidence for causes together: candidates explain one change, not one each."""
    of_one_change = [ratios[cause] for cause in causes & suspected]
    return max(of_one_change, default=0.0) + sum(ratios[cause] for cause in causes - suspected)


def _kind_words(known: MotorEvidence) -> str:
    if known.kind is Kind.NONE:
        return "nothing has changed"
    where = "" if known.phase is None else f" {known.phase}"
    if known.kind is Kind.UNCLEAR and known.candidates:
        return " or ".join(phrase(kind) for kind in known.candidates) + where
    return phrase(known.kind) + where


def _of_records(records: Sequence[RecordAnswer], cause: Cause) -> Block | None:
    found = _median(records, cause)
    return None if found is None else only(cause, *found)


def _median(records: Sequence[RecordAnswer], cause: Cause) -> tuple[float, str] | None:
    """Return the median evidence of the records that tell of a cause, and the latest figure.

    Records of one motor share its errors, so that more of them make a figure steadier, but not surer.
    """
    telling = [one for one in records if cause in one.log_likelihood_ratios]
    if not telling:
        return None
    ratio = median(one.log_likelihood_ratios[cause] for one in telling)
    return ratio, telling[-1].figures.get(cause, "")


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


def _tracked(tracked: TrackedParameters | None) -> list[Block]:
    if tracked is None or tracked.state is not TrackingState.DRIFTING:
        return []
    words = f"parameters drift: {' or '.join(one.words for one in tracked.causes)}"
    found = []
    if DriftCause.ROTOR in tracked.causes:
        found.append(only(Cause.ROTOR, FROM_TRACKING / len(tracked.causes), words))
    share = FROM_TRACKING / len(tracked.causes)
    if DriftCause.MAGNETISING in tracked.causes:
        found.append(_of_gap(share, words))
    elif set(tracked.causes) & {DriftCause.RATIO, DriftCause.LEAKAGE}:
        found.append(only(Cause.PARAMETERS, share, words))
    return found


def _of_gap(ratio: float, words: str) -> Block:
    """Return the evidence of another magnetising inductance, which an eccentric rotor has as well.

    The mean permeance of a gap with static eccentricity d_s is higher by 1 / sqrt(1 - d_s^2).
    """
    causes = frozenset({Cause.PARAMETERS, Cause.ECCENTRICITY})
    likelihood = {some: ratio for some in together(causes) if some}
    return Block(causes, likelihood, {Cause.PARAMETERS: words})


def _verdicts(known: MotorEvidence) -> tuple[Verdict, ...]:
    """Return what condition and rotor say for sure; both raise alarms."""
    rotor, found = known.rotor, []
    if known.state is State.FAULT and known.kind is Kind.SHORTED_TURNS:
        words = f"fault, {_kind_words(known)}"
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
