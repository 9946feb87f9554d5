"""Records of motors with coils in slots through COMTRADE files to the verdict of a single record."""

import tempfile
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks.reporting import Section, spread, table
from core.diagnosis.causes import Cause
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import Connection, Motor
from core.machines.sensors import SensorClass
from core.machines.stator_winding import StatorWinding, WindingKind
from core.recordings import Quantity, Recording, read
from core.recordings.comtrade.writer import write
from ied_sim.motor.slots import SlotWinding
from testing.machines.rated_motors import POWERS_KW
from testing.machines.slot_fault_records import (
    PRECISE,
    USUAL,
    SlotFaultCase,
    drawn_case,
    with_other_parameters,
)

LEVELS = (0.01, 0.02, 0.03, 0.05, 0.08)
CLASSES = {"0.2 %, 5 us": PRECISE, "1 %, 25 us": USUAL}


class Disturbance(StrEnum):
    """What is wrong where no turns are shorted."""

    NOTHING = "healthy"
    VOLTAGE_CHANNEL = "voltage channel, 1 to 5 %"
    CURRENT_CHANNEL = "current channel, 1 to 4 %"
    JOINT = "joint, a drop of 0.5 to 5 %"
    SUPPLY = "supply, V2/V1 of 2 to 6 %"
    ASYMMETRY = "unknown asymmetry, 1 to 4 % of V1"


