"""Starts with a known cause, against starts of the motor as it was: what is told of them."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from core.machines.parameters import Motor
from core.starts.changes import compare_starts
from core.starts.compared import ChangeState, StartCause, StartChanges
from core.starts.examined import ExaminedStart
from core.starts.examining import examine_start
from testing.machines.motors import LARGE, MEDIUM, REFERENCE
from testing.machines.starts import StartRecord, with_parameters

Generator = np.random.Generator


def _driving(motor: Motor, inertias: float, name: str) -> Motor:
    """The motor with a driven machine of some inertia."""
    driving = with_parameters(motor, inertia_kgm2=inertias * motor.parameters.inertia_kgm2)
    return replace(driving, name=name)


MOTORS: Final = (
    replace(REFERENCE, name="800 W, star"),
    _driving(MEDIUM, 8.0, "7.5 kW, star"),
    replace(LARGE, name="37 kW, delta"),
    _driving(LARGE, 4.0, "37 kW, delta, heavy"),
)
LOAD: Final = 0.4
REFERENCES: Final = 3
DURATION_S: Final = 2.0


@dataclass(frozen=True, slots=True)
class Case:
    """What is other than before, and the causes that are right."""

    name: str
    causes: frozenset[StartCause]

    def record(self, random: Generator) -> StartRecord:
        """A start of this case, its size at random."""
        usual = usual_start(random)
        size = float(random.uniform(0.0, 1.0))
        weaker, heavier = 0.94 - 0.06 * size, 0.15 + 0.2 * size
        match self.name:
            case "warm by 60 K":
                return replace(usual, resistances=(1.24, 1.24))
            case "cage 20 K warmer than the winding":
                return replace(usual, resistances=(1.12, 1.2))
            case "supply 6 to 12 % lower":
                return replace(usual, voltage=weaker * usual.voltage)
            case "load 15 to 35 % of rated torque higher":
                return replace(usual, load_level=usual.load_level + heavier)
            case "rotor resistance 30 to 60 % higher":
                return replace(usual, resistances=(1.0, 1.3 + 0.3 * size))
            case "3 of 28 bars broken":
                return replace(usual, broken_bars=3 / 28)
            case "supply and load":
                return replace(usual, voltage=weaker * usual.voltage, load_level=usual.load_level + heavier)
        return usual


CASES: Final = (
    Case("as before", frozenset()),
    Case("warm by 60 K", frozenset()),
    Case("cage 20 K warmer than the winding", frozenset()),
    Case("supply 6 to 12 % lower", frozenset({StartCause.SUPPLY})),
    Case("load 15 to 35 % of rated torque higher", frozenset({StartCause.LOAD})),
    Case("rotor resistance 30 to 60 % higher", frozenset({StartCause.ROTOR})),
    Case("3 of 28 bars broken", frozenset({StartCause.ROTOR})),
    Case("supply and load", frozenset({StartCause.SUPPLY, StartCause.LOAD})),
)


def usual_start(random: Generator) -> StartRecord:
    """A start of the motor as it is: voltage, load, moment of switching and noise differ each time."""
    return StartRecord(
        load_level=LOAD + 0.01 * float(random.standard_normal()),
        duration_s=DURATION_S,
        switched_at_s=0.02 * float(random.uniform()),
        snr_db=45.0,
        voltage_snr_db=60.0,
        voltage=1.0 + 0.003 * float(random.standard_normal()),
        unbalance=0.005,
        seed=int(random.integers(2**31)),
    )


def outcome(changes: StartChanges, case: Case) -> str:
    """What a comparison is worth: right, partly, not told apart, missed or wrong."""
    told = frozenset(changes.causes) - {StartCause.WARMTH}
    if told == case.causes:
        return "right" if case.causes or changes.state is ChangeState.AS_BEFORE else "not told apart"
    if told - case.causes:
        return "wrong"
    if told:
        return "partly"
    return "not told apart" if changes.state is ChangeState.NOT_TOLD_APART else "missed"


@dataclass(frozen=True, slots=True)
class Row:
    """Outcomes of one case on one motor."""

    motor: str
    case: str
    outcomes: Counter[str]


def measure(repeats: int, *, seed: int = 2026) -> Iterator[Row]:
    """Yield the outcomes, motor by motor."""
    for number, motor in enumerate(MOTORS):
        random = np.random.default_rng([seed, number])
        reference = [_examined(usual_start(random), motor) for _ in range(REFERENCES)]
        for case in CASES:
            latest = [_examined(case.record(random), motor) for _ in range(repeats)]
            counted = Counter(outcome(compare_starts([one], reference), case) for one in latest)
            yield Row(motor.name, case.name, counted)


def _examined(record: StartRecord, motor: Motor) -> ExaminedStart:
    return examine_start(record.of(motor), motor)
