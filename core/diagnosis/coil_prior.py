"""What is known of shorted turns before a record is looked at: on which axis they lie, and of their leakage.

The leakage psi of turns inside one coil is c N m: N the coils of a phase, m the equivalent level, and c about
1 (`core.machines.coil_fault`). That is a lognormal distribution about c N m. Shorts over several coils, and
turns that do not fill their slot, have any other; a uniform one holds them. Multi-circuit models of windings
have c of 0.4 to 1.4 in lap windings, of 1.3 to 1.9 in windings of one layer (docs/evidence/winding.md).

Turns of whole coils on their phase's axis, which share no slot with the rest of the phase, are the split
winding of Tallam, Habetler and Harley: psi = 1. That one point has a probability of its own.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import log, radians
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.model_names import Model
from core.machines.parameters import Motor
from core.machines.stator_winding import WindingKind, axes_of_coils_per_group
from core.machines.steady_state import ComplexArray
from core.signals.sequence import PhaseSequence

INSIDE_ONE_COIL: Final = 0.6
"""Probability of turns inside one coil that fill its slots as the others do."""
LEAKAGE_SCATTER: Final = 0.35
"""Standard deviation of ln(psi / (c N m))."""
OF_LAP, OF_ONE_LAYER, OF_SLIP_RINGS = 1.0, 1.6, 8.0
"""c of lap windings, of windings with one layer, and of stators over a rotor that does not damp harmonics."""
USUAL_COILS: Final = (6, 8, 12, 18, 24)
"""Coils of a phase where the winding is not known."""
USUAL_COILS_PER_GROUP: Final = (2, 3, 4)
ON_PHASE_AXIS: Final = 0.5
"""Probability that turns of an unknown winding lie on their phase's axis, as in windings of one layer."""
WHOLE_COILS, WHOLE_CONCENTRIC_COILS = 0.1, 0.3
"""Probability of turns that share no slot with the rest, on the axis of their phase, where coils lie
there."""
AXIS_STEP_RAD: Final = radians(4.0)
AXIS_SPREAD_RAD, FULL_PITCH_SPREAD_RAD = radians(3.0), radians(5.0)
"""Standard deviations of the axis that a coil appears to have; of full pitch it is up to 6 degrees beside."""
LEAKAGES: Final = np.array([0.01, 0.05, 0.1, 0.17, 0.26, 0.37, 0.5, 0.64, 0.8, 1.0, 1.3, 1.7])
"""Leakages that are weighed; 1 is one of them."""
OWN: Final = int(np.flatnonzero(LEAKAGES == 1.0)[0])
"""Index of psi = 1."""
IMPOSSIBLE: Final = 1e-9
_FINE: Final = np.linspace(LEAKAGES[0], LEAKAGES[-1], 400)
_LOG_LEVELS: Final = np.linspace(log(4e-4), log(0.5), 64)


