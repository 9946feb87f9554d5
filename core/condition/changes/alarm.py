"""A change that the detector has raised, and its name."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from core.condition.changes.hypotheses import CAUSES, Cause, Hypotheses
from core.condition.changes.naming import name, probabilities
from core.condition.changes.vanishing import Vanishing
from core.condition.kinds import Kind
from core.machines.base import Array

CERTAIN: Final = 0.98
"""Posterior probability at which a cause is named."""
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
    """

    detected_ns: int
    records: int = 0
    named: Names = ()
    pending: Names = ()
    running: int = 0
    surely_above: float = 0.0
    vanishing: Vanishing | None = None
    worked_on: bool = False

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
    def is_to_be_lived_with(self) -> bool:
        """Whether it is no shorted turns for good, so that what comes after it is to be seen by itself."""
        return self.is_final and Kind.SHORTED_TURNS not in self.named


@dataclass(slots=True)
class Weighing:
    """What may have changed, as weighed after one record.

    Parameters
    ----------
    probabilities : ndarray, shape (6,)
        Posterior probability by `Cause`.
    logs : ndarray, shape (places + 2,)
        Log of evidence times prior of every place.
    best : ndarray, shape (places + 2, 5)
        Onset, whether it drifts, size, its deviation and log of evidence that fit every place best.
    """

    probabilities: Array = field(default_factory=lambda: np.zeros(CAUSES))
    logs: Array = field(default_factory=lambda: np.zeros(0))
    best: Array = field(default_factory=lambda: np.zeros((0, 5)))


def weigh(filters: Any, bank: Any, hypotheses: Hypotheses, recorder: Array) -> Weighing:
    """Weigh all causes of a change.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter.
    bank : array of Candidate
        Candidates.
    hypotheses : array of Hypothesis
        All places of all causes.
    recorder : ndarray, shape (4,)
        Standard deviations of the jumps that another recorder makes.

    Returns
    -------
    Weighing
        Their probabilities.
    """
    places = len(hypotheses) + 2
    found = Weighing(np.zeros(CAUSES), np.zeros(places), np.zeros((places, 5)))
    name(filters, bank, hypotheses, recorder, found.logs, found.best)
    probabilities(hypotheses, found.logs, found.probabilities)
    return found


def confirm(alarm: Alarm, weighing: Weighing) -> None:
    """Name the kind once several records in a row are sure of it.

    Parameters
    ----------
    alarm : Alarm
        The alarm.
    weighing : Weighing
        Weights after the latest record.
    """
    sure = _certain(weighing.probabilities)
    alarm.running = alarm.running + 1 if sure == alarm.pending else 1
    alarm.pending = sure
    if sure and alarm.running >= RUNNING and not _takes_back(alarm, sure):
        alarm.named = sure


def _takes_back(alarm: Alarm, sure: Names) -> bool:
    """Return whether another name would take back a defect of the motor.

    All causes are of one change. After a second one none of them fits, and that with the most freedom, the
    impedance, seems to fit best. A defect that has been named stays named then.
    """
    if not DEFECTS & set(alarm.named):
        return False
    if DEFECTS & set(sure):
        return alarm.is_final and alarm.named == (Kind.SHORTED_TURNS,) and sure == (Kind.CONNECTION,)
    return sure == (Kind.PARAMETERS,) or alarm.is_final


def by_kind(probabilities: Array) -> dict[Kind, float]:
    """Return the probability of each kind.

    Parameters
    ----------
    probabilities : ndarray, shape (6,)
        Posterior probability by `Cause`.

    Returns
    -------
    dict of Kind to float
        Probabilities; they sum to one.
    """
    found = {kind: float(probabilities[cause]) for cause, kind in KINDS.items()}
    half = 0.5 * float(probabilities[Cause.RECORDER])
    found[Kind.VOLTAGE_CHANNEL] += half
    found[Kind.CURRENT_CHANNEL] += half
    return found


def _certain(p: Array) -> Names:
    for cause, kind in KINDS.items():
        if p[cause] >= CERTAIN:
            return (kind,)
    if p[Cause.SHORTED_TURNS] + p[Cause.JOINT] >= CERTAIN:
        return (Kind.SHORTED_TURNS, Kind.CONNECTION)
    if p[Cause.VOLTAGE_CHANNEL] + p[Cause.CURRENT_CHANNEL] + p[Cause.RECORDER] >= CERTAIN:
        return (Kind.VOLTAGE_CHANNEL, Kind.CURRENT_CHANNEL)
    return ()


def taken_up(weighing: Weighing, bank: Any, hypotheses: Hypotheses) -> tuple[Array, Array]:
    """Return what the filter's state has taken up of the likeliest change of a channel, joint or recorder.

    Parameters
    ----------
    weighing : Weighing
        Weights after the latest record.
    bank : array of Candidate
        Candidates.
    hypotheses : array of Hypothesis
        All places of all causes.

    Returns
    -------
    state : ndarray, shape (7,)
        What the state has taken up, f g, of a jump of any direction g.
    covariance : ndarray, shape (7, 7)
        Its covariance, f Lambda^-1 f'.
    """
    turns = hypotheses["cause"] == Cause.SHORTED_TURNS
    logs = np.append(np.where(turns, -np.inf, weighing.logs[:-2]), weighing.logs[-1])
    at = int(np.argmax(logs))
    another = at == len(hypotheses)
    row = weighing.best[at + 1 if another else at]
    one, drifts = bank[int(row[0])], bool(row[1])
    if another or not drifts:
        first = 0 if another else 2 * int(hypotheses[at]["column"])
        last = 4 if another else first + 2
        information, columns = one["step"][first:last, first:last], slice(first, last)
    else:
        current = int(hypotheses[at]["column"]) == 1
        information = one["ramp_current" if current else "ramp_voltage"]
        columns = slice(8, 10) if current else slice(6, 8)
    spread = np.linalg.pinv(information)
    f = one["f"][:, columns]
    return np.asarray(f @ spread @ one["d"][columns]), np.asarray(f @ spread @ f.T)
