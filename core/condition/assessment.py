"""What the filter and its bank of changes make of a motor's records so far."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, Literal

from core.condition.kinds import Kind
from core.diagnosis.phase_words import NAMED_PHASE
from core.machines.stator_winding import Winding
from core.normal_distribution import NORMAL_95
from core.units import NANOSECONDS_PER_DAY

Phase = Literal["a", "b", "c"]
PHASES: Final[tuple[Phase, Phase, Phase]] = ("a", "b", "c")
Phases = tuple[float, float, float]
"""Probability of each phase."""

STALE_AFTER_NS: Final = 7 * NANOSECONDS_PER_DAY
"""A condition whose latest record is older than this is stale, unless the caller knows better."""


@dataclass(frozen=True, slots=True)
class Level:
    """An equivalent fault level with its standard deviation from all causes.

    Parameters
    ----------
    value, deviation : float
        Level and its standard deviation, a fraction of the phase turns.
    winding : {0, 1, 2}
        Terminal winding of the fault.
    interval : tuple of float or None, optional
        95 % interval where it is not the normal one, because axis and leakage may be one or another.
    phases : tuple of float or None, optional
        Probability of each phase at the terminals; None where no phase can be told.
    axis_deg : float or None, optional
        Electrical degrees of the coils' axis from that of their phase; None where it is not known.
    """

    value: float
    deviation: float
    winding: Winding
    interval: tuple[float, float] | None = None
    phases: Phases | None = None
    axis_deg: float | None = None

    @property
    def phase(self) -> Phase | None:
        """Phase of the fault at the terminals: "a", "b", "c"; None where it is not sure."""
        if self.phases is None or self.phases[self.winding] < NAMED_PHASE:
            return None
        return PHASES[self.winding]

    @property
    def ci95(self) -> tuple[float, float]:
        """95 % interval, not below zero."""
        if self.interval is not None:
            return max(0.0, self.interval[0]), max(0.0, self.interval[1])
        half = NORMAL_95 * self.deviation
        return max(0.0, self.value - half), max(0.0, self.value + half)


@dataclass(frozen=True, slots=True)
class Change:
    """A change that the detector has raised.

    Parameters
    ----------
    since_ns : int
        Time of the first record that likeliest shows it, UTC [ns].
    detected_ns : int
        Time of the record with which the detector crossed its threshold, UTC [ns].
    probabilities : mapping of Kind to float
        Posterior probability of each kind; they sum to one.
    named : tuple of Kind
        The kind once it is certain; two kinds where the records cannot tell them apart; empty while open.
    level : Level
        Change of the fault level if it is shorted turns, beside what the motor had before.
    channel : {0, 1, 2} or None
        Likeliest phase of a channel or a joint, at the terminals; None for other kinds.
    size : float or None
        Size of the likeliest kind: relative error of the channel, voltage drop of the joint over rated
        voltage, or level; None of another impedance or another recorder, which have no single one.
    surely_above : float
        What the level lay above for certain, once, while the change was named as shorted turns; 0 where that
        was never looked at.
    size_ci95 : tuple of float or None
        95 % interval of the size; None where there is none.
    until_ns : int or None
        Time of the latest record that showed it, UTC [ns], where shorted turns have vanished; None while the
        change lasts.
    """

    since_ns: int
    detected_ns: int
    probabilities: Mapping[Kind, float]
    named: tuple[Kind, ...]
    level: Level
    channel: Winding | None
    size: float | None
    surely_above: float = 0.0
    size_ci95: tuple[float, float] | None = None
    until_ns: int | None = None


@dataclass(frozen=True, slots=True)
class Declared:
    """Shorted turns that the records showed when a person declared the motor healthy as it is.

    Parameters
    ----------
    level : float
        Fault level in all, a fraction of the phase turns.
    ci95 : tuple of float
        Its 95 % interval.
    phase : {"a", "b", "c"} or None
        Phase at the terminals; None where it was not sure.
    """

    level: float
    ci95: tuple[float, float]
    phase: Phase | None


@dataclass(frozen=True, slots=True)
class Reference:
    """What the motor was like before any change, as learnt.

    Parameters
    ----------
    records : int
        Number of records it is learnt from.
    complete : bool
        Whether changes are looked for.
    since_ns : int or None
        Time of its first record, UTC [ns].
    detectable : float or None
        Least step of the fault level that nine of ten times would be seen within ten records of today's
        kind, a fraction of the phase turns; None before it is complete.
    standing : Level
        Level that the standing asymmetry would mean if it were shorted turns.
    standing_score : float
        Standard deviations by which it lies beyond what sensors of this class leave.
    from_bus : bool
        Whether other motors of the bus took part in judging it.
    accepted : bool
        Whether a person has declared the standing asymmetry healthy.
    declared : Declared or None
        What speaks against that: shorted turns that the records showed before.
    """

    records: int
    complete: bool
    since_ns: int | None
    detectable: float | None
    standing: Level
    standing_score: float
    from_bus: bool
    accepted: bool = False
    declared: Declared | None = None


@dataclass(frozen=True, slots=True)
class ParameterError:
    """A parameter of the file that the records contradict.

    Parameters
    ----------
    name : str
        Its symbol, or "leakage" for both leakages.
    error : float
        The motor's parameter over that of the file, less one.
    deviation : float
        Standard deviation of that.
    """

    name: str
    error: float
    deviation: float

    def __str__(self) -> str:
        """Return it in words."""
        return f"{self.name} about {self.error:+.0%} (+-{NORMAL_95 * self.deviation:.0%})"


@dataclass(frozen=True, slots=True)
class Assessment:
    """All that the records so far tell.

    Parameters
    ----------
    as_of_ns : int
        Time of the latest record, UTC [ns].
    reference : Reference
        The reference.
    change : Change or None
        The change that is seen; None where there is none.
    standing_fault : bool
        Whether the standing asymmetry is a fault from the first record on.
    statistic : float
        Log of the detector's statistic.
    threshold : float
        Log of its threshold.
    levels : tuple of tuple of int and float
        Time [ns] and change of the level at each of the latest records since the change, oldest first: what
        a forecast is made of. Empty where no change is seen.
    unconfirmed : bool
        Whether the latest record surprises so much that another has to confirm it.
    called_above : float
        Level that a standing fault was called with; 0 where none was.
    held_score : float
        The standing score, which stays while that falls by little; 0 where it is not held.
    seen_by : str or None
        Recorder and direction of rotation of the records that tell it, where the latest record has others.
    parameter_errors : tuple of ParameterError
        Parameters of the motor's file that the records contradict.
    """

    as_of_ns: int
    reference: Reference
    change: Change | None
    standing_fault: bool
    statistic: float
    threshold: float
    levels: tuple[tuple[int, float], ...] = ()
    unconfirmed: bool = False
    called_above: float = 0.0
    held_score: float = 0.0
    seen_by: str | None = None
    parameter_errors: tuple[ParameterError, ...] = ()

    def told_later(self, as_of_ns: int, seen_by: str) -> "Assessment":
        """Return the same assessment as of a later record, which belongs to another reference.

        Parameters
        ----------
        as_of_ns : int
            Time of the later record, UTC [ns].
        seen_by : str
            Recorder and direction of rotation of this assessment's records.

        Returns
        -------
        Assessment
            The assessment; its own latest record needs no confirmation any more.
        """
        return replace(self, as_of_ns=as_of_ns, unconfirmed=False, seen_by=seen_by)
