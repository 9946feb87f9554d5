"""Simulated records with one cause or two of sizes drawn at random, and how each answer compares with it."""

from dataclasses import dataclass
from itertools import combinations
from time import perf_counter

import numpy as np

from benchmarks.classification.outcomes import Outcome, outcome_of
from core.diagnosis.causes import PRIORS, Cause, Causes
from core.findings.examining import examine
from testing.machines.cause_records import CauseCase, Sizes
from testing.machines.motors import LARGE, MEDIUM, REFERENCE

MOTORS = {"small": REFERENCE, "medium": MEDIUM, "large": LARGE}
"""0.8, 7.5 and 37 kW."""
ONE_RECORD = tuple(cause for cause in PRIORS if cause is not Cause.LOAD)
"""What one record may tell: all causes but a load that changed."""
PAIRS = tuple(frozenset(two) for two in combinations(ONE_RECORD, 2))


@dataclass(frozen=True, slots=True)
class Subject:
    """One record; `seed` draws the sizes and all that disturbs."""

    motor: str
    load_level: float
    causes: Causes
    seed: int


@dataclass(frozen=True, slots=True)
class Result:
    """What was said of one record, and in which time."""

    subject: Subject
    outcome: Outcome
    likeliest: Causes
    told: bool
    seconds: float


def answered(subject: Subject) -> Result:
    """Simulate a record, examine it and compare the answer."""
    case = CauseCase(
        MOTORS[subject.motor], subject.causes, subject.load_level, subject.seed, drawn_sizes(subject.seed)
    )
    known, record = case.known(), case.record()
    begun = perf_counter()
    answer = examine(record, known).classification
    seconds = perf_counter() - begun
    outcome = outcome_of(answer, subject.causes)
    return Result(subject, outcome, answer.answer.causes, answer.is_told, seconds)


def drawn_sizes(seed: int) -> Sizes:
    """Draw how large the causes are: what a plant would want to know of, small ones among them."""
    random = np.random.default_rng([seed, 3])
    sign = random.choice([-1.0, 1.0], 3)
    return Sizes(
        turns=random.uniform(0.02, 0.12),
        turns_phase=int(random.integers(3)),
        bars=int(random.integers(1, 4)),
        joint_drop=random.uniform(0.04, 0.12),
        joint_phase=int(random.integers(3)),
        unbalance=complex(random.uniform(0.025, 0.05) * np.exp(2j * np.pi * random.uniform())),
        voltage_error=sign[0] * random.uniform(0.04, 0.1),
        voltage_channel=int(random.integers(3)),
        current_error=sign[1] * random.uniform(0.04, 0.1),
        current_channel=int(random.integers(3)),
        pulsation=random.uniform(0.03, 0.1),
        pulsation_hz=random.uniform(1.0, 15.0),
        static=random.uniform(0.2, 0.4),
        dynamic=random.uniform(0.15, 0.3),
        inductance_factor=random.uniform(0.5, 0.75) if sign[2] < 0.0 else random.uniform(1.35, 1.7),
    )
