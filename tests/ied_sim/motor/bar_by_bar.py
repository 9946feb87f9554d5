"""A motor with a cage bar by bar, written from the fields in its bore: the reference for the simulated cage.

Nothing is referred or reduced: windings are functions of the angle around the bore, inductances are their
integrals, bars are ohms and henries, and the stator is two sinusoidal windings.
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate
from ied_sim.motor.supply import Supply

Array = NDArray[np.float64]

POINTS = 5040
CLARKE = sqrt(2 / 3) * np.array([[1, -0.5, -0.5], [0, sqrt(3) / 2, -sqrt(3) / 2]])


@dataclass(frozen=True)
class BarByBar:
    """A star motor; resistances [ohm] and leakages [H] of a bar and of a ring segment, of equal ratios."""

    bars: int = 28
    pole_pairs: int = 2
    R_s: float = 0.74
    L_ls: float = 0.003
    gap_H: float = 0.026
    """Inductance of a winding function's mean square around the bore, over its square, times 2 pi."""
    R_bar: float = 0.1
    R_ring: float = 0.004
    L_bar: float = 2.4e-4
    L_ring: float = 0.96e-5
    inertia: float = 0.0343
    load_torque: float = 30.0

    def fields(self, broken: tuple[int, ...]) -> tuple[Array, Array, Array]:
        """Winding functions of the stator and of the rotor at angle 0, and the width of each rotor loop.

        The loops lie between neighbouring whole bars: the ring segments over a broken one are in series.
        """
        round_bore = (np.arange(POINTS) + 0.5) * 2 * pi / POINTS
        stator = sqrt(1.5) * np.array(
            [np.cos(self.pole_pairs * round_bore), np.sin(self.pole_pairs * round_bore)]
        )
        whole = np.array([bar for bar in range(self.bars) if bar not in broken])
        widths = np.diff(np.append(whole, whole[0] + self.bars))
        loops = []
        for first, width in zip(whole, widths, strict=True):
            inside = (round_bore - first * 2 * pi / self.bars) % (2 * pi) < width * 2 * pi / self.bars
            loops.append(inside - inside.mean())
        return stator, np.array(loops), widths

    def matrices(self, broken: tuple[int, ...]) -> tuple[Array, Array, Array]:
        """Resistance and inductance of the rotor's loops, and their coupling to the stator's at angle 0."""
        stator, loops, widths = self.fields(broken)
        count = len(loops)
        chain = 2 * np.eye(count) - np.roll(np.eye(count), 1, axis=0) - np.roll(np.eye(count), -1, axis=0)
        step = self.gap_H * 2 * pi / POINTS
        return (
            self.R_bar * chain + 2 * self.R_ring * np.diag(widths),
            self.L_bar * chain + 2 * self.L_ring * np.diag(widths) + step * loops @ loops.T,
            step * stator @ loops.T,
        )

    @property
    def L_m(self) -> float:
        """Magnetising inductance of the two-phase stator."""
        stator, _, _ = self.fields(())
        return float(self.gap_H * 2 * pi / POINTS * stator[0] @ stator[0])

    def motor(self) -> Motor:
        """The motor of these bars by its phase values, the rotor's as the stator sees the whole cage."""
        R, L, M = self.matrices(())
        # M (R / jw + L)^-1 M' = L_m^2 / (R_r / jw + L_lr + L_m)
        w = 10.0
        answer = (M @ np.linalg.solve(R / (1j * w) + L, M.T))[0, 0]
        seen = self.L_m**2 / answer
        return Motor(
            "bar by bar",
            Nameplate(7_500.0, 400.0, 50.0, self.pole_pairs, Connection.STAR),
            MachineParameters.from_magnetising_inductance(
                stator_resistance_ohm=self.R_s,
                rotor_resistance_ohm=float(-seen.imag * w),
                stator_leakage_H=self.L_ls,
                rotor_leakage_H=float(seen.real) - self.L_m,
                magnetising_inductance_H=self.L_m,
                inertia_kgm2=self.inertia,
            ),
        )

    def start(self, supply: Supply, broken: tuple[int, ...], times: Array) -> tuple[Array, Array]:
        """Line currents, shape (3, n), and speed of a start from rest."""
        R, L, M = self.matrices(broken)
        J = np.array([[0.0, -1.0], [1.0, 0.0]])
        whole = np.zeros((2 + len(R), 2 + len(R)))
        whole[:2, :2] = (self.L_ls + self.L_m) * np.eye(2)
        whole[2:, 2:] = L
        whole[:2, 2:], whole[2:, :2] = M, M.T
        resistance = np.zeros_like(whole)
        resistance[:2, :2], resistance[2:, 2:] = self.R_s * np.eye(2), R
        inverse = np.linalg.inv(whole)

        def turned(angle: float) -> Array:
            return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

        # The stator's fluxes are taken in coordinates of the rotor, in which all inductances are constant.
        def rhs(t: float, y: Array) -> Array:
            angle, speed = y[-1], y[-2]
            currents = inverse @ y[:-2]
            voltage = turned(-angle) @ CLARKE @ supply.phase_voltages(np.array([t]))[:, 0]
            flux_rate = -resistance @ currents
            flux_rate[:2] += voltage - self.pole_pairs * speed * J @ y[:2]
            torque = self.pole_pairs * currents[:2] @ J @ y[:2]
            return np.array([*flux_rate, (torque - self.load_torque) / self.inertia, self.pole_pairs * speed])

        start = np.zeros(len(whole) + 2)
        found = solve_ivp(rhs, (times[0], times[-1]), start, "DOP853", times, rtol=1e-8, atol=1e-10)
        currents = (inverse @ found.y[:-2])[:2]
        angle = found.y[-1]
        stator = np.array(
            [
                np.cos(angle) * currents[0] - np.sin(angle) * currents[1],
                np.sin(angle) * currents[0] + np.cos(angle) * currents[1],
            ]
        )
        return CLARKE.T @ stator, found.y[-2]
