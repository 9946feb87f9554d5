"""What shorted turns look like in the measurements, over their coil's axis and their leakage.

The signature is that of `core.machines.coil_fault`, at a nominal slip. It is given per equivalent level, for
winding 0: of winding x that in y is turned by a^x, that in the current is the same.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import atan, ceil, pi, radians, tan
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.condition.measuring.impedance import RATED_SLIP, WARM, negative_impedance
from core.diagnosis.coil_prior import AXIS_STEP_RAD, LEAKAGES, leakage_density, turns_prior
from core.diagnosis.priors import MISFIT
from core.machines.base import Array
from core.machines.coil_fault import AirGap, SequencePair, air_gap, faulty_currents
from core.machines.compiled import compiled_as_written as compiled
from core.machines.model_names import Model
from core.machines.parameters import Connection, Motor
from core.signals.sequence import PhaseSequence

ComplexArray = NDArray[np.complex128]

HALF_WARM: Final = 1.1
"""R_s in what shorted turns show, over that of the motor's file. It is between that of a cold winding (1) and
of one at work (`impedance.WARM`), because R_s scales the level that is told. The filter learns by how much
Z2 is another, but not R_s: with a figure between, a level is as little too high as too low."""
Steps = tuple[int, float]
ROUGH: Final[Steps] = (2, radians(15.0))
COARSE: Final[Steps] = (2, radians(5.0))
FINE: Final[Steps] = (1, radians(3.0))
"""Steps of the axes, in those of `coil_prior`, and of the angle of R_s + j psi X_ls: for what stands, for a
cause, and for a level."""
LEVELS: Final = np.geomspace(5e-4, 0.4, 24)
"""Levels at which the probability of a leakage is known."""
AT_LEVEL: Final = 0.01
"""Level at which the signature is taken: it turns and shrinks a little with many turns."""
LEAST_LEAKAGE, MOST_LEAKAGE = 1e-3, float(LEAKAGES[-1])
SUMMED_LEAKAGES: Final = 600
"""Leakages over which the prior is summed up."""
STATOR: Final = 0.08
"""Relative standard deviation of R_s over X_ls, which turns the signature."""
MACHINE, RESISTANCE = 0.06, 0.12
"""Relative standard deviations of the leakage and of R_s, which a motor's file gives at some temperature.
What a level adds goes with them."""


@dataclass(frozen=True, slots=True)
class TurnsGrid:
    """Shorted turns by axis and leakage, one node each, in winding 0.

    Parameters
    ----------
    axis_rad, leakage : ndarray, shape (nodes,)
        Angle of the coil's axis from its phase's in the frame of the windings [rad], and psi.
    y, current : ndarray of complex, shape (nodes,)
        What they add to y and to z I1/V1, per equivalent level.
    direction, scale : ndarray, shape (nodes,)
        Standard deviation of the signatures' direction [rad], and of their size, relatively.
    shares : ndarray, shape (levels, nodes)
        Probability of each node at each of LEVELS.
    """

    axis_rad: Array
    leakage: Array
    y: ComplexArray
    current: ComplexArray
    direction: Array
    scale: Array
    shares: Array

    @property
    def usual(self) -> Array:
        """Probability of each node at the level at which the signatures are taken."""
        return np.asarray(self.shares[int(np.argmin(np.abs(LEVELS - AT_LEVEL)))])

    @property
    def mean(self) -> complex:
        """What turns of winding 0 add to y on the average: mean size in the mean direction."""
        mean = complex(self.usual @ self.y)
        return mean / abs(mean) * float(self.usual @ np.abs(self.y))


@lru_cache(maxsize=1024)
def turns_grid(motor: Motor, sequence: PhaseSequence, scale_ohm: float, steps: Steps = COARSE) -> TurnsGrid:
    """Return what shorted turns of a motor look like.

    Parameters
    ----------
    motor : Motor
        The motor, with its stator's winding where that is known.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals: an a-c-b supply mirrors the axes.
    scale_ohm : float
        Impedance z that the currents are multiplied by [ohm].
    steps : tuple of int and float, default COARSE
        How near the nodes lie.

    Returns
    -------
    TurnsGrid
        The nodes.
    """
    every, step = steps
    machine, f = motor.parameters, motor.nameplate.rated_frequency_Hz
    w = 2.0 * pi * f
    R_s, X_ls = HALF_WARM * machine.stator_resistance_ohm, w * machine.stator_leakage_H
    angles, linkage, axis_shares = _axes(motor, sequence, every)
    most = atan(MOST_LEAKAGE * X_ls / R_s)
    phi = np.linspace(0.0, most, max(ceil(most / step), 2) + 1)
    leakage = R_s / X_ls * np.array([tan(angle) for angle in phi.tolist()])
    gap = air_gap(
        complex(WARM * machine.stator_resistance_ohm, X_ls), w * machine.magnetising_inductance_H,
        WARM * machine.rotor_resistance_ohm, w * machine.rotor_leakage_H, RATED_SLIP, *motor.backward_rotor,
    )  # fmt: skip
    circulating = 1.0 / 3.0 if motor.nameplate.connection is Connection.DELTA else 0.0
    ahead = (linkage * np.exp(1j * angles)).astype(np.complex128)
    i1, i2 = _drawn(gap, ahead, (R_s + 1j * X_ls * leakage).astype(np.complex128), circulating)
    cos2 = np.tile(np.cos(phi) ** 2, angles.size)
    between = axis_shares[:, np.newaxis] * _leakage_shares(motor, leakage)[:, np.newaxis, :]
    return TurnsGrid(
        axis_rad=np.repeat(angles, phi.size),
        leakage=np.tile(leakage, angles.size),
        y=-negative_impedance(motor, f) * i2,
        current=scale_ohm * i1,
        direction=np.hypot(0.25 * step + MISFIT, STATOR * np.sqrt(cos2 * (1.0 - cos2))),
        scale=np.hypot(MACHINE, RESISTANCE * cos2),
        shares=between.reshape(LEVELS.size, -1),
    )


def _axes(motor: Motor, sequence: PhaseSequence, every: int) -> tuple[Array, Array, Array]:
    """Return angle, linkage and probability of every so many axes; those between count for both."""
    known = turns_prior(motor, sequence, Model.COIL)
    steps = np.rint(np.abs(known.angle_rad) / AXIS_STEP_RAD).astype(np.int64) * np.sign(known.angle_rad)
    outermost = int(np.abs(steps).max())
    reach = ceil(outermost / every)
    kept = np.arange(-reach, reach + 1)
    near = np.maximum(0.0, 1.0 - np.abs(steps[np.newaxis, :] / every - kept[:, np.newaxis]))
    weight = near @ known.weight
    linkage = (near @ (known.weight * known.linkage)) / np.maximum(weight, 1e-300)
    held = weight > 1e-6
    return (
        every * AXIS_STEP_RAD * kept[held].astype(np.float64),
        linkage[held],
        weight[held] / weight[held].sum(),
    )


def _leakage_shares(motor: Motor, nodes: Array) -> Array:
    """Return the probability of each leakage at each of LEVELS, shape (levels, nodes)."""
    leakage = np.geomspace(LEAST_LEAKAGE, MOST_LEAKAGE, SUMMED_LEAKAGES)
    density = leakage_density(motor, LEVELS, leakage).T * leakage
    above = np.clip(np.searchsorted(nodes, leakage), 1, nodes.size - 1)
    share = np.clip((leakage - nodes[above - 1]) / (nodes[above] - nodes[above - 1]), 0.0, 1.0)
    hats = np.zeros((leakage.size, nodes.size))
    rows = np.arange(leakage.size)
    hats[rows, above] += share
    hats[rows, above - 1] += 1.0 - share
    found = density @ hats
    return np.asarray(found / found.sum(axis=1, keepdims=True))


@compiled
def _drawn(
    gap: AirGap, ahead: ComplexArray, branch: ComplexArray, circulating: float
) -> tuple[ComplexArray, ComplexArray]:
    """Return what turns of winding 0 add to I1 and I2 over V1, per level; branch: R_s + j psi X_ls."""
    nodes = ahead.size * branch.size
    i1, i2 = np.empty(nodes, np.complex128), np.empty(nodes, np.complex128)
    healthy = 1.0 / (gap.stator + gap.forward)
    for a in range(ahead.size):
        for k in range(branch.size):
            found = faulty_currents(
                gap, SequencePair(1.0 + 0j, 0j), branch[k] / AT_LEVEL, ahead[a], ahead[a].conjugate(),
                circulating, 0,
            )  # fmt: skip
            i1[a * branch.size + k] = (found.positive - healthy) / AT_LEVEL
            i2[a * branch.size + k] = found.negative / AT_LEVEL
    return i1, i2
