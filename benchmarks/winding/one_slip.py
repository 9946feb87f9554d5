"""What shorted turns inside a coil change in I1 and I2 at one slip, by equations of a few numbers.

The equations are those of `core.machines.coil_fault`, with which the diagnosis works.

m = mu/(1 + p) is the equivalent level, and psi = (kappa + (1 - kappa) mu)/(1 + p) says how much of the
leakage is not coupled: kappa is 1 for turns that leak for themselves, and about c N mu inside one of N coils.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from core.machines.coil_fault import AirGap, SequencePair, air_gap, faulty_currents
from core.machines.parameters import Connection, Motor

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
TURN = np.exp(2j * np.pi / 3)
BETWEEN_LINES = complex(1 - TURN)
"""Line over winding current of a delta, a-b-c; its conjugate is winding over line voltage."""
STARTS = (0.05, 0.5, 3.0)
"""Of kappa, from which it is sought."""


@dataclass(frozen=True, slots=True)
class Terminals:
    """A motor at one slip, as the terminals of its windings see it [ohm, V]; V1 and V2 are the windings'."""

    R_s: float
    gap: AirGap
    voltage: SequencePair
    delta: bool = False

    @classmethod
    def of(cls, motor: Motor, slip: float, V1: complex, V2: complex) -> "Terminals":
        """Those of a motor on phase voltages of sequence V1 and V2, at a slip."""
        machine, w = motor.parameters, motor.nameplate.rated_angular_frequency
        z = complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H)
        X_m, X_lr = w * machine.magnetising_inductance_H, w * machine.rotor_leakage_H
        delta = motor.nameplate.connection is Connection.DELTA
        voltage = SequencePair(
            complex(V1 * BETWEEN_LINES.conjugate() if delta else V1),
            complex(V2 * BETWEEN_LINES if delta else V2),
        )
        gap = air_gap(z, X_m, machine.rotor_resistance_ohm, X_lr, slip)
        return cls(machine.stator_resistance_ohm, gap, voltage, delta)

    def change(self, phase: int, m: float, psi: float, delta: float, link: float) -> Complex:
        """What the fault adds to the line currents' I1 and I2 [A], shape (2,)."""
        z, A1, A2 = self.gap
        ahead = complex(link * np.exp(1j * delta))
        found = faulty_currents(
            self.gap,
            self.voltage,
            complex(self.R_s, psi * z.imag) / m,
            ahead,
            ahead.conjugate(),
            1.0 / 3.0 if self.delta else 0.0,
            phase,
        )
        I1 = found.positive - self.voltage.positive / (z + A1)
        I2 = found.negative - self.voltage.negative / (z + A2)
        if self.delta:
            return np.array([I1 * BETWEEN_LINES, I2 * BETWEEN_LINES.conjugate()])
        return np.array([I1, I2])


@dataclass(frozen=True, slots=True)
class Seen:
    """A fault as the terminals see it: the path over the turns' own resistance, and what it changes."""

    path_ratio: float
    change: Complex


def psi_of(kappa: float, mu: float, path_ratio: float) -> float:
    """How much of the leakage is not coupled, by kappa, the shorted turns and the path."""
    return (kappa + (1 - kappa) * mu) / (1 + path_ratio)


@dataclass(frozen=True, slots=True)
class Turns:
    """Turns mu of a coil in one motor, bridged by one path after another.

    link: of the coil, over the phase's mean turn.
    """

    terminals: Terminals
    phase: int
    mu: float
    link: float
    seen: tuple[Seen, ...]

    def misfits(self, kappa: float, delta: float) -> list[float]:
        """Distance of the equations' change from the true one, over that, path by path."""
        return [float(np.linalg.norm(off)) for off in self._off(kappa, delta)]

    def best_kappa(self, delta: float) -> float:
        """The one kappa that describes all paths best."""
        return float(self._nearest(lambda x: (float(x[0]), delta), [(kappa,) for kappa in STARTS])[0])

    def best_delta(self, near: float) -> float:
        """The delta [rad] that, with a kappa of its own, describes all paths best."""
        starts = [(kappa, near) for kappa in STARTS]
        return float(self._nearest(lambda x: (float(x[0]), float(x[1])), starts)[1])

    def _nearest(
        self, meaning: Callable[[Array], tuple[float, float]], starts: Sequence[tuple[float, ...]]
    ) -> Array:
        def off(x: Array) -> Array:
            parts = np.concatenate(self._off(*meaning(x)))
            return np.concatenate((parts.real, parts.imag))

        found = [least_squares(off, start) for start in starts]
        return np.asarray(min(found, key=lambda one: one.cost).x, np.float64)

    def _off(self, kappa: float, delta: float) -> list[Complex]:
        return [
            (self._change(one.path_ratio, kappa, delta) - one.change) / np.linalg.norm(one.change)
            for one in self.seen
        ]

    def _change(self, path_ratio: float, kappa: float, delta: float) -> Complex:
        m, psi = self.mu / (1 + path_ratio), psi_of(kappa, self.mu, path_ratio)
        return self.terminals.change(self.phase, m, psi, delta, self.link)
