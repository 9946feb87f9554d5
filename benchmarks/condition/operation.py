"""When a motor is recorded, what it drives, how warm it is, and what its supply does."""

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from benchmarks.condition.circuit import BACKWARD, FORWARD, Array, Complex

HOUR_NS = 3_600_000_000_000
FIRST_NS = 1_700_000_000_000_000_000
COPPER_PER_K = 0.00393


class Load(StrEnum):
    """How the load goes from hour to hour."""

    CONSTANT = "constant"
    STEPS = "steps"
    RANDOM = "random"
    WANDER = "wander"
    DUTY = "duty cycle"


class Times(StrEnum):
    """When records are made."""

    HOURLY = "hourly"
    DAILY = "daily"
    IRREGULAR = "irregular"
    """Hours apart, with gaps of weeks."""


@dataclass(frozen=True, slots=True)
class Operation:
    """What is the same for all that hangs on a motor, one row a record.

    time_ns: when.  load: torque over the rated one.  warming: resistances over those of the file's
    temperature.  relative_voltage, unbalance (V2/V1), displacement (V0/V1): the supply at the terminals.
    frequency_ratio: over the rated one.
    """

    time_ns: NDArray[np.int64]
    load: Array
    warming: Array
    relative_voltage: Array
    unbalance: Complex
    displacement: Complex
    frequency_ratio: Array

    def __len__(self) -> int:
        return self.time_ns.size

    def phase_voltages(self, rated_V: float) -> Complex:
        """Line-to-neutral voltages of lines 0, 1, 2 without zero sequence, (n, 3), peak."""
        volts = rated_V * self.relative_voltage
        return np.asarray(volts[:, np.newaxis] * (FORWARD + np.outer(self.unbalance, BACKWARD)))

    def on_constant_supply(self) -> "Operation":
        """The same motor on a supply whose V2/V1 stays: nothing tells its impedance but its file."""
        return replace(self, unbalance=np.full(len(self), self.unbalance[0]))

    def on_supply(self, other: "Operation") -> "Operation":
        """The same motor on another's supply: both are recorded at the same times."""
        return replace(
            self,
            relative_voltage=other.relative_voltage,
            unbalance=other.unbalance,
            displacement=other.displacement,
            frequency_ratio=other.frequency_ratio,
        )


def draw_operation(
    random: np.random.Generator,
    records: int,
    *,
    times: Times = Times.HOURLY,
    load: Load | None = None,
    size: float = 0.5,
) -> Operation:
    """Draw so many records; size 0 to 1 is the motor's, on which its time constants depend."""
    hours = _hours(random, times, records)
    grid = np.arange(np.ceil(hours[-1]) + 1.0)
    kind = load or list(Load)[int(random.integers(len(Load)))]
    level, heat = _load(random, kind, grid.size)
    at = hours.astype(np.int64)
    seen = level[at]
    if kind is Load.DUTY:  # on and off several times an hour: a record sees either, the winding the mean
        low, high, share = level[0], level[0] + random.uniform(0.1, 0.5), random.uniform(0.2, 0.8)
        seen = np.where(random.uniform(size=records) < share, min(high, 1.0), low)
        heat = np.full(grid.size, share * _heat(np.array(min(high, 1.0))) + (1.0 - share) * _heat(low))
    temperature = _temperature(random, heat, hours, size)
    seen = np.clip(seen * (1.0 + 0.01 * random.standard_normal(records)), 0.02, 1.05)
    return Operation(
        time_ns=FIRST_NS + np.round(hours * HOUR_NS).astype(np.int64),
        load=seen,
        warming=1.0 + COPPER_PER_K * temperature,
        relative_voltage=_voltage(random, grid, at, hours),
        unbalance=_unbalance(random, hours),
        displacement=_complex(random) * random.uniform(0.0, 0.02)
        + random.uniform(0.0, 0.002) * _wandering(random, hours, random.uniform(2.0, 24.0)),
        frequency_ratio=1.0
        + random.uniform(1e-4, 2e-3) * _wandering(random, hours, 0.3).real.clip(-3.0, 3.0),
    )


def draw_kind_of_times(random: np.random.Generator) -> Times:
    """Two of three motors are recorded hourly."""
    return list(Times)[int(random.choice(3, p=[0.67, 0.16, 0.17]))]


def _hours(random: np.random.Generator, times: Times, records: int) -> Array:
    if times is Times.HOURLY:
        return np.arange(records) + random.uniform(0.0, 0.2, records)
    if times is Times.DAILY:
        return 24.0 * np.arange(records) + random.uniform(0.0, 3.0, records)
    gaps = 0.1 + random.exponential(random.uniform(2.0, 20.0), records)
    gaps[random.uniform(size=records) < 0.003] += random.uniform(200.0, 900.0)
    return np.cumsum(gaps)


