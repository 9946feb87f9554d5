"""Own-physics records against the Cramér-Rao bound, cell by cell, and the coverage of the intervals."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from itertools import product
from math import pi

import numpy as np

from benchmarks.accuracy.bound import bound
from benchmarks.reporting import mark, rate_text, spread, table
from core.diagnosis.methods import DEFAULT_MODEL
from core.diagnosis.stator import diagnose
from core.machines.stator_winding import StatorWinding, WindingKind
from testing.machines.disturbed_records import record_of, rms_noise, steady_samples
from testing.machines.motors import REFERENCE
from testing.machines.steady_faults import Condition, FaultModel

LEVELS = (0.01, 0.05, 0.10, 0.19)
LOADS = (0.12, 0.5, 1.0)
UNBALANCES = (0.0, 0.05, 0.10)
SNR_20_DB = 0.1
"""Standard deviation of the noise over the rms of what it disturbs."""
CONCENTRIC = replace(REFERENCE, winding=StatorWinding(WindingKind.CONCENTRIC, 36, 1))
"""The motor with a winding whose coils lie on their phase's axis."""
MOST_DEVIATION, MOST_BIAS = 1.3, 0.3
"""Accepted, of the bound."""
LEAST_COVERED, MOST_COVERED = 0.92, 0.98
FEWEST_TO_JUDGE = 150
"""Records from which a coverage is told from one outside these limits more often than not."""

CELL_HEADER = (
    "model", "mu", "load", "V2/V1", "bound", "deviation / bound", "efficient", "bias / bound",
    "own bias / bound", "phase right", "",
)  # fmt: skip
AGAIN, AGAIN_FROM = 8, 100_000
"""How many times the seeds a doubtful cell gets in its second measurement, and where those seeds begin."""


@dataclass(frozen=True, slots=True)
class Trial:
    """What one condition is measured with: so many seeds from `first_seed` on.

    in_coil: whether turns in a coil of a concentric winding are weighed, as for any motor of a plant; else
    the model of the thesis that the record is made by is fitted.
    """

    model: FaultModel
    condition: Condition
    samples: int
    sample_rate_hz: float
    voltage_noise: float
    first_seed: int
    seeds: int
    in_coil: bool = False

    @property
    def judged_as(self) -> str:
        return DEFAULT_MODEL.value if self.in_coil else self.model.value


@dataclass(frozen=True, slots=True)
class Estimates:
    """Estimates of one trial, arrays of shape (seeds,) as tuples.

    errors: of mu_f, nan where the recording was refused.  first_order: what the efficient estimator would
    have made of the same noise.  covered: truth inside the interval.
    """

    trial: Trial
    bound: float
    errors: tuple[float, ...]
    first_order: tuple[float, ...]
    covered: int
    phase_right: int

    @property
    def refused(self) -> int:
        return int(np.isnan(self.errors).sum())

    @property
    def deviation(self) -> float:
        """Standard deviation of mu_f over the bound."""
        return float(np.nanstd(self.errors, ddof=1)) / self.bound

    @property
    def efficient_deviation(self) -> float:
        """The same of the efficient estimator on this very noise: what the seeds' luck makes of 1."""
        return float(np.std(self.first_order, ddof=1)) / self.bound

    @property
    def bias(self) -> float:
        """Mean error over the bound."""
        return float(np.nanmean(self.errors)) / self.bound

    @property
    def own_bias(self) -> float:
        """The same without what this very noise does to an efficient, unbiased estimator."""
        return float(np.nanmean(np.subtract(self.errors, self.first_order))) / self.bound


def measure_trial(trial: Trial) -> Estimates:
    """Diagnose one condition's record with the noise of every seed."""
    truth = trial.condition
    true = steady_samples(REFERENCE, trial.model, truth, trial.samples, trial.sample_rate_hz)
    deviations = rms_noise(true, SNR_20_DB, trial.voltage_noise)
    limit = bound(
        REFERENCE, trial.model, truth, noise=deviations, samples=trial.samples,
        sample_rate_hz=trial.sample_rate_hz,
    )  # fmt: skip
    motor = CONCENTRIC if trial.in_coil else REFERENCE
    errors, first_order, covered, right = [], [], 0, 0
    for seed in range(trial.first_seed, trial.first_seed + trial.seeds):
        noise = deviations[:, np.newaxis] * np.random.default_rng(seed).standard_normal(true.shape)
        found = diagnose(record_of(true + noise, trial.sample_rate_hz), motor, model=trial.judged_as)
        first_order.append(limit.first_order_error(noise))
        if found.mu_f is None or found.mu_f_scatter95 is None:
            errors.append(float("nan"))
            continue
        errors.append(found.mu_f - truth.level)
        covered += found.mu_f_scatter95[0] <= truth.level <= found.mu_f_scatter95[1]
        right += found.theta_f == truth.winding
    return Estimates(trial, limit.standard_deviation, tuple(errors), tuple(first_order), covered, right)


