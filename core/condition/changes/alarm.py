"""A change that the detector has raised, and its name."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from core.condition.assessment import Change
from core.condition.changes.hypotheses import CAUSES, FREE, Cause, Hypotheses
from core.condition.changes.naming import name, probabilities
from core.condition.changes.vanishing import Vanishing
from core.condition.kinds import Kind
from core.machines.base import Array

CERTAIN: Final = 0.98
"""Posterior probability at which a cause is named."""
RATHER: Final = 0.9
"""The same of shorted turns beside an asymmetry of unknown cause: nothing shows that for sure, and its weight
is no more than a guess."""
DOUBTFUL: Final = 0.5
"""Posterior probability below which what is no defect is named no longer."""
UNLIKELY_ELEMENT: Final = 0.06
"""Probability of an element behind the relay up to which it takes no name from shorted turns, for the same
reason."""
RUNNING: Final = 3
"""Records in a row that have to agree on it."""
SPACED: Final = 8
SELDOM: Final = 32
SETTLED: Final = 64
"""Records after the alarm from which a name is final, and what is no shorted turns is lived with."""
WINDOW: Final = 256
"""Records after the alarm within which a cause is named."""

KINDS: Final[Mapping[Cause, Kind]] = {
    Cause.SHORTED_TURNS: Kind.SHORTED_TURNS,
    Cause.VOLTAGE_CHANNEL: Kind.VOLTAGE_CHANNEL,
    Cause.CURRENT_CHANNEL: Kind.CURRENT_CHANNEL,
    Cause.JOINT: Kind.CONNECTION,
    Cause.IMPEDANCE: Kind.PARAMETERS,
    Cause.ASYMMETRY: Kind.ASYMMETRY,
    Cause.ELEMENT: Kind.OTHER_LOAD,
    Cause.OTHER_LOAD: Kind.OTHER_LOAD,
}
"""What each cause is told as; another recorder changes voltage and current channels."""

DEFECTS: Final = frozenset((Kind.SHORTED_TURNS, Kind.CONNECTION))
"""Defects of the motor itself and of its joints."""

Names = tuple[Kind, ...]


@dataclass(slots=True)
class Alarm:
    """A change that the detector has raised.

    Parameters
    ----------
    detected_ns : int
        Time of the record with which it was raised, UTC [ns].
    records : int
        Number of records since then.
    named : tuple of Kind
        Kinds that are certain.
    pending : tuple of Kind
        Kinds that the latest records are sure of.
    running : int
        Number of such records in a row.
    surely_above : float
        What the level lay above for certain, once, while it was named as shorted turns. It is looked at until
        it exceeds the motor's limit.
    vanishing : Vanishing or None
        Whether shorted turns that were named have vanished; None while none were.
    worked_on : bool
        Whether a person has told since of works that may have mended them.
    alone : Change or None
        The change before a second one was suspected beside it; None while it has no name, or is shorted
        turns.
    errors : list of float
        E and C with the change in them at that time.
    """

    detected_ns: int
    records: int = 0
    named: Names = ()
    pending: Names = ()
    running: int = 0
    surely_above: float = 0.0
    vanishing: Vanishing | None = None
    worked_on: bool = False
    alone: Change | None = None
    errors: list[float] = field(default_factory=list)

    @property
    def is_to_be_weighed(self) -> bool:
        """Whether the latest record takes part in naming: every one at first, every eighth later."""
        return self.records <= SETTLED or (self.records <= WINDOW and self.records % SPACED == 0)

    @property
    def may_be_called(self) -> bool:
        """Whether the latest record may make it a fault that stays one: seldom even much later.

        It does not depend on the motor's limit: a limit that is edited later counts for all records alike.
        """
        is_looked_at = self.is_to_be_weighed or self.records % SELDOM == 0
        return is_looked_at and Kind.SHORTED_TURNS in self.named

    @property
    def is_final(self) -> bool:
        """Whether its name has held for so long that what does not fit it is another change."""
        return bool(self.named) and self.records >= SETTLED

    @property
    def may_hide_another(self) -> bool:
        """Whether what comes after it is to be seen by itself: shorted turns are followed as they grow."""
        return Kind.SHORTED_TURNS not in self.named

    @property
    def is_named_beside_turns(self) -> bool:
        """Whether it is named as something else than shorted turns."""
        return bool(self.named) and self.may_hide_another

    @property
    def is_to_be_lived_with(self) -> bool:
        """Whether it is no shorted turns for good, so that what comes after it is to be seen by itself."""
        return self.is_final and self.may_hide_another


@dataclass(slots=True)
class Weighing:
    """What may have changed, as weighed after one record.

    Parameters
    ----------
    probabilities : ndarray, shape (9,)
        Posterior probability by `Cause`.
    logs : ndarray, shape (places + FREE,)
        Log of evidence times prior of every place.
    best : ndarray, shape (places + FREE, 5)
        Onset, whether it drifts, size, its deviation and log of evidence that fit every place best.
    """

    probabilities: Array = field(default_factory=lambda: np.zeros(CAUSES))
    logs: Array = field(default_factory=lambda: np.zeros(0))
    best: Array = field(default_factory=lambda: np.zeros((0, 5)))


def weigh(filters: Any, bank: Any, hypotheses: Hypotheses, level_shares: Array, jumps: Array) -> Weighing:
    """Weigh all causes of a change.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter.
    bank : array of Candidate
        Candidates.
    hypotheses : array of Hypothesis
        All places of all causes.
    level_shares : ndarray, shape (levels, nodes)
        Probability of each axis and leakage of shorted turns at each level.
    jumps : ndarray, shape (6,)
        Standard deviations of the jumps that are free.

    Returns
    -------
    Weighing
        Their probabilities.
    """
    places = len(hypotheses) + FREE
    found = Weighing(np.zeros(CAUSES), np.zeros(places), np.zeros((places, 5)))
    name(filters, bank, hypotheses, level_shares, jumps, found.logs, found.best)
    probabilities(hypotheses, found.logs, found.probabilities)
    return found


def confirm(alarm: Alarm, weighing: Weighing, *, is_alone: bool = True) -> None:
    """Name the kind once several records in a row are sure of it.

    Parameters
    ----------
    alarm : Alarm
        The alarm.
    weighing : Weighing
        Weights after the latest record.
    is_alone : bool, default True
        Whether no second change is suspected. Beside one, what is named stays so unless it is shorted turns.
    """
    sure = _certain(weighing.probabilities)
    alarm.running = alarm.running + 1 if sure == alarm.pending else 1
    alarm.pending = sure
    if alarm.running < RUNNING or (
        alarm.is_named_beside_turns and not is_alone and Kind.SHORTED_TURNS not in sure
    ):
        return
    if sure and not _takes_back(alarm, sure, weighing.probabilities):
        alarm.named = sure
    elif not sure and not DEFECTS & set(alarm.named) and is_doubtful(alarm, weighing):
        alarm.named = ()


def is_doubtful(alarm: Alarm, weighing: Weighing) -> bool:
    """Return whether what an alarm is named as has become unlikely.

    Parameters
    ----------
    alarm : Alarm
        The alarm.
    weighing : Weighing
        Weights after the latest record.

    Returns
    -------
    bool
        Whether the probability of its kinds lies below a half.
    """
    found = by_kind(weighing.probabilities)
    return sum(found[kind] for kind in alarm.named) < DOUBTFUL


def _takes_back(alarm: Alarm, sure: Names, p: Array) -> bool:
    """Return whether another name would take back a defect of the motor.

    All causes are of one change. After a second one none of them fits, and those with the most freedom, the
    impedance and another three-phase load, seem to fit best. A defect that has been named stays named then.
    """
    if not DEFECTS & set(alarm.named):
        return False
    if DEFECTS & set(sure):
        return alarm.is_final and alarm.named == (Kind.SHORTED_TURNS,) and sure == (Kind.CONNECTION,)
    is_free = bool(max(p[Cause.IMPEDANCE], p[Cause.OTHER_LOAD]) >= DOUBTFUL)
    return is_free or alarm.is_final


def by_kind(probabilities: Array) -> dict[Kind, float]:
    """Return the probability of each kind.

    Parameters
    ----------
    probabilities : ndarray, shape (9,)
        Posterior probability by `Cause`.

    Returns
    -------
    dict of Kind to float
        Probabilities; they sum to one.
    """
    found = dict.fromkeys(KINDS.values(), 0.0)
    for cause, kind in KINDS.items():
        found[kind] += float(probabilities[cause])
    half = 0.5 * float(probabilities[Cause.RECORDER])
    found[Kind.VOLTAGE_CHANNEL] += half
    found[Kind.CURRENT_CHANNEL] += half
    return found


def _certain(p: Array) -> Names:
    load = p[Cause.ELEMENT] + p[Cause.OTHER_LOAD]
    if load >= CERTAIN:
        return (Kind.OTHER_LOAD,)
    for cause, kind in KINDS.items():
        if p[cause] >= CERTAIN:
            return (kind,)
    turns, joint = p[Cause.SHORTED_TURNS], p[Cause.JOINT]
    unknown, element = p[Cause.ASYMMETRY], p[Cause.ELEMENT]
    beside = unknown + (element if element <= UNLIKELY_ELEMENT else 0.0)
    if turns >= RATHER and turns + beside >= CERTAIN:
        return (Kind.SHORTED_TURNS,)
    if turns + joint >= RATHER and turns + joint + unknown >= CERTAIN:
        return (Kind.SHORTED_TURNS, Kind.CONNECTION)
    if p[Cause.VOLTAGE_CHANNEL] + p[Cause.CURRENT_CHANNEL] + p[Cause.RECORDER] >= CERTAIN:
        return (Kind.VOLTAGE_CHANNEL, Kind.CURRENT_CHANNEL)
    return ()
