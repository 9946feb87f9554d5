"""The rotor of a motor over its records: absolute limits, and the change against a baseline of the same load.

Cages differ as they are made, and a severity depends a little on the load, so each tenth of the rated load
has a baseline of its own. A record that cannot tell takes nothing away; a single one that stands out is not
believed.

What follows from a record depends on two records before it and on its baseline, and on nothing else. So
whoever keeps the records of years judges a new one from a few of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import NamedTuple

from core.rotor.finding import LOAD_OSCILLATION, RotorFinding, RotorState

BASELINE_RECORDS = 3
"""First records of a load bin, whose median is its baseline."""
LATEST_RECORDS, AGREEING = 3, 2
"""Latest records that are judged together, and how many of them must agree."""
RISE_DB = 4.0
"""Change that is told; one broken bar changed single-phase measurements of a small motor by 4 to 6 dB."""
LEAST_DB = -50.0
"""What is less counts as this: cages as they are made reach so far, and noise moves what is below."""


class LoadBin(NamedTuple):
    """The records of one tenth of the rated load.

    Parameters
    ----------
    bin : int
        0 to 11.
    records : int
        Number of records that could tell.
    baseline_dB : float or None
        Median severity of the first ones [dB]; None while there are too few.
    """

    bin: int
    records: int
    baseline_dB: float | None


@dataclass(frozen=True, slots=True)
class JudgedRecord:
    """A record that could tell, beside the baseline of its load.

    Parameters
    ----------
    state : RotorState
        What the record by itself says; not unsupported.
    severity_dB : float
        Asymmetry of the rotor's resistance [dB].
    severity_dB_ci95 : tuple of float
        Its 95 % interval.
    baseline_dB : float or None
        Baseline of its load bin [dB]; None of the records that make it.
    load_swings : bool
        Whether a swing of the load was taken off.
    """

    state: RotorState
    severity_dB: float
    severity_dB_ci95: tuple[float, float]
    baseline_dB: float | None
    load_swings: bool

    @property
    def change_dB(self) -> float | None:
        """Change against the baseline [dB]; None without one."""
        return None if self.baseline_dB is None else max(self.severity_dB, LEAST_DB) - self.baseline_dB

    @property
    def has_risen(self) -> bool:
        """Whether the change is one that is told."""
        return self.change_dB is not None and self.change_dB >= RISE_DB


@dataclass(frozen=True, slots=True)
class RotorCondition:
    """The rotor of a motor, from its records.

    Parameters
    ----------
    state : RotorState
        State; unsupported where no record could tell.
    severity_dB : float or None
        Median severity of the latest records that could tell [dB].
    severity_dB_ci95 : tuple of float or None
        Medians of the ends of their intervals.
    change_dB : float or None
        Their median change against the baselines of their load bins [dB]; None without a baseline.
    since_ns : int or None
        Time of the record with which the state began.
    bins : tuple of LoadBin
        Load bins that have records.
    reasons : tuple of str
        Reasons of the state in words.
    """

    state: RotorState
    severity_dB: float | None
    severity_dB_ci95: tuple[float, float] | None
    change_dB: float | None
    since_ns: int | None
    bins: tuple[LoadBin, ...]
    reasons: tuple[str, ...]

    def as_dict(self) -> dict[str, object]:
        """Return the figures as JSON takes them.

        Returns
        -------
        dict of str to object
            The figures by name.
        """
        interval = self.severity_dB_ci95
        return {
            "state": str(self.state),
            "severity_dB": self.severity_dB,
            "severity_dB_ci95": None if interval is None else list(interval),
            "change_dB": self.change_dB,
            "since_ns": self.since_ns,
            "bins": [one._asdict() for one in self.bins],
            "reasons": list(self.reasons),
        }


def baseline_dB(first: Sequence[float]) -> float | None:
    """Return the baseline of a load bin.

    Parameters
    ----------
    first : sequence of float
        Severities of its records that could tell, the first ones first [dB].

    Returns
    -------
    float or None
        Median of the first BASELINE_RECORDS; None while there are fewer.
    """
    if len(first) < BASELINE_RECORDS:
        return None
    return median(max(severity, LEAST_DB) for severity in first[:BASELINE_RECORDS])


def state_after(latest: Sequence[JudgedRecord]) -> RotorState:
    """Return the state of a rotor from a record on.

    Parameters
    ----------
    latest : sequence of JudgedRecord
        The record and those before it, LATEST_RECORDS together or as many as there are; the latest last.

    Returns
    -------
    RotorState
        The state; unsupported without any.
    """
    if not latest:
        return RotorState.UNSUPPORTED
    faults = sum(one.state is RotorState.FAULT for one in latest)
    notable = sum(one.state is not RotorState.HEALTHY or one.has_risen for one in latest)
    if faults >= AGREEING:
        return RotorState.FAULT
    return RotorState.WATCH if notable >= AGREEING or faults else RotorState.HEALTHY


def rotor_condition(
    latest: Sequence[JudgedRecord], since_ns: int | None, bins: Sequence[LoadBin]
) -> RotorCondition:
    """Judge the rotor of one motor.

    Parameters
    ----------
    latest : sequence of JudgedRecord
        The latest LATEST_RECORDS that could tell, or as many as there are; the latest last.
    since_ns : int or None
        Time of the record from which on `state_after` has been what it is after the latest one.
    bins : sequence of LoadBin
        The load bins that have records.

    Returns
    -------
    RotorCondition
        The condition.
    """
    if not latest:
        reason = "no record could tell: see the reasons of each"
        return RotorCondition(RotorState.UNSUPPORTED, None, None, None, None, (), (reason,))
    state = state_after(latest)
    changes = [one.change_dB for one in latest if one.change_dB is not None]
    low, high = zip(*(one.severity_dB_ci95 for one in latest), strict=True)
    return RotorCondition(
        state=state,
        severity_dB=median(one.severity_dB for one in latest),
        severity_dB_ci95=(median(low), median(high)),
        change_dB=median(changes) if changes else None,
        since_ns=since_ns,
        bins=tuple(bins),
        reasons=_reasons(state, latest),
    )


def condition_of_findings(findings: Sequence[tuple[int, RotorFinding]]) -> RotorCondition:
    """Judge the rotor of one motor from the findings of all its records.

    Parameters
    ----------
    findings : sequence of (int, RotorFinding)
        Time of each record, UTC [ns], and what it tells of the rotor, in the order of time.

    Returns
    -------
    RotorCondition
        The condition.
    """
    of_bins: dict[int, list[float]] = {}
    judged: list[JudgedRecord] = []
    state, since_ns = RotorState.UNSUPPORTED, None
    counting = [one for one in findings if one[1].severity_dB is not None and one[1].load_bin is not None]
    for _, finding in counting:
        of_bins.setdefault(finding.load_bin or 0, []).append(finding.severity_dB or 0.0)
    baselines = {load_bin: baseline_dB(levels) for load_bin, levels in of_bins.items()}
    seen = dict.fromkeys(of_bins, 0)
    for time_ns, finding in counting:
        load_bin = finding.load_bin or 0
        seen[load_bin] += 1
        judged.append(
            JudgedRecord(
                finding.state,
                finding.severity_dB or 0.0,
                finding.severity_dB_ci95 or (0.0, 0.0),
                baselines[load_bin] if seen[load_bin] > BASELINE_RECORDS else None,
                any(reason.startswith(LOAD_OSCILLATION) for reason in finding.reasons),
            )
        )
        now = state_after(judged[-LATEST_RECORDS:])
        if now is not state:
            state, since_ns = now, time_ns
    bins = [LoadBin(one, len(of_bins[one]), baselines[one]) for one in sorted(of_bins)]
    return rotor_condition(judged[-LATEST_RECORDS:], since_ns, bins)


def _reasons(state: RotorState, latest: Sequence[JudgedRecord]) -> tuple[str, ...]:
    count = len(latest)
    faults = sum(one.state is RotorState.FAULT for one in latest)
    watched = sum(one.state is RotorState.WATCH for one in latest)
    risen = [one.change_dB for one in latest if one.change_dB is not None and one.has_risen]
    reasons = []
    if faults:
        again = "" if state is RotorState.FAULT else ": one record alone is not believed"
        reasons.append(f"{faults} of the latest {count} records show a fault of the rotor{again}")
    if watched:
        reasons.append(f"{watched} of the latest {count} records show an uneven rotor")
    if risen:
        reasons.append(
            f"{len(risen)} of the latest {count} records are {min(risen):.1f} dB and more above the baseline"
        )
    reasons = reasons or ["the latest records show an even rotor, as the first ones did"]
    swinging = sum(one.load_swings for one in latest)
    if swinging:
        reasons.append(
            f"{LOAD_OSCILLATION} in {swinging} of the latest {count} records: the load swings at twice the "
            "slip, and its sidebands are taken off"
        )
    return tuple(reasons)
