"""The motor's cost as a test problem: records of random truths, and what an optimiser sees of them.

Records come from the simulator's phase windings (testing/machines/disturbed_records.py), 0.5 s at 10 kHz in
steady running, with noise on all channels and currents that lag the voltages by any part of a cycle
(Table 6.2).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.case import Case, case_of, thinned
from core.diagnosis.search import candidates_at
from core.machines.base import StatorModel
from core.machines.playback import Playback
from core.machines.split_winding import SplitWinding
from core.signals.clarke import clarke
from core.signals.sequence import PhaseSequence
from testing.machines.disturbed_records import rms_noise, steady_samples
from testing.machines.motors import REFERENCE
from testing.machines.steady_faults import Condition, FaultModel

Array = NDArray[np.float64]

SAMPLE_RATE_HZ = 10_000.0
CYCLE_S = 0.02
RECORD_CYCLES = 28
"""What is compared, 0.5 s, and a cycle each for the delay, the model's settling and the end."""
BOUNDS = ((0.0, 0.2), (0.0, 2.0), (0.0, CYCLE_S), (0.0, 1.25))
"""mu_f, theta_f, T_d [s], LL: Table 6.2, with overload."""
NAMES = ("mu_f", "theta_f", "T_d", "LL")
WINDINGS = (0.0, 1.0, 2.0)


@dataclass(frozen=True, slots=True)
class MotorProblem:
    """A record and its truth (4,): mu_f, theta_f, T_d, LL."""

    truth: Array
    case: Case
    playback: Playback

    def cost(self, points: Array) -> Array:
        """Sums of squared current errors of points (m, 4) [A^2] (6.25); theta_f is rounded."""
        return self.playback.squared_error(candidates_at(points), self.case.current_ab)

    def residuals(self, points: Array) -> Array:
        """Current errors (m, samples) whose squares sum to the cost [A]."""
        window = self.case.window
        measured = self.case.current_ab[:, window.first : window.last]
        errors = self.playback.trajectories(candidates_at(points)).current - measured
        return errors[:, :, window.compare_from - window.first :].reshape(len(points), -1)

    def is_close(self, points: Array, share: float) -> NDArray[np.bool_]:
        """Which points (m, 4) have the winding right and all else within a share of its true value."""
        right = np.round(points[:, 1]) == self.truth[1]
        rest = np.array([0, 2, 3])
        error = np.abs(points[:, rest] / self.truth[rest] - 1.0)
        return np.asarray(right & (error <= share).all(axis=1))


def motor_problem(
    truth: Array,
    *,
    seed: int,
    snr_db: float = 30.0,
    unbalance: complex = 0.0,
    cycles: int = RECORD_CYCLES,
    thin: bool = True,
    model: StatorModel | None = None,
    physics: FaultModel = FaultModel.SPLIT,
) -> MotorProblem:
    """A record of one truth [mu_f, theta_f, T_d, LL]; T_d is rounded to a sample.

    thin: compare at the rate the diagnosis searches at.
    """
    lag = round(truth[2] * SAMPLE_RATE_HZ)
    samples = round(cycles * CYCLE_S * SAMPLE_RATE_HZ)
    condition = Condition(float(truth[3]), unbalance, float(truth[0]), int(truth[1]))
    true = _steady(condition, physics, samples + 2 * round(CYCLE_S * SAMPLE_RATE_HZ))
    shift = round(CYCLE_S * SAMPLE_RATE_HZ)
    seen = np.vstack([true[:3, shift - lag : shift - lag + samples], true[3:, shift : shift + samples]])
    level = 10.0 ** (-snr_db / 20.0)
    noise = rms_noise(seen, level, level)[:, np.newaxis]
    seen = seen + noise * np.random.default_rng(seed).standard_normal(seen.shape)
    case = case_of(REFERENCE, seen[:3], clarke(seen[3:]), SAMPLE_RATE_HZ, 1.0 / CYCLE_S, PhaseSequence.ABC)
    if thin:
        case = thinned(case)
    playback = Playback(model or SplitWinding(), REFERENCE, case.supply, case.window)
    held = np.array([truth[0], truth[1], lag / SAMPLE_RATE_HZ, truth[3]])
    return MotorProblem(held, case, playback)


def random_truth(seed: int) -> Array:
    """mu_f 2 to 19 %, any winding, T_d 1 to 19 ms, load 10 to 100 %."""
    random = np.random.default_rng((seed, 6))
    return np.array(
        [
            random.uniform(0.02, 0.19),
            random.integers(3),
            random.uniform(1e-3, 19e-3),
            random.uniform(0.1, 1.0),
        ]
    )


def random_problem(seed: int) -> MotorProblem:
    """A random truth on a supply unbalanced by up to 2 %, SNR 30 dB on every channel."""
    random = np.random.default_rng((seed, 2))
    unbalance = random.uniform(0.0, 0.02) * np.exp(2j * np.pi * random.random())
    return motor_problem(random_truth(seed), seed=seed, unbalance=complex(unbalance))


@lru_cache(maxsize=8)
def _steady(condition: Condition, physics: FaultModel, samples: int) -> Array:
    """The slow part, kept while seeds and lengths vary."""
    return steady_samples(REFERENCE, physics, condition, samples, SAMPLE_RATE_HZ)


Cost = Callable[[Array], Array]
