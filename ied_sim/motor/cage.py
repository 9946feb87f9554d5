"""A cage of bars, some of them broken: the loops between its bars, reduced to the few that a motor needs.

N bars make N loops, each of two neighbouring bars and the two ring segments between them. With b_k = i_k -
i_(k-1) the current of bar k,

    R = D' diag(R_b) D + 2 R_e I,    L = L_b D' D + 2 L_e I + (2 L_s / N) (I - 1 1' / N)

where the last term is the air-gap field of the loops, of all numbers of poles; the stator links only that
of its own p pole pairs. A broken bar carries no current: its two loops are one. A cracked one has lost a
share of its conductance. Bars are insulated from the iron and the core is not saturated, so no current
crosses between bars.

R_b, R_e, L_b and L_e follow from the phase values of the parameters: those of a cage without a fault are

    R_r = 3 (pi p)^2 / N (R_b + R_e / (2 sin^2(pi p / N))),    L_lr likewise
        + 3/2 L_s ((pi p / N)^2 / sin^2(pi p / N) - 1)

with the turns of a stator phase sinusoidally distributed; the last term is the leakage of the field's other
numbers of poles.

Four distributions of the currents are kept for each axis: two that the resistances make as the slip goes to
zero, two that the inductances make as it grows. The projection keeps reciprocity and energy.

References: Munoz and Lipo, doi:10.1109/28.793371 (loops of a cage); Odabasioglu, Celik and Pileggi,
doi:10.1109/43.712097 (projection).
"""

from dataclasses import dataclass
from functools import lru_cache
from math import pi, sin

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import MachineParameters
from ied_sim.motor.rotor import RotorLoops

Matrix = NDArray[np.float64]

_DEPENDENT = 1e-9
"""A distribution of currents this close to the others, relative to the largest, is one of them."""


@dataclass(frozen=True, slots=True)
class Cage:
    """Bars of a cage and its end rings.

    Parameters
    ----------
    bars : int
        Number of bars N.
    ring_share : float
        Share of the rings in the cage's resistance, and in its leakage of slots and rings.
    places : tuple of int
        Bars 0 to N - 1 in the order in which they break; those that are not named follow in theirs.
    """

    bars: int = 28
    ring_share: float = 0.25
    places: tuple[int, ...] = ()

    def lost_conductance(self, broken_share: float) -> Matrix:
        """Return the share of its conductance that each bar has lost, shape (N,): 1 where it is broken.

        `broken_share` is that of all bars. Where it makes no whole number, the last bar is cracked.
        """
        order = [*self.places, *(bar for bar in range(self.bars) if bar not in self.places)]
        lost = np.zeros(self.bars)
        lost[order] = np.clip(broken_share * self.bars - np.arange(self.bars), 0.0, 1.0)
        # A number of bars over their number need not come back from floating point as a whole one.
        return np.where(lost > 1 - 1e-6, 1.0, np.where(lost < 1e-6, 0.0, lost))

    def spread_leakage(self, parameters: MachineParameters, pole_pairs: int) -> float:
        """Return the leakage of the field's other numbers of poles [H]; it is part of the rotor's."""
        half_pitch = pi * pole_pairs / self.bars
        return parameters.magnetising_inductance_H * ((half_pitch / sin(half_pitch)) ** 2 - 1)

    def bar_and_ring(self, of_phase: float, pole_pairs: int) -> tuple[float, float]:
        """Return what a bar and a segment of a ring have of a phase's resistance or leakage, in its unit."""
        per_phase = 3 * (pi * pole_pairs) ** 2 / self.bars
        ring = 2 * sin(pi * pole_pairs / self.bars) ** 2
        return (1 - self.ring_share) * of_phase / per_phase, self.ring_share * of_phase / per_phase * ring


USUAL_CAGE = Cage()


@lru_cache(maxsize=256)
def cage_loops(parameters: MachineParameters, pole_pairs: int, cage: Cage, broken_share: float) -> RotorLoops:
    """Return the loops of a cage, `broken_share` of whose bars are broken.

    Parameters
    ----------
    parameters : MachineParameters
        Those of the motor with a whole cage.
    pole_pairs : int
        Pole pairs p.
    cage : Cage
        Its bars and rings.
    broken_share : float
        Broken bars over N.

    Returns
    -------
    RotorLoops
        At most eight loops; two where all bars are alike.

    Raises
    ------
    ValueError
        If the bars are too few for the rotor's leakage.
    """
    whole = _bar_loops(parameters, pole_pairs, cage, cage.lost_conductance(broken_share))
    kept = _distributions(whole)
    return RotorLoops(
        leakage=kept.T @ whole.leakage @ kept,
        gap=kept.T @ whole.gap @ kept,
        resistance=kept.T @ whole.resistance @ kept,
        axes=whole.axes @ kept,
    )


def _distributions(loops: RotorLoops) -> Matrix:
    """Return currents that span the loops' answer to the stator at low and at high slip, shape (m, k).

    Their answer at the slip frequency w is (R + j w L)^-1, in powers of w and of 1 / w.
    """
    R, L = loops.resistance, loops.leakage + loops.gap
    slow = np.linalg.solve(R, loops.axes.T)
    fast = np.linalg.solve(L, loops.axes.T)
    currents = np.hstack((slow, np.linalg.solve(R, L @ slow), fast, np.linalg.solve(L, R @ fast)))
    directions, sizes, _ = np.linalg.svd(currents / np.linalg.norm(currents, axis=0), full_matrices=False)
    kept: Matrix = directions[:, sizes > _DEPENDENT * sizes[0]]
    return kept


def _bar_loops(
    parameters: MachineParameters, pole_pairs: int, cage: Cage, lost_conductance: Matrix
) -> RotorLoops:
    """Return all loops between bars that are not broken."""
    N = cage.bars
    half_pitch = pi * pole_pairs / N
    own_leakage = parameters.rotor_leakage_H - cage.spread_leakage(parameters, pole_pairs)
    if own_leakage <= 0:
        raise ValueError(
            f"{N} bars are too few for {pole_pairs} pole pairs and a rotor leakage of "
            f"{parameters.rotor_leakage_H:g} H: the leakage of their steps in the field alone is larger"
        )
    R_b, R_e = cage.bar_and_ring(parameters.rotor_resistance_ohm, pole_pairs)
    L_b, L_e = cage.bar_and_ring(own_leakage, pole_pairs)

    whole = lost_conductance < 1
    joined = np.eye(whole.sum())[(np.cumsum(whole) - 1) % whole.sum()]
    bars = joined - np.roll(joined, 1, axis=0)
    bar_resistance = R_b / np.where(whole, 1 - lost_conductance, 1.0)
    segments = joined.T @ joined
    width = joined.sum(axis=0)
    centre = pole_pairs * 2 * pi * (np.arange(N) + 0.5) / N
    field = 2 / (pi * pole_pairs) * sin(half_pitch)
    return RotorLoops(
        leakage=L_b * bars.T @ bars + 2 * L_e * segments,
        gap=2 * parameters.stator_self_inductance_H / N * (segments - np.outer(width, width) / N),
        resistance=bars.T @ (bar_resistance[:, None] * bars) + 2 * R_e * segments,
        axes=field * np.vstack((np.cos(centre), np.sin(centre))) @ joined,
    )
