"""Simulated records with one cause or two of sizes drawn at random, and how each answer compares with it."""

from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations
from time import perf_counter

import numpy as np

from core.classification.causes import PRIORS, Cause, Causes
from core.classification.record import classify_record
from core.condition.measuring.observing import examine
from testing.machines.cause_records import CauseCase, Sizes
from testing.machines.motors import LARGE, MEDIUM, REFERENCE

MOTORS = {"small": REFERENCE, "medium": MEDIUM, "large": LARGE}
"""0.8, 7.5 and 37 kW."""
ONE_RECORD = tuple(cause for cause in PRIORS if cause is not Cause.LOAD)
"""What one record may tell: all causes but a load that changed."""
PAIRS = tuple(frozenset(two) for two in combinations(ONE_RECORD, 2))


class Outcome(StrEnum):
    """How an answer compares with the truth."""

    RIGHT = "right"
    AMONG = "right among those not told apart"
    PARTLY = "a part of it, and nothing wrong"
    MISSED = "called healthy"
    UNTOLD = "nothing told"
    WRONG = "wrong"


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
        MOTORS[subject.motor], subject.causes, subject.load_level, subject.seed, _sizes(subject.seed)
    )
    known, record = case.known(), case.record()
    examined = examine(record, known)
    begun = perf_counter()
    answer = classify_record(examined, known)
    seconds = perf_counter() - begun
    open_ones = [pair.other.causes for pair in answer.not_told_apart]
    likeliest, truth = answer.answer.causes, subject.causes
    if answer.is_told:
        if likeliest == truth:
            outcome = Outcome.RIGHT
        elif not likeliest:
            outcome = Outcome.MISSED
        else:
            outcome = Outcome.PARTLY if likeliest < truth else Outcome.WRONG
    elif truth in (likeliest, *open_ones) and open_ones:
        outcome = Outcome.AMONG
    elif any(one and one <= truth for one in (likeliest, *open_ones)):
        outcome = Outcome.PARTLY
    else:
        outcome = Outcome.WRONG if any((likeliest, *open_ones)) else Outcome.UNTOLD
    return Result(subject, outcome, likeliest, answer.is_told, seconds)


def _sizes(seed: int) -> Sizes:
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
