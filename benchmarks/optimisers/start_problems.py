"""The cost of a start as a test problem: the thesis's seven unknowns over Table 5.1, random truths.

Records come from the simulator's phase windings (testing/machines/starts.py).
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from core.commissioning.start import Start, thinned
from core.commissioning.start_detection import start_of
from core.machines.candidates import LoadLaw
from core.machines.parameters import MachineParameters, Motor
from core.machines.starting import StartCandidates
from testing.machines.motors import REFERENCE
from testing.machines.starts import StartRecord, plate_of

Array = NDArray[np.float64]

INERTIA_OF_H = 2.0 * REFERENCE.nameplate.pole_pairs / REFERENCE.nameplate.rated_angular_frequency
"""J_m = 2 H p / w_b: what the thesis's equation of motion makes of its H."""
LOWER = np.array([5.0, 5.0, 0.016, 0.3184, 1.0, 0.0, 0.0])
UPPER = np.array([15.0, 15.0, 0.048, 0.6366, 2.0, 1.0, 0.02])
"""Table 5.1 and, last, T_d of section 5.4."""
TRUTH = np.array([8.4, 8.2, 0.0328, 0.4377, 0.0229 / INERTIA_OF_H])
"""Of the thesis's motor (Table 3.2): R_s, R_r', L_ls, L_s, H."""
SYMBOLS = ("R_s", "R_r'", "L_ls", "L_s", "H", "LL", "T_d")


class Box:
    """The cost (5.1) over Table 5.1's box, T_d known or searched."""

    def __init__(self, start: Start, time_offset_s: float | None) -> None:
        self._start = thinned(start)
        self._playback = self._start.playback(LoadLaw.CONSTANT)
        self._offset = time_offset_s
        self.dimensions = 7 if time_offset_s is None else 6
        self.lower, self.upper = LOWER[: self.dimensions], UPPER[: self.dimensions]
        self.bounds = list(zip(self.lower.tolist(), self.upper.tolist(), strict=True))

    def cost(self, points: Array) -> Array:
        """Sums of squared current errors of points (m, 6 or 7) [A^2]."""
        return self._playback.squared_error(self._candidates(points), self._start.measured_ab)

    def residuals(self, points: Array) -> Array:
        """Current errors (m, samples) whose squares sum to the cost [A]."""
        current = self._playback.trajectories(self._candidates(points)).current
        return (current - self._start.measured_ab).reshape(len(points), -1)

    def _candidates(self, points: Array) -> StartCandidates:
        offset = points[:, 6] if self._offset is None else np.full(len(points), self._offset)
        return StartCandidates(
            points[:, 0].copy(), points[:, 1].copy(), points[:, 2].copy(), points[:, 2].copy(),
            points[:, 3].copy(), points[:, 4] * INERTIA_OF_H, points[:, 5].copy(), offset.copy(),
            self._start.switching_flux(offset),
        )  # fmt: skip


def machine_at(point: Array) -> MachineParameters:
    """The machine of a point's first five coordinates."""
    R_s, R_r, L_l, L_s, H = point[:5].tolist()
    return MachineParameters(R_s, R_r, L_l, L_l, L_s, H * INERTIA_OF_H)


@dataclass(frozen=True, slots=True)
class StartProblem:
    """A start, its motor and its truth (7,): R_s, R_r', L_ls, L_s, H, LL, T_d."""

    truth: Array
    motor: Motor
    record: StartRecord
    box: Box


def random_start(seed: int) -> StartProblem:
    """Any motor of Table 5.1 at 10 to 100 % load, T_d 1 to 19 ms, switched on anywhere in the cycle; 1 s at
    10 kHz, 30 dB on the currents. The voltages are those of the busbar: where they were dead before, T_d
    could be read off the record. When the currents begin is given, as a relay's contactor input would: seen
    in the currents it is 0.05 to 0.1 ms early, and that alone moves the cost's minimum by 1 to 2 %.
    """
    random = np.random.default_rng((seed, 7))
    lower, upper = LOWER.copy(), UPPER.copy()
    lower[5:], upper[6] = (0.1, 1e-3), 19e-3
    truth = lower + random.uniform(size=7) * (upper - lower)
    motor = replace(REFERENCE, parameters=machine_at(truth))
    record = StartRecord(
        load_level=float(truth[5]), time_offset_s=float(truth[6]), snr_db=30.0, busbar=True,
        switched_at_s=float(random.uniform(0.0, 0.02)), duration_s=1.025, seed=seed,
    )  # fmt: skip
    plate = plate_of(REFERENCE)
    start = start_of(record.of(motor), plate.nameplate, plate.channels, span_s=(0.0, 1.0))
    start = replace(start, switched_on_s=start.front_s + record.before_s + record.time_offset_s)
    return StartProblem(truth, motor, record, Box(start, None))