def _load(random: np.random.Generator, kind: Load, hours: int) -> tuple[Array, Array]:
    level = np.full(hours, random.uniform(0.15, 0.95))
    if kind is Load.STEPS:
        changed = random.uniform(size=hours) < 1.0 / random.uniform(4.0, 100.0)
        level = random.uniform(0.1, 1.0, hours)[np.maximum.accumulate(np.where(changed, np.arange(hours), 0))]
    elif kind is Load.RANDOM:
        level = random.uniform(0.1, 1.0, hours)
    elif kind is Load.WANDER:
        swing = random.uniform(0.05, 0.25) * _stationary(random, hours, random.uniform(3.0, 100.0)).real
        day = random.uniform(0.0, 0.2) * np.sin(2 * np.pi * np.arange(hours) / 24.0)
        level = np.clip(level + swing + day, 0.08, 1.0)
    return level, _heat(level)


def _heat(load: Array) -> Array:
    """Losses over those at rated load: part of them is there at no load."""
    return np.asarray(0.3 + 0.7 * load**2)


def _temperature(random: np.random.Generator, heat: Array, hours: Array, size: float) -> Array:
    """Winding temperature less that of the file's resistances at every record [K]."""
    rise, time_constant = random.uniform(50.0, 90.0), random.uniform(0.3, 0.7) + 1.2 * size
    kept = np.exp(-1.0 / time_constant)
    # Temperature at the beginning of every hour; within the hour it goes on from there.
    start = rise * heat[0]
    driven = np.concatenate([[0.0], heat[:-1]]) * rise * (1.0 - kept)
    driven[0] = start
    warm = np.asarray(lfilter([1.0], [1.0, -kept], driven))
    at = hours.astype(np.int64)
    within = np.exp(-(hours - at) / time_constant)
    winding = rise * heat[at] + (warm[at] - rise * heat[at]) * within
    year = 10.0 * np.sin(2 * np.pi * hours / 8_766.0 + random.uniform(0.0, 6.28))
    day = random.uniform(0.0, 6.0) * np.sin(2 * np.pi * hours / 24.0)
    # The figures of a file are those of a motor at 20 to 75 degrees; the air has 20.
    return np.asarray(winding + year + day - random.uniform(0.0, 55.0))


def _voltage(random: np.random.Generator, grid: Array, at: NDArray[np.int64], hours: Array) -> Array:
    day = random.uniform(0.0, 0.02) * np.sin(2 * np.pi * hours / 24.0)
    wander = random.uniform(0.002, 0.015) * _stationary(random, grid.size, random.uniform(1.0, 30.0)).real
    return np.asarray(1.0 + random.uniform(-0.03, 0.03) + day + wander[at].clip(-0.05, 0.05))


def _unbalance(random: np.random.Generator, hours: Array) -> Complex:
    """V2/V1: a standing part, a wandering one, and jumps up to 4 % that stay for hours to days."""
    standing = random.uniform(0.0, 0.015) * _complex(random)
    wander = random.uniform(0.0005, 0.003) * _wandering(random, hours, random.uniform(0.5, 48.0))
    jumps = np.zeros(hours.size, dtype=np.complex128)
    count = random.poisson((hours[-1] - hours[0]) / (24.0 * random.uniform(10.0, 90.0)))
    for begin, length in zip(
        random.uniform(hours[0], hours[-1], count), random.exponential(48.0, count), strict=True
    ):
        inside = (hours >= begin) & (hours < begin + length)
        jumps[inside] += random.uniform(0.002, 0.04) * _complex(random)
    total = standing + wander + jumps
    return np.asarray(total * np.minimum(1.0, 0.05 / np.maximum(np.abs(total), 1e-9)))


def _wandering(random: np.random.Generator, hours: Array, correlation_hours: float) -> Complex:
    """A complex first-order autoregression of unit standard deviation each part, at any times."""
    kept = np.exp(-np.diff(hours, prepend=hours[0] - 1e6) / correlation_hours)
    steps = (random.standard_normal(hours.size) + 1j * random.standard_normal(hours.size)) * np.sqrt(
        1.0 - kept**2
    )
    out = np.empty(hours.size, dtype=np.complex128)
    value = 0j
    for k, (keep, step) in enumerate(zip(kept.tolist(), steps.tolist(), strict=True)):
        value = keep * value + step
        out[k] = value
    return out


def _stationary(random: np.random.Generator, hours: int, correlation_hours: float) -> Complex:
    return _wandering(random, np.arange(float(hours)), correlation_hours)


def _complex(random: np.random.Generator) -> complex:
    return complex(np.exp(1j * random.uniform(0.0, 2.0 * np.pi)))
