"""Records of motors with coils in slots, one after another through COMTRADE files, followed over time."""

import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from math import degrees
from pathlib import Path

import numpy as np

from benchmarks.reporting import Section, spread, table
from benchmarks.winding.records import (
    COMMAND,
    Disturbance,
    Trial,
    case_of,
    connection_of,
    disturbed,
    known_motor,
)
from core.condition.following.follower import Follower
from core.condition.kinds import Kind
from core.condition.measuring.observing import observe
from core.condition.observation import Observation
from core.machines.parameters import Motor
from core.recordings import read
from core.recordings.comtrade.writer import write
from testing.machines.slot_fault_records import USUAL, SlotFaultCase

POWERS_KW = (0.8, 7.5, 160.0)
LEVELS = (0.005, 0.01, 0.02)
OTHERS = {
    Disturbance.NOTHING: Kind.NONE,
    Disturbance.VOLTAGE_CHANNEL: Kind.VOLTAGE_CHANNEL,
    Disturbance.CURRENT_CHANNEL: Kind.CURRENT_CHANNEL,
    Disturbance.JOINT: Kind.CONNECTION,
}
BEFORE, AFTER = 24, 8
"""Records before what happens, and from it on."""
HOUR_NS = 3_600_000_000_000
FIRST_SEED, FIRST_SOUND_SEED = 700_000, 800_000
LEAST_LOAD = 0.3
VOLTAGE, UNBALANCE, WARMTH = 0.02, 0.003, 0.08
"""How far V1, V2/V1 and the windings' resistances wander, the last from record to record as a walk."""
SURE = 0.98
RIGHT_AXIS_DEG = 5.0


@dataclass(frozen=True, slots=True)
class Told:
    """What is told of a motor in the end; the axis [deg] and the phase are None where they are not told."""

    kinds: tuple[Kind, ...]
    probability: float
    phase: str | None
    axis_deg: float | None
    level: float
    interval: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Followed:
    """A motor with the truth, followed by a file without its winding and by one with it."""

    trial: Trial
    case: SlotFaultCase
    without: Told
    given: Told


def followed(trial: Trial) -> Followed:
    """Follow a motor over its records."""
    case = case_of(trial)
    with tempfile.TemporaryDirectory() as folder:
        seen = list(_observed(trial, case, Path(folder) / "record.cfg"))
    without, given = (
        _told(known_motor(case, replace(trial, has_winding=one)), seen) for one in (False, True)
    )
    return Followed(trial, case, without, given)


def _observed(trial: Trial, case: SlotFaultCase, path: Path) -> Iterator[Observation]:
    """Make each record with its own load, supply and warmth, write it, read it and observe it."""
    random, motor = np.random.default_rng([trial.seed, 41]), known_motor(case, trial)
    walk = np.cumsum(random.normal(0.0, 1.0, BEFORE + AFTER))
    warmth = 1.0 + WARMTH * walk / np.abs(walk).max()
    nothing = replace(trial, disturbance=Disturbance.NOTHING)
    for k in range(BEFORE + AFTER):
        here = replace(
            case,
            motor=_warm(case.motor, float(warmth[k])),
            fault=case.fault if k >= BEFORE else None,
            load_level=float(random.uniform(LEAST_LOAD, 1.0)),
            relative_voltage=1.0 + float(random.uniform(-VOLTAGE, VOLTAGE)),
            unbalance=case.unbalance + UNBALANCE * complex(*random.uniform(-1.0, 1.0, 2)),
            record=k,
        )
        record = disturbed(here, trial if k >= BEFORE else nothing)
        write(path, replace(record, start_time_ns=(k + 1) * HOUR_NS), revision=2013, data_format="FLOAT32")
        observation = observe(read(path), motor)
        if observation is not None:
            yield observation


def _warm(motor: Motor, warmth: float) -> Motor:
    machine = motor.parameters
    return replace(
        motor,
        parameters=replace(
            machine,
            stator_resistance_ohm=machine.stator_resistance_ohm * warmth,
            rotor_resistance_ohm=machine.rotor_resistance_ohm * warmth,
        ),
    )


def _told(motor: Motor, seen: Sequence[Observation]) -> Told:
    follower = Follower(motor)
    for one in seen:
        follower.fold(one)
    assessment = follower.assessment()
    change = None if assessment is None else assessment.change
    if change is None:
        return Told((), 0.0, None, None, 0.0, (0.0, 1.0))
    level = change.level
    return Told(
        change.named,
        change.probabilities[Kind.SHORTED_TURNS],
        level.phase,
        level.axis_deg,
        level.value,
        level.ci95,
    )


