"""Evidence of unlike phases: what the condition of a motor says of a change, and what records say besides.

The condition knows changes of the phases far better than single records do, so that its kinds take the place
of what records say of shorted turns, joints and channels. It does not always tell one kind: then its
candidates together are as sure as one, and records say which of them is likelier. Of all other causes counts
what records say of them beside that change.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from math import log
from statistics import median
from types import MappingProxyType
from typing import Final

from core.classification.evidence import Block, log_sum, together
from core.classification.record_answer import RecordAnswer, latest_figure, median_beside
from core.condition.kinds import Kind, State
from core.diagnosis.causes import Cause, Causes
from core.rotor.finding import RotorState
from core.terms import phrase

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
NAMED, WATCHED, SOUND = 8.0, 6.0, -3.0
"""Evidence of the condition: for the kind that it names, or for all candidates of a fault together, which
take a probability of 0.97; for each candidate of what it only watches, which six sound motors in a thousand
have as well; and against what it would have seen."""
OF_CHANGES: Final = frozenset(
    {Cause.SHORTED_TURNS, Cause.CONNECTION, Cause.VOLTAGE_CHANNEL, Cause.CURRENT_CHANNEL}
)
"""Causes that the condition tells better than records do, where it sees a change."""
BY_CONDITION: Final = frozenset({Cause.SHORTED_TURNS, Cause.CONNECTION})
"""Causes that the condition tells better also where it sees none."""


def phases_block(
    state: State,
    kind: Kind,
    candidates: Sequence[Kind],
    phase: str | None,
    rotor: RotorState,
    records: Sequence[RecordAnswer],
) -> Block | None:
    """Return the evidence of unlike phases, from the condition and, of what it does not name, the records."""
    if state is State.UNKNOWN:
        return None
    changes = _changes(kind, candidates, rotor)
    # A record that surprises, and no more is known yet: then the records alone tell.
    is_silent = kind is Kind.UNCLEAR and not changes
    said = f"the condition is {state}, {kind_words(kind, candidates, phase)}"
    ratios: dict[Cause, float] = _of_changes(state, changes, records)
    figures = dict.fromkeys(ratios, said)
    of_records: set[Cause] = set()
    for cause in OF_KINDS.values():
        if cause in changes or cause is Cause.ROTOR:
            continue
        found = median_beside(records, cause, changes)
        if not is_silent and (cause in BY_CONDITION or (changes and cause in OF_CHANGES)):
            ratios[cause], figures[cause] = SOUND, said
        elif found is not None:
            ratios[cause], figures[cause] = found, latest_figure(records, cause)
            of_records.add(cause)
        elif cause in BY_CONDITION:
            ratios[cause], figures[cause] = 0.0, said
    likelihood = {some: _joined(some, ratios, changes) for some in together(ratios) if some}
    if not changes:  # two causes of records may explain the same
        likelihood |= _pairs(records, of_records)
    return Block(frozenset(ratios), likelihood, figures)


def kind_words(kind: Kind, candidates: Sequence[Kind], phase: str | None) -> str:
    """Return what the condition says has changed, in words."""
    if kind is Kind.NONE:
        return "nothing has changed"
    where = "" if phase is None else f" {phase}"
    if kind is Kind.UNCLEAR and candidates:
        return " or ".join(phrase(one) for one in candidates) + where
    return phrase(kind) + where


def _changes(kind: Kind, candidates: Sequence[Kind], rotor: RotorState) -> Causes:
    """Return the causes of which one is the change that the condition sees.

    A cage with broken bars has another impedance than the whole one: more resistance, and more leakage where
    the current goes around the bars. So a rotor that is a fault is the cause of another impedance.
    """
    named = candidates if kind is Kind.UNCLEAR else (kind,)
    changes = frozenset(OF_KINDS[one] for one in named if one in OF_KINDS)
    if rotor is RotorState.FAULT and Cause.PARAMETERS in changes:
        changes = changes - {Cause.PARAMETERS} | {Cause.ROTOR}
    return changes


def _of_changes(state: State, changes: Causes, records: Sequence[RecordAnswer]) -> dict[Cause, float]:
    """Return the evidence of each cause that may be the change.

    The condition has seen the change as surely as where it names it. How the candidates share that evidence
    the records say, or they share it alike where a record tells nothing of one.
    """
    count = len(changes)
    if count < 2:
        return dict.fromkeys(changes, NAMED)
    whole = NAMED if state is State.FAULT else WATCHED + log(count)
    shown = sorted(changes - {Cause.ROTOR})  # a rotor leaves the phases alike
    ratios = [one.log_likelihood_ratios for one in records if one.log_likelihood_ratios.keys() >= set(shown)]
    if not ratios:
        return dict.fromkeys(changes, whole - log(count))
    of_phases = [{Cause.ROTOR: 0.0} | {cause: found[cause] for cause in shown} for found in ratios]
    shares = {
        cause: median(found[cause] - log_sum([found[one] for one in sorted(changes)]) for found in of_phases)
        for cause in changes
    }
    total = log_sum(list(shares.values()))
    return {cause: whole + share - total for cause, share in shares.items()}


def _joined(causes: Causes, ratios: Mapping[Cause, float], changes: Causes) -> float:
    """Return the evidence for causes together: candidates explain one change, not one each."""
    of_one_change = max((ratios[cause] for cause in causes & changes), default=0.0)
    return of_one_change + sum(ratios[cause] for cause in causes - changes)


def _pairs(records: Sequence[RecordAnswer], causes: Iterable[Cause]) -> dict[Causes, float]:
    """Return the median of what records tell of each two of some causes together."""
    found: dict[Causes, list[float]] = {}
    for record in records:
        told = sorted(record.log_likelihood_ratios.keys() & set(causes))
        for one, other in combinations(told, 2):
            found.setdefault(frozenset({one, other}), []).append(record.of_both(one, other))
    return {pair: median(ratios) for pair, ratios in found.items()}
