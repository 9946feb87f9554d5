"""Drifts found on motors of many ratings: how often, how soon, as what, and whether the intervals hold."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from statistics import median

import numpy as np

from benchmarks.reporting import Section, rate_text, spread, table
from benchmarks.tracking.motors import HAPPENINGS, START_SCATTER, draw
from core.machines.base import Array
from core.tracking.drift import FOLLOWED
from core.tracking.finding import DriftCause, ParameterName
from core.tracking.follower import Follower
from core.tracking.telling import WIDEST, tracked_parameters

RECORDS, FIRST = 800, 400
MOTORS, QUICK_MOTORS = 40, 4
LOOKED_AT = (FIRST - 1, FIRST + 99, RECORDS - 1)
"""Records after which intervals are compared with the truth: before the change, 100 later, at the end."""
SHOWN = (
    ParameterName.STATOR_RESISTANCE,
    ParameterName.ROTOR_RESISTANCE,
    ParameterName.MAGNETISING_INDUCTANCE,
    ParameterName.LEAKAGE_INDUCTANCE,
)


@dataclass(frozen=True, slots=True)
class Result:
    """What became of one motor.

    early: drifts told before anything happened.  found_after: records until a parameter was told that had
    changed; None where it was not.  others: parameters that were told and had not changed.
    causes: at the end.
    holds, told: of each parameter in the order of FOLLOWED after the records looked at, shape (looks, 4):
    whether the interval has the truth, and whether it is narrow enough to be told.
    """

    early: int
    found_after: int | None
    others: tuple[ParameterName, ...]
    causes: tuple[DriftCause, ...]
    holds: Array
    told: Array


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """The tables of what was found, and of the intervals."""
    motors = QUICK_MOTORS if quick else MOTORS
    found_rows, interval_rows = [], []
    for name in HAPPENINGS:
        results = list(spread(partial(followed, name), range(motors), name, pool))
        found_rows.append(_found(name, results))
        interval_rows.append(_intervals(name, results))
    lines = [
        f"{motors} motors a row, {RECORDS} records each, most of them hourly; what happens begins with "
        f"record {FIRST}. With starts: one every hundred records, the first among the reference's; the ratio "
        f"of cage to winding scatters by {START_SCATTER:.1%}, and by up to 5 % with their temperatures.",
        "",
        *table(
            [
                "what happens",
                "found",
                "records until then, median / 90 %",
                "its cause alone",
                "its cause among others",
                "told before, or of another parameter",
            ],
            found_rows,
        ),
        "",
        f"Found: within {RECORDS - FIRST} records. 50 K are 20 % of R_s, of which 15 % are told. The "
        "[reference](../reference/tracking.md#limits) says what hides a hot winding.",
        "",
        "How often the 95 % interval has the true change, of all intervals that are narrow enough to be "
        f"told (half of it at most {_widest()}), and in brackets the share that is: before, 100 records "
        "after and at the end together. The truth of R_s is what happens; weather comes on top.",
        "",
        *table(["what happens", *(name.words for name in SHOWN)], interval_rows),
    ]
    return [Section("drifts", "Drifts", "python -m benchmarks.tracking --subject drifts", tuple(lines))]


def followed(name: str, seed: int) -> Result:
    """Follow one motor."""
    happening = HAPPENINGS[name]
    drawn = draw(happening, seed, RECORDS, FIRST)
    follower = Follower(drawn.motor)
    early, found_after = 0, None
    others: set[ParameterName] = set()
    holds, told = [], []
    for at, record in enumerate(drawn.records):
        follower.follow(record)
        if at in drawn.starts:
            follower.follow_start(record.time_ns, drawn.starts[at], START_SCATTER)
        drifting = [one for one, drift in zip(FOLLOWED, follower.drifts, strict=True) if drift.since_ns]
        early += bool(drifting) and at < FIRST
        if at >= FIRST:
            if found_after is None and set(drifting) & set(happening.drifting):
                found_after = at - FIRST + 1
            others |= set(drifting) - set(happening.drifting)
        if at in LOOKED_AT:
            change, covariance = follower.changes
            half = 1.96 * np.sqrt(np.diag(covariance))
            holds.append(np.abs(change - _truth(name, drawn.magnetising_change, late=at >= FIRST)) <= half)
            told.append(half <= WIDEST)
    causes = tracked_parameters(follower).causes
    harmless = {ParameterName.LEAKAGE_INDUCTANCE, ParameterName.STATOR_RESISTANCE}
    if happening.cause is DriftCause.RATIO:
        others -= harmless  # all impedances change
    return Result(early, found_after, tuple(others), causes, np.array(holds), np.array(told))


def _truth(name: str, magnetising: float, *, late: bool) -> Array:
    """True changes in the order of FOLLOWED."""
    one = HAPPENINGS[name]
    if not late:
        return np.zeros(4)
    return np.array([
        0.00393 * one.hotter_K + one.ratio - 1.0, one.ratio - 1.0, magnetising, one.resistance - 1.0
    ])  # fmt: skip


def _found(name: str, results: Sequence[Result]) -> list[str]:
    cause = HAPPENINGS[name].cause
    after = [one.found_after for one in results if one.found_after is not None]
    of = len(results)
    alone = sum(one.causes == (cause,) for one in results)
    among = sum(cause in one.causes and len(one.causes) > 1 for one in results)
    false = sum(bool(one.early or one.others) for one in results)
    if cause is None:
        return [name, "-", "-", "-", "-", rate_text(false, of)]
    times = f"{median(after):.0f} / {np.quantile(after, 0.9):.0f}" if after else "-"
    return [name, rate_text(len(after), of), times, str(alone), str(among), str(false)]


def _intervals(name: str, results: Sequence[Result]) -> list[str]:
    holds, told = (np.array([getattr(one, of) for one in results]) for of in ("holds", "told"))
    cells = []
    for parameter in SHOWN:
        place = FOLLOWED.index(parameter)
        here, known = holds[..., place], told[..., place]
        share = f"({known.mean():.0%})"
        cells.append(f"{here[known].mean():.0%} {share}" if known.any() else f"- {share}")
    return [name, *cells]


def _widest() -> str:
    return ", ".join(f"{100 * WIDEST[FOLLOWED.index(name)]:.0f} % of the {name.words}" for name in SHOWN)
