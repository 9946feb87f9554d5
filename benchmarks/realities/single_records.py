"""Single records of each reality: healthy and with 5 % of the turns shorted, and what is said of them."""

import json
import re
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.realities.cases import DURATION_S, OTHER_RUNNING, RATE_HZ, REALITIES, STEADY, Reality, window
from benchmarks.reporting import Section, spread, table
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import Connection
from testing.machines.disturbed_records import record_of
from testing.machines.slot_fault_records import USUAL, drawn_case, with_other_parameters

POWERS_KW = (0.8, 7.5, 37.0, 160.0)
LEVEL = 0.05
RECORDS, QUICK = 12, 4
BEFORE = Path(__file__).parent / "before.json"
"""The same records, judged by the project as it was before it knew of any of these realities."""


@dataclass(frozen=True, slots=True)
class Trial:
    """One record: the place of its reality in the list, and the seed that draws the rest."""

    place: int
    faulty: bool
    seed: int


@dataclass(frozen=True, slots=True)
class Outcome:
    """What was said of one record: verdict, whether the phase is right and the level held, and the name."""

    verdict: str
    is_phase_right: bool | None
    holds: bool
    named: bool


@dataclass(frozen=True, slots=True)
class Count:
    """What was said of the records of one reality, healthy or faulty.

    phase_right, phase_wrong, level_held: of those that are called.
    """

    records: int
    verdicts: dict[str, int]
    named: int
    phase_right: int
    phase_wrong: int
    level_held: int

    @classmethod
    def of(cls, outcomes: Sequence[Outcome]) -> "Count":
        called = [one for one in outcomes if one.verdict == Verdict.FAULT]
        return cls(
            len(outcomes),
            dict(sorted(Counter(one.verdict for one in outcomes).items())),
            sum(one.named for one in outcomes),
            sum(one.is_phase_right is True for one in called),
            sum(one.is_phase_right is False for one in called),
            sum(one.holds for one in called),
        )

    @property
    def called(self) -> int:
        return self.verdicts.get(Verdict.FAULT, 0)

    def text(self) -> str:
        """Verdicts in words, those that are called first."""
        order = (Verdict.FAULT, Verdict.WATCH, Verdict.HEALTHY, Verdict.UNDIAGNOSABLE)
        words = {Verdict.FAULT: "**fault**", Verdict.UNDIAGNOSABLE: "refused"}
        shown = [f"{words.get(one, one)} {self.verdicts[one]}" for one in order if one in self.verdicts]
        return ", ".join(shown)

    def called_text(self) -> str:
        """Those that are called, wrong phases, and levels that their interval holds."""
        wrong = f", wrong phase {self.phase_wrong}" if self.phase_wrong else ""
        return f"{self.called} of {self.records}{wrong}; level held {self.level_held}"


def judged(trial: Trial) -> Outcome:
    """Simulate a record, judge it by the motor's file and compare with the truth."""
    reality, seed = REALITIES[trial.place], 100_000 * trial.place + trial.seed
    connection = reality.connection or (Connection.DELTA if trial.seed // 4 % 3 == 2 else Connection.STAR)
    case = drawn_case(
        seed,
        level=LEVEL if trial.faulty else None,
        power_kW=POWERS_KW[trial.seed % len(POWERS_KW)],
        poles=4,
        sensors=USUAL,
        most_path_ratio=2.0,
        connection=connection,
    )
    case = replace(case, sample_rate_hz=RATE_HZ, duration_s=reality.duration_s)
    random = np.random.default_rng([seed, 41])
    plant = reality.plant(case.plant(), random)
    known = reality.file(replace(with_other_parameters(case.motor, seed), sensors=USUAL), plant)
    samples = (
        reality.samples(plant, random)
        if reality.duration_s == DURATION_S
        else window(plant, reality.duration_s)
    )
    found = diagnose(record_of(samples, RATE_HZ), known)
    low, high = found.mu_f_ci95 or (0.0, 1.0)
    fault = case.fault
    return Outcome(
        str(found.verdict),
        None if fault is None or found.phase is None else found.phase == "abc"[fault.phase],
        low <= case.equivalent_level <= high,
        _is_named(reality, found),
    )


def _is_named(reality: Reality, found: Diagnosis) -> bool:
    if not reality.named:
        return False
    said = (*found.reasons[:3], *(one.message for one in found.quality))
    return any(re.search(reality.named, one) is not None for one in said)


def steady(pool: Executor, *, quick: bool) -> list[Section]:
    """What lies behind the relay, or is wrong with the channels, all the time."""
    return [_section("steady", "In steady running", STEADY, 0, pool, quick=quick)]


def events(pool: Executor, *, quick: bool) -> list[Section]:
    """What happens within a record, and other running than that of a steady load."""
    return [_section("events", "Events, and other running", OTHER_RUNNING, len(STEADY), pool, quick=quick)]


HEADER = (
    "reality", "healthy, before", "healthy", "named", "5 % shorted, called before", "called", "named",
)  # fmt: skip


def _section(
    subject: str, title: str, realities: Sequence[Reality], first: int, pool: Executor, *, quick: bool
) -> Section:
    count = QUICK if quick else RECORDS
    trials = [
        Trial(first + k, faulty, seed)
        for k in range(len(realities))
        for faulty in (False, True)
        for seed in range(count)
    ]
    outcomes = list(spread(judged, trials, title, pool))
    before = _before()
    rows = []
    for k, reality in enumerate(realities):
        here = outcomes[2 * k * count : 2 * (k + 1) * count]
        sound, faulty = Count.of(here[:count]), Count.of(here[count:])
        sound_before, faulty_before = before[reality.name]
        rows.append(
            [
                reality.name,
                sound_before.text(),
                sound.text(),
                _named(reality, sound),
                faulty_before.called_text(),
                faulty.called_text(),
                _named(reality, faulty),
            ]
        )
    command = f"python -m benchmarks.realities --subject {subject}"
    return Section(subject, title, command, tuple(table(HEADER, rows)))


def _named(reality: Reality, found: Count) -> str:
    return f"{found.named} of {found.records}" if reality.named else ""


def _before() -> dict[str, tuple[Count, Count]]:
    document: dict[str, dict[str, Any]] = json.loads(BEFORE.read_text("utf-8"))
    return {name: (Count(**one["healthy"]), Count(**one["faulty"])) for name, one in document.items()}
