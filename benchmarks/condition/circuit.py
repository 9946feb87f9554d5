"""Steady running of an unbalanced machine with split windings, solved by phasors for many records at once.

Every winding has its own impedance and its own number of effective turns, any winding may have shorted turns
with a path of any resistance, any line a joint with resistance, and the bars of the cage may have another
resistance at twice the supply's frequency than at slip. The three windings are solved together with the star
point or the delta, and the slip follows from the torque of both sequences. The speed is taken as constant
within a record.

With i the current that magnetises (the terminals' less that of the path), T = diag(1 + eps) the effective
turns, and Z_g the circulant impedance of the gap:

    v   = (R_s + j X_ls + dZ) i + T Z_g T i                   (nothing of the gap in zero sequence)
    i_f = mu v_x / (r_f + mu (1 - mu) (R_s + j X_ls)),        i_winding = i + mu i_f e_x

Filter and estimator write the same machine down as sequence components of small changes; nothing of theirs
is used here.
"""

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

A = np.exp(2j * np.pi / 3)
FORWARD = np.array([1, A**2, A])
"""A positive-sequence set of phasors."""
BACKWARD = np.array([1, A, A**2])
DELTA = np.array([[1, -1, 0], [0, 1, -1], [-1, 0, 1]], dtype=np.complex128)
"""From line to winding voltages; its transpose makes line currents of winding currents."""
MOST_STEPS = 12
SLIP_TOLERANCE = 1e-12


@dataclass(frozen=True, slots=True)
class Windings:
    """What a motor is made of, in its own frame: windings 0, 1, 2 in a supply of positive sequence.

    All arrays have one row or one a record. Resistances [ohm] are those at the temperature of the records.

    effective_turns: of each winding, relative to the mean.  own_impedance_ohm: what each winding has more
    than the others.  backward_resistance, backward_leakage: factors of the rotor's values at twice the
    supply's frequency (skin effect).
    """

    stator_resistance_ohm: Array
    rotor_resistance_ohm: Array
    stator_leakage_H: Array
    rotor_leakage_H: Array
    magnetising_H: Array
    effective_turns: Array
    own_impedance_ohm: Complex
    backward_resistance: Array
    backward_leakage: Array

    def followed_by(self, other: "Windings", first: int, records: int) -> "Windings":
        """These windings up to a record, others from it on."""
        later = np.arange(records) >= first
        joined = {}
        for one in fields(self):
            mine, theirs = getattr(self, one.name), getattr(other, one.name)
            joined[one.name] = np.where(later[:, np.newaxis] if mine.ndim > 1 else later, theirs, mine)
        return Windings(**joined)

    def warmed(self, factor: Array) -> "Windings":
        """The same with all resistances times a factor, one a record."""
        own = self.own_impedance_ohm
        return replace(
            self,
            stator_resistance_ohm=self.stator_resistance_ohm * factor,
            rotor_resistance_ohm=self.rotor_resistance_ohm * factor,
            own_impedance_ohm=own.real * factor[:, np.newaxis] + 1j * own.imag,
        )

    def saturated(self, factor: Array) -> "Windings":
        """The same with another magnetising inductance at every record."""
        return replace(self, magnetising_H=self.magnetising_H * factor)


@dataclass(frozen=True, slots=True)
class Shorted:
    """Shorted turns: their share mu of the phase and the path's resistance over theirs, one a record."""

    turns: Array
    path_ratio: Array
    winding: int


@dataclass(frozen=True, slots=True)
class Running:
    """What the machine does: line currents (n, 3), peak [A], and slip (n,)."""

    line_current_A: Complex
    slip: Array


def running(
    windings: Windings,
    voltage_V: Complex,
    angular_frequency: Array,
    torque_Nm: Array,
    *,
    pole_pairs: int,
    delta: bool,
    shorted: Shorted | None = None,
    line_resistance_ohm: Array | None = None,
) -> Running:
    """Find slip and currents of every record.

    voltage_V: line to neutral, peak, of lines 0, 1, 2 in the machine's frame, shape (n, 3).
    """
    n = voltage_V.shape[0]
    lines = np.zeros((n, 3)) if line_resistance_ohm is None else line_resistance_ohm
    solver = _Solver(windings, voltage_V, angular_frequency, pole_pairs, delta, shorted, lines)
    volts = np.abs(voltage_V @ np.conj(FORWARD)) / 3 * (np.sqrt(3) if delta else 1.0)
    pull = 1.5 * pole_pairs * volts**2 / (angular_frequency * windings.rotor_resistance_ohm)
    slip = torque_Nm / pull
    torque = solver.torque(slip)
    following = slip * torque_Nm / np.where(torque == 0.0, 1.0, torque)
    for _ in range(MOST_STEPS):
        before, slip = slip, following
        torque_before, torque = torque, solver.torque(slip)
        rise = torque - torque_before
        step = np.where(rise == 0.0, 0.0, (torque_Nm - torque) * (slip - before) / np.where(rise, rise, 1.0))
        following = slip + step
        if np.abs(step).max() < SLIP_TOLERANCE:
            break
    else:
        raise ValueError("a load is too heavy for its motor: no slip balances the torques")
    solver.torque(slip)
    return Running(solver.line_current, slip)