def cells(
    *, seeds: int, voltage_noise: float, pool: Executor, sparse: bool, in_coil: bool = False
) -> Iterator[str]:
    """Both fault models, or one judged as turns in a coil, 0.5 s at 10 kHz: a summary and a row a cell."""
    levels, loads, unbalances = (
        (LEVELS[::3], LOADS[::2], UNBALANCES[::2]) if sparse else (LEVELS, LOADS, UNBALANCES)
    )
    trials = [
        Trial(
            model, Condition(load, unbalance, level, k % 3), 5_000, 10_000.0, voltage_noise, 1000 * k, seeds,
            in_coil,
        )
        for model in ((FaultModel.SPLIT,) if in_coil else FaultModel)
        for k, (level, load, unbalance) in enumerate(product(levels, loads, unbalances))
    ]  # fmt: skip
    measured = list(spread(measure_trial, trials, "cells", pool))
    yield from _cell_summary(measured)
    yield ""
    yield from table(CELL_HEADER, [_cell_row(one) for one in measured])
    doubtful = [one.trial for one in measured if one.deviation > MOST_DEVIATION or abs(one.bias) > MOST_BIAS]
    if doubtful:
        yield ""
        yield f"Every cell above {MOST_DEVIATION:g} in deviation or {MOST_BIAS:g} in bias again, with"
        yield f"{AGAIN} times as many seeds, all of them new: what was luck is gone."
        yield ""
        more = [
            replace(trial, first_seed=AGAIN_FROM + trial.first_seed, seeds=AGAIN * seeds)
            for trial in doubtful
        ]
        again = list(spread(measure_trial, more, "cells again", pool))
        yield from table(CELL_HEADER, [_cell_row(one) for one in again])


def _cell_row(one: Estimates) -> list[str]:
    c = one.trial.condition
    passed = (
        one.deviation <= MOST_DEVIATION
        and abs(one.own_bias) <= MOST_BIAS
        and one.phase_right == one.trial.seeds
    )
    return [
        one.trial.judged_as, f"{c.level:.0%}", f"{c.load_level:g}", f"{abs(c.unbalance):.0%}",
        f"{one.bound:.2e}", f"{one.deviation:.2f}", f"{one.efficient_deviation:.2f}",
        f"{one.bias:+.2f}", f"{one.own_bias:+.2f}", f"{one.phase_right} of {one.trial.seeds}",
        mark(passed),
    ]  # fmt: skip


def _cell_summary(measured: Sequence[Estimates]) -> Iterator[str]:
    for model in dict.fromkeys(one.trial.judged_as for one in measured):
        own = [one for one in measured if one.trial.judged_as == model]
        deviations = np.array([one.deviation for one in own])
        biases = np.abs([one.bias for one in own])
        own_biases = np.abs([one.own_bias for one in own])
        right = all(one.phase_right == one.trial.seeds for one in own)
        yield (
            f"- {model}: deviation {np.sqrt(np.mean(deviations**2)):.2f} of the bound over all cells, "
            f"{deviations.max():.2f} in the worst, above {MOST_DEVIATION:g} in "
            f"{int((deviations > MOST_DEVIATION).sum())} of {len(own)}; bias at most {biases.max():.2f}, "
            f"above {MOST_BIAS:g} in {int((biases > MOST_BIAS).sum())}; own bias at most "
            f"{own_biases.max():.2f}, above {MOST_BIAS:g} in {int((own_biases > MOST_BIAS).sum())}; "
            f"phase {'right in all' if right else '**not right in all**'}."
        )


def random_trials(
    model: FaultModel, records: int, samples: int, sample_rate_hz: float, voltage_noise: float
) -> list[Trial]:
    """One record each of random conditions: mu 0 to 19 %, load 0 to 1, V2/V1 0 to 10 % at any angle."""
    random = np.random.default_rng(list(model.value.encode()))
    trials = []
    for seed in range(records):
        unbalance = random.uniform(0.0, 0.1) * np.exp(1j * random.uniform(0.0, 2.0 * pi))
        condition = Condition(
            load_level=float(random.uniform(0.0, 1.0)),
            unbalance=complex(unbalance),
            level=float(random.uniform(0.0, 0.19)),
            winding=int(random.integers(3)),
        )
        trials.append(Trial(model, condition, samples, sample_rate_hz, voltage_noise, 500_000 + seed, 1))
    return trials


def coverage_row(measured: Sequence[Estimates]) -> list[str]:
    """Coverage, root mean square error and mean error over the bound, and phases, of single-record trials."""
    kept = [one for one in measured if not one.refused]
    if not kept:
        return ["", str(len(measured)), "", "", "", mark(passed=False)]
    covered = sum(one.covered for one in kept)
    scaled = np.array([one.errors[0] / one.bound for one in kept])
    beyond = np.array([(one.errors[0] - one.first_order[0]) / one.bound for one in kept])
    visible = [one for one in kept if one.trial.condition.level >= 0.01]
    right = sum(one.phase_right for one in visible)
    share = covered / len(kept)
    return [
        rate_text(covered, len(kept)),
        str(len(measured) - len(kept)),
        f"{np.sqrt(np.mean(scaled**2)):.2f}",
        f"{beyond.mean():+.2f}",
        f"{right} of {len(visible)}",
        mark(LEAST_COVERED <= share <= MOST_COVERED) if len(kept) >= FEWEST_TO_JUDGE else "too few",
    ]


COVERAGE_HEADER = (
    "covered", "refused", "rms error / bound", "own bias / bound", "phase right, mu 1 % and more",
    "covered 92 to 98 %",
)  # fmt: skip


def coverage(*, records: int, pool: Executor) -> Iterator[str]:
    """Coverage of the 95 % intervals, 0.5 s at 10 kHz."""
    rows = []
    for model, voltage_noise in product(FaultModel, (0.0, SNR_20_DB)):
        trials = random_trials(model, records, 5_000, 10_000.0, voltage_noise)
        measured = list(spread(measure_trial, trials, f"coverage {model.value}", pool))
        noise = "currents and voltages" if voltage_noise else "currents"
        rows.append([model.value, noise, *coverage_row(measured)])
    yield from table(["model", "noise on", *COVERAGE_HEADER], rows)