@dataclass(frozen=True, slots=True)
class Trial:
    """One record: rating, level or disturbance, class of the channels, whether the file has the winding."""

    seed: int
    power_kW: float
    sensors: SensorClass
    level: float | None = None
    disturbance: Disturbance = Disturbance.NOTHING
    has_winding: bool = False
    connection: Connection = Connection.STAR


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a record was called, with the truth."""

    trial: Trial
    case: SlotFaultCase
    verdict: Verdict
    answer: Cause | None
    phase: str | None
    level: float
    interval: tuple[float, float]

    @property
    def is_called(self) -> bool:
        return self.verdict is Verdict.FAULT

    @property
    def is_right(self) -> bool:
        fault = self.case.fault
        return fault is not None and self.phase == "abc"[fault.phase]

    @property
    def error(self) -> float:
        """Relative error of the level."""
        return self.level / self.case.equivalent_level - 1.0

    @property
    def holds(self) -> bool:
        return self.interval[0] <= self.case.equivalent_level <= self.interval[1]


def case_of(trial: Trial) -> SlotFaultCase:
    """Draw the motor, winding and fault of a trial."""
    case = drawn_case(
        trial.seed,
        level=trial.level,
        power_kW=trial.power_kW,
        sensors=trial.sensors,
        connection=trial.connection,
        most_path_ratio=2.0,
    )
    return replace(case, sample_rate_hz=2_000.0, duration_s=0.5)


def judged(trial: Trial) -> Outcome:
    """Make the record of a trial, write it as a COMTRADE file, read it and diagnose it."""
    case = case_of(trial)
    if trial.disturbance is Disturbance.SUPPLY:
        case = replace(
            case, unbalance=case.unbalance / max(abs(case.unbalance), 1e-9) * _size(trial, 0.02, 0.06)
        )
    record = disturbed(case, trial)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "record.cfg"
        write(path, record, revision=2013, data_format="FLOAT32")
        read_back = read(path)
    found = diagnose(read_back, known_motor(case, trial))
    return _outcome(trial, case, found)


def known_motor(case: SlotFaultCase, trial: Trial) -> Motor:
    """The motor as its file has it: parameters off by up to 10 %, the class of its channels."""
    motor = replace(with_other_parameters(case.motor, trial.seed), sensors=trial.sensors)
    return replace(motor, winding=_told(case.winding)) if trial.has_winding else motor


def disturbed(case: SlotFaultCase, trial: Trial) -> Recording:
    """The record, with what is wrong in the channels or before the motor."""
    random = np.random.default_rng([trial.seed, 31])
    record, x = case.steady_recording(), int(random.integers(3))
    kind = trial.disturbance
    if kind in {Disturbance.NOTHING, Disturbance.SUPPLY}:
        return record
    samples = record.samples.astype(np.float64).copy()
    rows = {
        quantity: [k for k, one in enumerate(record.channels) if one.quantity is quantity]
        for quantity in (Quantity.CURRENT, Quantity.PHASE_VOLTAGE)
    }
    currents, voltages = rows[Quantity.CURRENT], rows[Quantity.PHASE_VOLTAGE]
    sign = float(random.choice([-1.0, 1.0]))
    if kind is Disturbance.VOLTAGE_CHANNEL:
        samples[voltages[x]] *= 1.0 + sign * _size(trial, 0.01, 0.05)
    elif kind is Disturbance.CURRENT_CHANNEL:
        samples[currents[x]] *= 1.0 + sign * _size(trial, 0.01, 0.04)
    elif kind is Disturbance.JOINT:
        # A joint between the transformers and a star's phase: the transformers see its drop as well.
        plate = case.motor.nameplate
        rated_A = plate.rated_power_W / (3.0 * plate.winding_voltage_V * 0.75)
        resistance_ohm = _size(trial, 0.005, 0.05) * plate.winding_voltage_V / rated_A
        drop = samples[currents[x]] * resistance_ohm
        samples[voltages[x]] += drop
        samples[voltages] -= drop / 3.0  # the star point is free: no zero sequence comes of it
    else:
        size = _size(trial, 0.01, 0.04)
        return _with_asymmetry(record, voltages, random, size, reverse=case.reverse)
    return replace(record, samples=samples)


def _with_asymmetry(
    record: Recording, voltages: list[int], random: np.random.Generator, size: float, *, reverse: bool
) -> Recording:
    """Add a negative sequence of any angle to the voltages alone: the currents do not answer it."""
    samples = record.samples.copy()
    t = np.arange(samples.shape[1]) / record.sample_rate_hz
    first = samples[voltages[0]]
    w = 2.0 * np.pi * 50.0
    phasor = 2.0 * np.mean(first * np.exp(-1j * w * t)) * size * np.exp(2j * np.pi * random.uniform())
    turn = np.exp((-2j if reverse else 2j) * np.pi / 3.0)
    for k, row in enumerate(voltages):
        samples[row] += np.real(phasor * turn**k * np.exp(1j * w * t))
    return replace(record, samples=samples)


def _size(trial: Trial, least: float, most: float) -> float:
    return float(np.random.default_rng([trial.seed, 37]).uniform(least, most))


def _told(winding: SlotWinding) -> StatorWinding:
    return StatorWinding(WindingKind(winding.kind), winding.slots, winding.layers, winding.coil_pitch_slots)


def _outcome(trial: Trial, case: SlotFaultCase, found: Diagnosis) -> Outcome:
    answer = found.hypotheses[0].cause if found.hypotheses else None
    level, interval = found.mu_f or 0.0, found.mu_f_ci95 or (0.0, 1.0)
    return Outcome(trial, case, found.verdict, answer, found.phase, level, interval)


COMMAND = "python -m benchmarks.winding --subject {}"
FAULTS = (
    "Records of 0.5 s at 2 kHz of the circuit for every coil, as COMTRADE files: motors of 2 to 8 poles, a",
    "quarter of them in delta, lap windings of 24 to 72 slots and concentric ones, any coil of any phase,",
    "paths of 0 to 2 times the turns' resistance, loads of 0.2 to 1, V2/V1 up to 2 %, harmonics, both",
    "sequences, parameters of the file off by up to 10 % each. Called: `fault`. A phase is named at 95 %.",
    "The level is the equivalent one.",
    "",
)
SOUND = (
    "Records as those of shorted turns, with something else. Called: `fault`. Told as it is: the likeliest",
    "explanation is what is there; small errors are within the class of the channels.",
    "",
)
FAULT_HEADER = (
    "motor", "channels", "winding given", "level", "called", "phase named", "phase wrong",
    "level off, median", "interval holds",
)  # fmt: skip
SHOWN = (Verdict.FAULT, Verdict.WATCH, Verdict.HEALTHY)
SOUND_HEADER = ("what is there", "winding given", "channels", "called", "watch", "healthy", "told as it is")


def faults(pool: Executor, *, quick: bool) -> list[Section]:
    """Rows of shorted turns."""
    count = 3 if quick else 40
    cells = list(product(POWERS_KW, CLASSES, (False, True), LEVELS))
    trials = [
        Trial(1_000 * c + k, power, CLASSES[name], level, has_winding=has, connection=connection_of(k))
        for c, (power, name, has, level) in enumerate(cells)
        for k in range(count)
        if level * 8 <= 1
    ]
    outcomes = list(spread(judged, trials, "records of shorted turns", pool))
    rows = []
    for cell, (power, name, has, level) in enumerate(cells):
        here = [one for one in outcomes if one.trial.seed // 1_000 == cell]
        rows.append([f"{power:g} kW", name, "yes" if has else "no", f"{level:.0%}", *_fault_row(here)])
    rows.append(["all", "", "", "", *_fault_row(outcomes)])
    return [
        Section(
            "faults",
            "Single records of shorted turns",
            COMMAND.format("faults"),
            (*FAULTS, *table(FAULT_HEADER, rows)),
        )
    ]


def _fault_row(outcomes: Sequence[Outcome]) -> list[str]:
    called = [one for one in outcomes if one.is_called]
    named = [one for one in called if one.phase is not None]
    wrong = sum(not one.is_right for one in named)
    off = f"{np.median([abs(one.error) for one in called]):.0%}" if called else ""
    holds = f"{sum(one.holds for one in called)} of {len(called)}" if called else ""
    return [f"{len(called)} of {len(outcomes)}", str(len(named)), str(wrong), off, holds]


def sound(pool: Executor, *, quick: bool) -> list[Section]:
    """Rows of records without shorted turns."""
    count = 5 if quick else 100
    cells = list(product(Disturbance, (False, True), CLASSES))
    trials = [
        Trial(
            500_000 + 1_000 * c + k,
            POWERS_KW[k % len(POWERS_KW)],
            CLASSES[name],
            disturbance=kind,
            has_winding=has,
        )
        for c, (kind, has, name) in enumerate(cells)
        for k in range(count)
    ]
    outcomes = list(spread(judged, trials, "records without shorted turns", pool))
    rows = []
    for cell, (kind, has, name) in enumerate(cells):
        here = [one for one in outcomes if (one.trial.seed - 500_000) // 1_000 == cell]
        verdicts = Counter(one.verdict for one in here)
        told = sum(one.answer is OF_DISTURBANCES[kind] for one in here)
        rows.append(
            [
                str(kind),
                "yes" if has else "no",
                name,
                *(
                    f"{verdicts[one]} of {len(here)}"
                    for one in (Verdict.FAULT, Verdict.WATCH, Verdict.HEALTHY)
                ),
                str(told),
            ]
        )
    return [
        Section(
            "sound",
            "Single records without shorted turns",
            COMMAND.format("sound"),
            (*SOUND, *table(SOUND_HEADER, rows)),
        )
    ]


OF_DISTURBANCES = {
    Disturbance.NOTHING: Cause.HEALTHY,
    Disturbance.VOLTAGE_CHANNEL: Cause.VOLTAGE_CHANNEL,
    Disturbance.CURRENT_CHANNEL: Cause.CURRENT_CHANNEL,
    Disturbance.JOINT: Cause.CONNECTION,
    Disturbance.SUPPLY: Cause.HEALTHY,
    Disturbance.ASYMMETRY: Cause.ASYMMETRY,
}


def connection_of(k: int) -> Connection:
    """Return how a motor's windings are connected: one in four in delta."""
    return Connection.DELTA if k % 4 == 3 else Connection.STAR