@dataclass(frozen=True)
class TurnsPrior:
    """Places of shorted turns and what is known of them.

    Parameters
    ----------
    motor : Motor
        The motor, with its stator's winding where that is known.
    angle_rad, linkage, weight : ndarray, shape (axes,)
        Angle of each axis from the phase's, in the frame of the windings [rad]; linkage over that of the mean
        turn; probability.
    leakage : ndarray, shape (leakages,)
        psi that are weighed.
    whole_coils : float
        Probability of turns with all their leakage to themselves, on the phase's axis.
    """

    motor: Motor
    angle_rad: Array
    linkage: Array
    weight: Array
    leakage: Array
    whole_coils: float

    @cached_property
    def ahead(self) -> ComplexArray:
        """exp(j delta) / k_d of each axis."""
        return np.asarray(self.linkage * np.exp(1j * self.angle_rad))

    @cached_property
    def coarse(self) -> "TurnsPrior":
        """The same with fewer axes and leakages; the phase's own axis and psi = 1 are among them."""
        if self.leakage.size == 1:
            return self
        middle = int(np.argmin(np.abs(self.angle_rad)))
        axes = np.arange(middle % 2, self.angle_rad.size, 2)
        weight = self.weight[axes]
        leakages = np.arange(OWN % 2, self.leakage.size, 2)
        return TurnsPrior(
            self.motor,
            self.angle_rad[axes],
            self.linkage[axes],
            weight / weight.sum(),
            self.leakage[leakages],
            self.whole_coils,
        )

    def usual_leakage(self, level: float) -> float:
        """Return the leakage that half of the shorted turns of a level have more of."""
        below = np.exp(self.log_density(np.array([level]))).sum(axis=(0, 2)).cumsum()
        return float(np.interp(0.5, below, self.leakage))

    def nearest(self, finer: "TurnsPrior") -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return which axis and leakage of this one are nearest to those of a finer one, as an open mesh."""
        axes = np.abs(finer.angle_rad[:, np.newaxis] - self.angle_rad).argmin(axis=1)
        leakages = np.abs(np.log(finer.leakage[:, np.newaxis] / self.leakage)).argmin(axis=1)
        return np.ix_(axes, leakages)

    def log_density(self, levels: Array) -> Array:
        """Return the log of the probability of each place."""
        if self.leakage.size == 1:
            return np.zeros((1, 1, levels.size))
        table = _leakage_table(self.motor, self.leakage.tobytes())
        at = (np.log(levels) - _LOG_LEVELS[0]) / (_LOG_LEVELS[1] - _LOG_LEVELS[0])
        below = np.clip(at.astype(np.int64), 0, _LOG_LEVELS.size - 2)
        by_leakage = table[:, below] + (at - below) * (table[:, below + 1] - table[:, below])
        places = (1.0 - self.whole_coils) * self.weight[:, np.newaxis, np.newaxis] * by_leakage
        on_axis = int(np.argmin(np.abs(self.angle_rad)))
        places[on_axis, int(np.argmin(np.abs(self.leakage - 1.0)))] += self.whole_coils
        return np.asarray(np.log(places + IMPOSSIBLE))


@lru_cache(maxsize=256)
def turns_prior(motor: Motor, sequence: PhaseSequence, model: str) -> TurnsPrior:
    """Return what is known of a motor's shorted turns."""
    if model != Model.COIL:
        one = np.ones(1)
        return TurnsPrior(motor, np.zeros(1), one, one, one, 1.0)
    pole_pairs, winding = motor.nameplate.pole_pairs, motor.winding
    spread = AXIS_SPREAD_RAD
    if winding is not None:
        axes = winding.coil_axes(pole_pairs)
        about = [(one.angle_rad, one.linkage, 1.0 / len(axes)) for one in axes]
        if winding.is_full_pitch(pole_pairs):
            spread = FULL_PITCH_SPREAD_RAD
    else:
        groups = (*USUAL_COILS_PER_GROUP, 6) if pole_pairs == 1 else USUAL_COILS_PER_GROUP
        about = [(0.0, 1.0, ON_PHASE_AXIS)]
        for coils in groups:
            share = (1.0 - ON_PHASE_AXIS) / len(groups) / coils
            about += [(one.angle_rad, one.linkage, share) for one in axes_of_coils_per_group(coils)]
    outermost = max(abs(angle) for angle, _, _ in about)
    steps = round((outermost + 2.0 * spread) / AXIS_STEP_RAD)
    angle = AXIS_STEP_RAD * np.arange(-steps, steps + 1)
    density = np.empty((len(about), angle.size))
    for row, (middle, _, share) in zip(density, about, strict=True):
        row[:] = np.exp(-0.5 * ((angle - middle) / spread) ** 2)
        row *= share / row.sum()
    weight = density.sum(axis=0)
    linkage = np.array([one for _, one, _ in about]) @ density / weight
    # Rows are far from some axes: what is left there is no reason to look.
    likely = weight > IMPOSSIBLE
    turned = -angle if sequence is PhaseSequence.ACB else angle
    concentric = winding is not None and winding.kind is WindingKind.CONCENTRIC
    whole = WHOLE_CONCENTRIC_COILS if concentric else WHOLE_COILS
    return TurnsPrior(motor, turned[likely], linkage[likely], weight[likely], LEAKAGES, whole)


def leakage_density(motor: Motor, levels: Array, leakages: Array) -> Array:
    """Return the probability density of each leakage at each level, shape (leakages, levels)."""
    winding = motor.winding
    coils = USUAL_COILS if winding is None else (winding.coils_per_phase,)
    c = OF_LAP
    if winding is not None and (winding.layers == 1 or winding.kind is WindingKind.CONCENTRIC):
        c = OF_ONE_LAYER
    if motor.wound_rotor is not None:
        c = OF_SLIP_RINGS
    psi = leakages[:, np.newaxis]
    inside = np.zeros((leakages.size, levels.size))
    for N in coils:
        # Beyond the leakages that are weighed, the last one stands for all.
        middle = log(c) + np.minimum(np.log(N * levels), 0.0)
        middle = np.clip(middle, log(LEAKAGES[0]), log(LEAKAGES[-1]))
        inside += np.exp(-0.5 * ((np.log(psi) - middle) / LEAKAGE_SCATTER) ** 2) / psi
    width = np.gradient(leakages)
    inside /= width @ inside
    uniform = (leakages <= 1.0) / (width @ (leakages <= 1.0))
    return np.asarray(INSIDE_ONE_COIL * inside + (1.0 - INSIDE_ONE_COIL) * uniform[:, np.newaxis])


@lru_cache(maxsize=256)
def _leakage_table(motor: Motor, leakages: bytes) -> Array:
    """Return the probability of each leakage at each of _LOG_LEVELS, shape (leakages, levels)."""
    nodes = np.frombuffer(leakages)
    density = leakage_density(motor, np.exp(_LOG_LEVELS), _FINE)
    # The density is shared among the leakages that are weighed, each taking what is nearest to it.
    shares = np.array([np.interp(_FINE, nodes, one) for one in np.eye(nodes.size)])
    found = shares @ density
    return np.asarray(found / found.sum(axis=0))
