"""The alarm of changed starts over lives of motors: how often it is false, and how soon it tells a change."""

from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from benchmarks.reporting import rate_text, spread
from benchmarks.starts.causes import CASES, MOTORS, Case, usual_start
from core.machines.parameters import Motor
from core.starts.changes import REFERENCE_STARTS, compare_starts
from core.starts.compared import StartCause
from core.starts.examined import ExaminedStart
from core.starts.examining import examine_start
from core.starts.notable import LATEST, notable_change
from testing.machines.starts import StartRecord

Generator = np.random.Generator
WARMEST_K: Final = 60.0
CAGE_WARMER_K: Final = 20.0
A_KELVIN: Final = 0.004
"""Rise of a resistance with temperature."""
SOUND_STARTS: Final = 20
"""Starts of a sound life, and the most that a changed one is given."""
CHANGED_STARTS: Final = 6
SOUND: Final = CASES[0]
FAULTS: Final = tuple(case for case in CASES if case.causes)
SEED: Final = 7_000


@dataclass(frozen=True, slots=True)
class Life:
    """A motor with its first starts, for reference, and then starts of a case."""

    motor: Motor
    case: Case
    seed: int


@dataclass(frozen=True, slots=True)
class Told:
    """What the alarm said over a life: at which start after the reference first, and which causes.

    false: of a sound life, after how many of its starts it stood.
    """

    life: Life
    starts: int
    first: int | None
    causes: frozenset[StartCause]
    false: int


def lived(life: Life) -> Told:
    """Return what the alarm says over a life. Temperatures, voltage, load and noise differ each time."""
    random = np.random.default_rng([SEED, life.seed, MOTORS.index(life.motor), CASES.index(life.case)])
    reference = [_examined(usual_start(random), life, random) for _ in range(REFERENCE_STARTS)]
    later: list[ExaminedStart] = []
    standing = 0
    first: int | None = None
    causes: frozenset[StartCause] = frozenset()
    is_sound = life.case is SOUND or not life.case.causes
    for number in range(1, (SOUND_STARTS if is_sound else CHANGED_STARTS) + 1):
        later.append(_examined(life.case.record(random), life, random))
        latest = later[-LATEST:]
        told = notable_change(compare_starts(latest, reference), len(latest))
        standing += told is not None
        if told is not None and first is None:
            first, causes = number, frozenset(told.causes)
            if not is_sound:
                break
    return Told(life, len(later), first, causes, standing if is_sound else 0)


def lines(pool: Executor, *, lives: int) -> Iterator[str]:
    """Yield the table. lives: of each motor and case; sound ones are four times as many."""
    sound = [Life(motor, SOUND, seed) for motor in MOTORS for seed in range(4 * lives)]
    changed = [Life(motor, case, seed) for case in FAULTS for motor in MOTORS for seed in range(lives)]
    found = list(spread(lived, [*sound, *changed], "lives", pool))
    yield "| what is other | lives | told | after starts, median | right | partly | not told apart | wrong |"
    yield "|---|---|---|---|---|---|---|---|"
    for case in FAULTS:
        yield _row(case, [one for one in found if one.life.case == case])
    quiet = [one for one in found if one.life.case == SOUND]
    starts = sum(one.starts for one in quiet)
    yield ""
    yield (
        f"Sound motors, {len(quiet)} lives of {SOUND_STARTS} starts: the alarm was raised in "
        f"{rate_text(sum(one.first is not None for one in quiet), len(quiet))} of the lives, and stood after "
        f"{rate_text(sum(one.false for one in quiet), starts)} of the starts."
    )


def _row(case: Case, lives: Sequence[Told]) -> str:
    told = [one for one in lives if one.first is not None]
    outcomes = Counter(_outcome(one.causes, case.causes) for one in told)
    median = f"{np.median([one.first for one in told if one.first is not None]):g}" if told else ""
    counts = " | ".join(str(outcomes[one] or "") for one in ("right", "partly", "not told apart", "wrong"))
    return f"| {case.name} | {len(lives)} | {len(told)} | {median} | {counts} |"


def _outcome(told: frozenset[StartCause], true: frozenset[StartCause]) -> str:
    if not told:
        return "not told apart"
    if told == true:
        return "right"
    return "partly" if told < true else "wrong"


def _examined(record: StartRecord, life: Life, random: Generator) -> ExaminedStart:
    """Examine a start of a motor that is as warm as chance has it."""
    warm_K = float(random.uniform(0.0, WARMEST_K))
    cage_K = warm_K + float(random.uniform(0.0, CAGE_WARMER_K))
    stator, rotor = record.resistances
    warm = (stator * (1.0 + A_KELVIN * warm_K), rotor * (1.0 + A_KELVIN * cage_K))
    return examine_start(replace(record, resistances=warm).of(life.motor), life.motor)
