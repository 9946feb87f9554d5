"""False alarms of healthy motors and faults found, under everything that disturbs a record at once."""

from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from enum import StrEnum
from math import exp, log, pi

import numpy as np

from benchmarks.reporting import mark, rate_text, spread, table
from core.diagnosis.stator import diagnose, learn_baseline
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.parameters import Motor
from core.recordings import Recording
from testing.machines.disturbed_records import Disturbances, disturbed_record, random_harmonics
from testing.machines.motors import ALL, REFERENCE
from testing.machines.steady_faults import Condition

NOISE = 0.002
"""White noise of the channels, of rated values."""
MOST_ALARMS, OF_HEALTHY = 2, 2_000
MOST_REFUSED = 0.02
"""Of healthy records: a gate that refuses them calls none faulty either."""
LEAST_FOUND, LEAST_PHASE = 0.99, 0.995
BASELINE_RECORDS, BASELINE_INDEX = 3, 1_000_000
LOWEST_LEVEL, HIGHEST_LEVEL = 0.01, 0.19
FURTHER_KINDS = 10
"""How many times fewer records the further rows have."""


class Factor(StrEnum):
    """What can be off nominal."""

    UNBALANCE = "V2/V1 0 to 5 %"
    GAINS = "gain errors to 1 %"
    DELAYS = "channel delays to 50 us"
    HARMONICS = "THD to 5 %"
    FREQUENCY = "49 to 51 Hz"
    OSCILLATION = "load swings 10 % at 0.5 to 10 Hz"
    RESISTANCES = "R_s, R_r 10 % off"
    INDUCTANCES = "L_ls, L_lr, L_s 10 % off"


STATED = frozenset(Factor) - {Factor.INDUCTANCES}
EVERYTHING = frozenset(Factor)


@dataclass(frozen=True, slots=True)
class Draw:
    """One random record: `index` and what it is drawn from.

    healthy_before: records of the same motor and sensors in health, other operation, that a baseline is from.
    """

    motor: Motor
    index: int
    faulty: bool
    factors: frozenset[Factor]
    cycles: float
    sample_rate_hz: float
    healthy_before: int = 0


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a draw: the truth and the diagnosis."""

    condition: Condition
    disturbances: Disturbances
    diagnosis: Diagnosis


def draw_conditions(draw: Draw) -> tuple[Condition, Disturbances, float]:
    """Condition, disturbances and the time the window starts at.

    All uniform unless said otherwise. Gains and delays: within the class of the motor's sensors, for each of
    the six channels; delays count from the earliest, so that none is negative.
    Resistances: stator and rotor +-10 %, independent; inductances likewise. Harmonics: orders 5 to 13 that
    the rate can show. Swings: of the rated torque. Levels: mu 1 to 19 %, log-uniform. Every factor takes its
    own numbers from the generator whether it is on or not, so that records differ in the factor alone.
    """
    random = np.random.default_rng([draw.index, int(draw.faulty), 20261])
    on = draw.factors
    load = random.uniform(0.0, 1.0)
    start_s = random.uniform(0.0, 1_000.0)
    unbalance = random.uniform(0.0, 0.05) * np.exp(1j * random.uniform(0.0, 2.0 * pi))
    sensors = draw.motor.sensors
    gains = random.uniform(-1.0, 1.0, 6) * np.repeat([sensors.current_gain, sensors.voltage_gain], 3)
    spans = np.repeat([sensors.current_delay_s, sensors.voltage_delay_s], 3)
    delays = random.uniform(0.0, 1.0, 6) * 2.0 * spans
    harmonics = random_harmonics(random, random.uniform(0.0, 0.05), draw.sample_rate_hz)
    frequency = random.uniform(49.0, 51.0)
    swing_frequency = random.uniform(0.5, 10.0)
    factors = random.uniform(0.9, 1.1, 5)
    level = exp(random.uniform(log(LOWEST_LEVEL), log(HIGHEST_LEVEL)))
    winding = int(random.integers(3))
    factors[:2] = factors[:2] if Factor.RESISTANCES in on else 1.0
    factors[2:] = factors[2:] if Factor.INDUCTANCES in on else 1.0
    condition = Condition(
        load_level=float(load),
        unbalance=complex(unbalance) if Factor.UNBALANCE in on else 0.0,
        level=level if draw.faulty else 0.0,
        winding=winding,
    )
    disturbances = Disturbances(
        gain_errors=tuple(gains.tolist()) if Factor.GAINS in on else (0.0,) * 6,
        delays_s=tuple(delays.tolist()) if Factor.DELAYS in on else (0.0,) * 6,
        harmonics=harmonics if Factor.HARMONICS in on else (),
        frequency_hz=float(frequency) if Factor.FREQUENCY in on else 50.0,
        swing=0.1 if Factor.OSCILLATION in on else 0.0,
        swing_frequency_hz=float(swing_frequency),
        parameter_factors=tuple(factors.tolist()),
        noise=NOISE,
    )
    return condition, disturbances, float(start_s)


def judge_draw(draw: Draw) -> Outcome:
    """Make the record and diagnose it with the nameplate's parameters."""
    condition, disturbances, start_s = draw_conditions(draw)
    record = record_of_draw(draw, condition, disturbances, start_s)
    baseline = None
    if draw.healthy_before:
        baseline = learn_baseline(_healthy_before(draw, disturbances), draw.motor)
    return Outcome(condition, disturbances, diagnose(record, draw.motor, baseline=baseline))