class _Solver:
    """Currents and torque of all records at given slips."""

    def __init__(
        self,
        windings: Windings,
        voltage: Complex,
        w: Array,
        pole_pairs: int,
        delta: bool,
        shorted: Shorted | None,
        lines: Array,
    ) -> None:
        self.windings, self.w, self.pole_pairs, self.delta = windings, w, pole_pairs, delta
        self.shorted, self.lines = shorted, lines
        n = voltage.shape[0]
        self.own = windings.stator_resistance_ohm + 1j * w * windings.stator_leakage_H
        self.impedance = np.zeros((n, 3, 3), dtype=np.complex128)
        self.drive = voltage @ DELTA.T if delta else np.hstack([voltage, np.zeros((n, 1))])
        if shorted is not None:
            mu = shorted.turns
            path = shorted.path_ratio * windings.stator_resistance_ohm + (1 - mu) * self.own
            self.shunt = mu / path  # mu i_f per volt of the winding
        self.line_current = np.zeros((n, 3), dtype=np.complex128)

    def torque(self, slip: Array) -> Array:
        """Torque [N m]; the line currents of these slips are left behind."""
        forward, forward_torque = self._gap(slip, 1.0, 1.0)
        backward, backward_torque = self._gap(
            2.0 - slip, self.windings.backward_resistance, self.windings.backward_leakage
        )
        magnetising = self._currents(forward, backward) * self.windings.effective_turns
        first = np.abs(magnetising @ np.conj(FORWARD) / 3) ** 2
        second = np.abs(magnetising @ np.conj(BACKWARD) / 3) ** 2
        return np.asarray(
            1.5 * self.pole_pairs / self.w * (forward_torque * first - backward_torque * second)
        )

    def _gap(self, slip: Array, resistance: Array | float, leakage: Array | float) -> tuple[Complex, Array]:
        """Impedance of the gap at a slip, and the gap's resistance that makes torque (per |i|^2)."""
        R_r = self.windings.rotor_resistance_ohm * resistance
        X_lr = self.w * self.windings.rotor_leakage_H * leakage
        X_m = self.w * self.windings.magnetising_H
        below = R_r + 1j * slip * (X_lr + X_m)
        return (
            1j * X_m * (R_r + 1j * slip * X_lr) / below,
            X_m**2 * R_r * slip / np.abs(below) ** 2,
        )

    def _currents(self, forward: Complex, backward: Complex) -> Complex:
        """Magnetising currents of the windings; line currents are left behind."""
        turns = self.windings.effective_turns
        Z = self.impedance
        for row in range(3):
            for column in range(3):
                turned = A ** (column - row)
                gap = (forward * turned + backward * np.conj(turned)) / 3
                Z[:, row, column] = turns[:, row] * gap * turns[:, column]
            Z[:, row, row] += self.own + self.windings.own_impedance_ohm[:, row]
        through = np.broadcast_to(np.eye(3, dtype=np.complex128), Z.shape).copy()
        if self.shorted is not None:
            x = self.shorted.winding
            through[:, x, :] += self.shunt[:, np.newaxis] * Z[:, x, :]
        if self.delta:
            drops = DELTA @ (self.lines[:, :, np.newaxis] * (DELTA.T @ through))
            current = np.linalg.solve(Z + drops, self.drive[:, :, np.newaxis])[:, :, 0]
            self.line_current = np.einsum("ij,njk,nk->ni", DELTA.T, through, current, optimize=True)
            return np.asarray(current)
        system = np.zeros((Z.shape[0], 4, 4), dtype=np.complex128)
        system[:, :3, :3] = Z + self.lines[:, :, np.newaxis] * through
        system[:, :3, 3] = 1.0
        system[:, 3, :3] = through.sum(axis=1)
        current = np.linalg.solve(system, self.drive[:, :, np.newaxis])[:, :3, 0]
        self.line_current = np.einsum("njk,nk->nj", through, current)
        return np.asarray(current)
