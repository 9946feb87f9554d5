"""The rotor of a motor over its records: absolute limits, and the change against a baseline of the same load.

Cages differ as they are made, and a severity depends a little on the load, so each tenth of the rated load
has a baseline of its own. A record that cannot tell takes nothing away; a single one that stands out is not
believed.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import median
from typing import NamedTuple

from core.rotor.finding import LOAD_BINS, LOAD_OSCILLATION, RotorFinding, RotorState

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
class DatedFinding:
    """What a record of some time tells of the rotor.

    Parameters
    ----------
    time_ns : int
        Time of the record, in nanoseconds since 1970, UTC.
    finding : RotorFinding
        What it tells.
    """

    time_ns: int
    finding: RotorFinding


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


def rotor_condition(findings: Sequence[DatedFinding]) -> RotorCondition:
    """Judge the rotor of one motor from all its records.

    Parameters
    ----------
    findings : sequence of DatedFinding
        What its records tell, in order of time.

    Returns
    -------
    RotorCondition
        The condition.
    """
    seen = list(_with_changes(findings))
    if not seen:
        reason = "no record could tell: see the reasons of each"
        return RotorCondition(RotorState.UNSUPPORTED, None, None, None, None, (), (reason,))
    states = [_state(_latest(seen, end)) for end in range(1, len(seen) + 1)]
    first = next((k for k in range(len(states) - 1, 0, -1) if states[k - 1] is not states[k]), 0)
    latest = _latest(seen, len(seen))
    changes = [one.change_dB for one in latest if one.change_dB is not None]
    return RotorCondition(
        state=states[-1],
        severity_dB=median(one.severity_dB for one in latest),
        severity_dB_ci95=(
            median(one.interval[0] for one in latest),
            median(one.interval[1] for one in latest),
        ),
        change_dB=median(changes) if changes else None,
        since_ns=seen[first].time_ns,
        bins=_bins(seen),
        reasons=_reasons(states[-1], latest),
    )


@dataclass(frozen=True, slots=True)
class _Seen:
    """One record that could tell, with its change against the baseline of its load bin."""

    time_ns: int
    state: RotorState
    severity_dB: float
    interval: tuple[float, float]
    bin: int
    change_dB: float | None
    load_swings: bool

    @property
    def has_risen(self) -> bool:
        return self.change_dB is not None and self.change_dB >= RISE_DB


def _with_changes(findings: Sequence[DatedFinding]) -> Iterator[_Seen]:
    first: list[list[float]] = [[] for _ in range(LOAD_BINS)]
    for dated in findings:
        found = dated.finding
        interval, load_bin = found.severity_dB_ci95, found.load_bin
        if found.severity_dB is None or interval is None or load_bin is None:
            continue
        if found.state is RotorState.UNSUPPORTED:
            continue
        level = max(found.severity_dB, LEAST_DB)
        baseline = first[load_bin]
        change = level - median(baseline) if len(baseline) == BASELINE_RECORDS else None
        if len(baseline) < BASELINE_RECORDS:
            baseline.append(level)
        swings = any(reason.startswith(LOAD_OSCILLATION) for reason in found.reasons)
        yield _Seen(dated.time_ns, found.state, found.severity_dB, interval, load_bin, change, swings)


def _latest(seen: list[_Seen], end: int) -> list[_Seen]:
    return seen[max(0, end - LATEST_RECORDS) : end]


def _state(latest: list[_Seen]) -> RotorState:
    faults = sum(one.state is RotorState.FAULT for one in latest)
    notable = sum(one.state is not RotorState.HEALTHY or one.has_risen for one in latest)
    if faults >= AGREEING:
        return RotorState.FAULT
    return RotorState.WATCH if notable >= AGREEING or faults else RotorState.HEALTHY


def _bins(seen: list[_Seen]) -> tuple[LoadBin, ...]:
    by_bin = [[max(one.severity_dB, LEAST_DB) for one in seen if one.bin == k] for k in range(LOAD_BINS)]
    return tuple(
        LoadBin(k, len(own), median(own[:BASELINE_RECORDS]) if len(own) >= BASELINE_RECORDS else None)
        for k, own in enumerate(by_bin)
        if own
    )


def _reasons(state: RotorState, latest: list[_Seen]) -> tuple[str, ...]:
    count = len(latest)
    faults = sum(one.state is RotorState.FAULT for one in latest)
    watched = sum(one.state is RotorState.WATCH for one in latest)
    risen = [one.change_dB for one in latest if one.change_dB is not None and one.has_risen]
    reasons = []
    if faults:
        again = "" if state is RotorState.FAULT else ": one record alone is not believed"
        reasons.append(f"{faults} of the latest {count} records show a fault of the cage{again}")
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