def record_of_draw(draw: Draw, condition: Condition, disturbances: Disturbances, start_s: float) -> Recording:
    """Make the record of a draw, in a condition and with disturbances that need not be its own."""
    return disturbed_record(
        draw.motor, condition, disturbances, start_s=start_s, cycles=draw.cycles,
        sample_rate_hz=draw.sample_rate_hz, seed=draw.index,
    )  # fmt: skip


def _healthy_before(draw: Draw, disturbances: Disturbances) -> Iterator[Recording]:
    """Same gains, delays, parameters; load, supply and swing of their own. Refused ones are passed over."""
    found, k = 0, 0
    while found < draw.healthy_before:
        k += 1
        other = replace(draw, index=BASELINE_INDEX * k + draw.index, faulty=False)
        condition, operation, start_s = draw_conditions(other)
        same = replace(
            operation,
            gain_errors=disturbances.gain_errors,
            delays_s=disturbances.delays_s,
            parameter_factors=disturbances.parameter_factors,
        )
        record = record_of_draw(other, condition, same, start_s)
        if diagnose(record, draw.motor).verdict is not Verdict.UNDIAGNOSABLE:
            found += 1
            yield record


@dataclass(frozen=True, slots=True)
class Count:
    """Healthy or faulty records of one kind, counted."""

    outcomes: tuple[Outcome, ...]

    @property
    def verdicts(self) -> Counter[Verdict]:
        return Counter(one.diagnosis.verdict for one in self.outcomes)

    @property
    def faults(self) -> int:
        return self.verdicts[Verdict.FAULT]

    @property
    def named_in_watch(self) -> int:
        """Not called fault, but shorted turns of the right phase suspected."""
        return sum(
            one.diagnosis.verdict is Verdict.WATCH and one.diagnosis.theta_f == one.condition.winding
            for one in self.outcomes
        )

    @property
    def phase_right(self) -> int:
        """Of those called fault."""
        return sum(
            one.diagnosis.theta_f == one.condition.winding
            for one in self.outcomes
            if one.diagnosis.verdict is Verdict.FAULT
        )

    @property
    def levels(self) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        return np.array([one.diagnosis.mu_f for one in self.outcomes if one.diagnosis.mu_f is not None])


def count(draws: Sequence[Draw], label: str, pool: Executor) -> Count:
    return Count(tuple(spread(judge_draw, draws, label, pool)))


def draws_of(prototype: Draw, records: int) -> list[Draw]:
    return [replace(prototype, index=index) for index in range(records)]


ALARM_HEADER = (
    "healthy, called fault (rate; 95 % interval)", "watch", "refused", "mu_f: median, 99 %",
    f"at most {MOST_ALARMS} in {OF_HEALTHY}",
)  # fmt: skip
FOUND_HEADER = (
    "faulty, called fault", "watch, phase named", "watch, none named", "healthy", "refused", "phase right",
    f"{LEAST_FOUND:.0%} found", f"{LEAST_PHASE:.1%} right",
)  # fmt: skip


def alarm_row(healthy: Count) -> list[str]:
    n = len(healthy.outcomes)
    levels = healthy.levels
    spread_text = f"{np.median(levels):.2%}, {np.quantile(levels, 0.99):.2%}" if levels.size else "none"
    return [
        rate_text(healthy.faults, n),
        f"{healthy.verdicts[Verdict.WATCH] / n:.1%}",
        f"{healthy.verdicts[Verdict.UNDIAGNOSABLE] / n:.1%}",
        spread_text,
        _alarm_mark(healthy),
    ]