def series(pool: Executor, *, quick: bool) -> list[Section]:
    """Rows of motors that are followed."""
    count = 1 if quick else 12
    cells = [(power, level) for power in POWERS_KW for level in LEVELS]
    trials = [
        Trial(FIRST_SEED + 1_000 * c + k, power, USUAL, level, connection=connection_of(k))
        for c, (power, level) in enumerate(cells)
        for k in range(count)
    ]
    found = list(spread(followed, trials, "motors with shorted turns", pool))
    rows = []
    for power, level in cells:
        here = [one for one in found if (one.trial.power_kW, one.trial.level) == (power, level)]
        rows.append([f"{power:g} kW", f"{level:.1%}", *_row(here)])
    rows.append(["all", "", *_row(found)])
    return [
        Section(
            "series",
            "Records over time",
            COMMAND.format("series"),
            (*ABOUT, *table(HEADER, rows), "", *_others(pool, 1 if quick else 4)),
        )
    ]


def _row(found: Sequence[Followed]) -> list[str]:
    named = [one for one in found if Kind.SHORTED_TURNS in one.without.kinds]
    given = [one for one in found if Kind.SHORTED_TURNS in one.given.kinds]
    wrong = sum(
        told.phase is not None and not _is_phase_of(one.case, told.phase)
        for one in found
        for told in (one.without, one.given)
    )
    axes = [one for one in given if one.given.axis_deg is not None]
    right = sum(_axis_error_deg(one) <= RIGHT_AXIS_DEG for one in axes)
    errors = [abs(one.without.level / one.case.equivalent_level - 1.0) for one in named]
    holds = sum(
        one.without.interval[0] <= one.case.equivalent_level <= one.without.interval[1] for one in named
    )
    return [
        f"{len(named)} of {len(found)} ({sum(one.without.probability >= SURE for one in found)})",
        f"{len(given)} ({sum(one.given.probability >= SURE for one in found)})",
        str(wrong),
        f"{right} of {len(axes)}",
        f"{np.median(errors):.0%}" if errors else "",
        f"{holds} of {len(named)}",
    ]


def _is_phase_of(case: SlotFaultCase, phase: str) -> bool:
    return case.fault is not None and "abc"[case.fault.phase] == phase


def _axis_error_deg(one: Followed) -> float:
    axis = one.given.axis_deg
    return 0.0 if axis is None else abs(axis - degrees(one.case.axis_rad))


def _others(pool: Executor, count: int) -> Iterator[str]:
    """Yield what is told where no turns are shorted."""
    cells = [(kind, power) for kind in OTHERS for power in POWERS_KW]
    trials = [
        Trial(FIRST_SOUND_SEED + 1_000 * c + k, power, USUAL, disturbance=kind, connection=connection_of(k))
        for c, (kind, power) in enumerate(cells)
        for k in range(count)
    ]
    found = list(spread(followed, trials, "motors without shorted turns", pool))
    rows = []
    for kind, expected in OTHERS.items():
        told = [t for one in found if one.trial.disturbance is kind for t in (one.without, one.given)]
        turns = sum(one.kinds == (Kind.SHORTED_TURNS,) for one in told)
        named = sum(expected in one.kinds for one in told)
        nothing = sum(not one.kinds for one in told)
        rows.append([str(kind), f"{turns} of {len(told)}", str(named), str(nothing)])
    yield from table(OTHERS_HEADER, rows)


ABOUT = (
    f"Motors are followed over {BEFORE} hourly records, and {AFTER} with turns shorted in one coil: the",
    "circuit for every coil, as COMTRADE files of 0.5 s at 2 kHz, channels of 1 % and 25 us, loads of 0.3 to",
    "1, V1 and V2/V1 that wander, windings that warm by 8 % either way, parameters of the file off by up to",
    "10 %. Named: as shorted turns, or as these or a joint; in brackets with a probability of 98 % or more.",
    "Each motor is followed without its winding and with it.",
    "",
)
OTHERS_HEADER = ("what happens", "called shorted turns", "named, alone or beside another", "nothing named")
HEADER = (
    "motor", "level", "named", "winding given", "phase wrong", "axis right, of those told",
    "level off, median", "interval holds",
)  # fmt: skip