def _alarm_mark(healthy: Count) -> str:
    n = len(healthy.outcomes)
    if healthy.faults > MOST_ALARMS or healthy.verdicts[Verdict.UNDIAGNOSABLE] > MOST_REFUSED * n:
        return mark(passed=False)
    return mark(passed=True) if n >= OF_HEALTHY else "too few"


def found_row(faulty: Count) -> list[str]:
    n, found = len(faulty.outcomes), faulty.faults
    return [
        rate_text(found, n),
        f"{faulty.named_in_watch / n:.1%}",
        f"{(faulty.verdicts[Verdict.WATCH] - faulty.named_in_watch) / n:.1%}",
        f"{faulty.verdicts[Verdict.HEALTHY] / n:.1%}",
        f"{faulty.verdicts[Verdict.UNDIAGNOSABLE] / n:.1%}",
        f"{faulty.phase_right} of {found}",
        mark(found >= LEAST_FOUND * n),
        mark(found > 0 and faulty.phase_right >= LEAST_PHASE * found),
    ]


def alarms(*, healthy: int, faulty: int, pool: Executor, healthy_before: int = 0) -> Iterator[str]:
    """Healthy and faulty records, 0.5 s at 10 kHz: resistances off; a tenth as many with inductances off too,
    and of other motors."""
    alarm_rows, found_rows = [], []
    kinds = [(REFERENCE, STATED), (REFERENCE, EVERYTHING), *((motor, STATED) for motor in ALL[1:])]
    misses: list[list[str]] = []
    for kind, (motor, factors) in enumerate(kinds):
        share = FURTHER_KINDS if kind else 1
        name = f"{motor.name}, {'all parameters' if factors == EVERYTHING else 'resistances'} off"
        prototype = Draw(
            motor, 0, faulty=False, factors=factors, cycles=25.0, sample_rate_hz=10_000.0,
            healthy_before=healthy_before,
        )  # fmt: skip
        calm = count(draws_of(prototype, max(1, healthy // share)), f"healthy {name}", pool)
        ill = count(
            draws_of(replace(prototype, faulty=True), max(1, faulty // share)), f"faulty {name}", pool
        )
        alarm_rows.append([name, *alarm_row(calm)])
        found_rows.append([name, *found_row(ill)])
        misses.append([name, *found_by_level(ill)])
    yield from table(["motor, parameters", *ALARM_HEADER], alarm_rows)
    yield ""
    yield from table(["motor, parameters", *FOUND_HEADER], found_rows)
    yield ""
    yield "Called fault, by the true level:"
    yield ""
    yield from table(["motor, parameters", *(f"{a:.1%} to {b:.1%}" for a, b in LEVEL_BANDS)], misses)


LEVEL_BANDS = ((0.01, 0.015), (0.015, 0.02), (0.02, 0.03), (0.03, 0.05), (0.05, 0.10), (0.10, 0.19))


def found_by_level(faulty: Count, bands: Sequence[tuple[float, float]] = LEVEL_BANDS) -> list[str]:
    """How many of the faulty ones of each band of levels were called fault."""
    cells = []
    for low, high in bands:
        band = [one for one in faulty.outcomes if low <= one.condition.level < high]
        found = sum(one.diagnosis.verdict is Verdict.FAULT for one in band)
        cells.append(f"{found} of {len(band)}")
    return cells


def causes(*, records: int, pool: Executor) -> Iterator[str]:
    """What each factor does alone to a healthy motor's figures."""
    rows = []
    kinds: list[tuple[str, frozenset[Factor]]] = [
        ("none", frozenset()),
        *((factor.value, frozenset([factor])) for factor in Factor),
        ("unbalance and R_s, R_r", frozenset([Factor.UNBALANCE, Factor.RESISTANCES])),
        ("unbalance and inductances", frozenset([Factor.UNBALANCE, Factor.INDUCTANCES])),
        ("all", EVERYTHING),
    ]
    for name, factors in kinds:
        prototype = Draw(REFERENCE, 0, faulty=False, factors=factors, cycles=25.0, sample_rate_hz=10_000.0)
        rows.append([name, *alarm_row(count(draws_of(prototype, records), name, pool))[:-1]])
    yield from table(["off nominal", *ALARM_HEADER[:-1]], rows)
