"""The stator coil by coil: a circuit of its own for each, in the totals that the motor's parameters say.

Two coils i and j of turns w_i, w_j couple in three ways.

The air-gap field, order by order: of v pole pairs, from 1 to 50 times the motor's own p, a coil of pitch y
out of S slots has the winding function (2 / (pi v)) sin(pi v y / S) w. All orders have the same permeance,
which L_s fixes at v = p. The field of a coil's alternating current is a forward and a backward wave, on
which the rotor has slips of its own: 1 - (v/p)(1 - s) and 1 + (v/p)(1 - s). Each drives a rotor circuit of
its own, that of the cage's bars for v pole pairs, and is left with a share d of its flux:

    Z_ij = j w L_s / 2 sum_v c_vi c_vj (d_f exp(-j v a_ij) + d_b exp(j v a_ij)),  a_ij mechanical

A wound rotor has no circuit but its own for v = p.

The slots (`slot_leakage`): each layer with its own permeance, and one between the two. Coils of one phase or
of two that share a slot couple there. The turns of one coil side lie side by side, so all of them link all of
the flux of their layer.

The coil ends, each for itself, in proportion to the coil's pitch.

What orders other than p leave to a phase is part of its L_ls and R_s. Slots and ends have the rest of L_ls, a
fixed share of it each.

Reference: X. Luo et al., doi:10.1109/28.464525 (multiple coupled circuits, winding functions).
"""

from dataclasses import dataclass
from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import MachineKind, Motor
from ied_sim.motor.cage import USUAL_CAGE, Cage
from ied_sim.motor.slot_leakage import USUAL_SLOTS, SlotShape, end_permeances, slot_permeances
from ied_sim.motor.slots import Coil, SlotWinding

Matrix = NDArray[np.float64]
Complex = NDArray[np.complex128]

HIGHEST_ORDER = 50
"""Highest order of the air-gap field, over the motor's own number of pole pairs."""
OWN_ORDER, OTHER_ORDERS = slice(0, 1), slice(1, None)
USUAL_BARS_PER_POLE_PAIR = 14
LEAST_OWN_LEAKAGE = 0.25
"""Least share of bars and rings in the rotor's leakage; the rest is that of the bars' steps in the field."""


@dataclass(frozen=True)
class Coils:
    """All n coils of a stator, of which each has the turns of one.

    Inductances and resistances are those of coils through which the current of one branch flows; a coil has
    1 / (coils of a branch) of the turns of a phase.

    Parameters
    ----------
    of_phase : ndarray of int, shape (n,)
        Phase of each coil.
    branch : ndarray of int, shape (n,)
        Its branch.
    branches : int
        Number of branches of a phase.
    orders : ndarray, shape (v,)
        Pole pairs of the orders of the field, the motor's own first.
    fields : ndarray, shape (v, n), complex
        Winding function of each coil for each order: amplitude over that of a phase's fundamental, and place.
        That of the motor's own order is at angle 0 for the axis of phase a.
    field_inductance_H : float
        Self-inductance L_s of a phase's fundamental.
    leakage : ndarray, shape (n, n)
        Inductance of slots and ends [H].
    resistance_ohm : float
        Resistance of the copper of a coil.
    rotor : HarmonicRotor
        What the rotor does to each order.
    angular_frequency : float
        Rated angular frequency of the supply [rad/s].
    """

    of_phase: NDArray[np.int64]
    branch: NDArray[np.int64]
    branches: int
    orders: Matrix
    fields: Complex
    field_inductance_H: float
    leakage: Matrix
    resistance_ohm: float
    rotor: "HarmonicRotor"
    angular_frequency: float

    def coil(self, phase: int, number: int) -> int:
        """Return the index of coil `number` of a phase, counted from 1 on."""
        return int(np.flatnonzero(self.of_phase == phase)[number - 1])

    def harmonic_impedance(self, slip: float, turns: Matrix, *, frequency: float = 1.0) -> Complex:
        """Return the impedance of all orders but the motor's own [ohm], shape (m, m).

        Parameters
        ----------
        slip : float
            Slip of the rotor against the forward wave of the rated frequency and of the motor's own order.
        turns : ndarray, shape (n, m)
            Share of each coil's turns through which each of m currents flows, with its sign.
        frequency : float, default 1.0
            Frequency of the currents over the rated one.

        Returns
        -------
        ndarray, shape (m, m), complex
            The impedance; it is not symmetric, for the rotor turns.
        """
        return self.impedance_of_fields(slip, self.fields[1:] @ turns, frequency=frequency)

    def impedance_of_fields(self, slip: float, linked: Complex, *, frequency: float = 1.0) -> Complex:
        """Return what `harmonic_impedance` does, for m currents with these fields of the other orders.

        Parameters
        ----------
        slip, frequency : float
            As in `harmonic_impedance`.
        linked : ndarray, shape (v - 1, m), complex
            `fields[1:] @ turns`.

        Returns
        -------
        ndarray, shape (m, m), complex
            The impedance [ohm].
        """
        forward, backward = self.rotor.left(slip, frequency, OTHER_ORDERS)
        jw = 0.5j * frequency * self.angular_frequency * self.field_inductance_H
        ahead = linked.conj().T @ (forward[:, None] * linked)
        behind = linked.T @ (backward[:, None] * linked.conj())
        impedance: Complex = jw * (ahead + behind)
        return impedance

    def quasi_static(self, turns: Matrix) -> tuple[Matrix, Matrix]:
        """Return inductance [H] and resistance [ohm] of all orders but the motor's own, shape (m, m) each.

        They are those at synchronous speed and rated frequency, without what is not reciprocal: a rotor that
        turns couples coils of different axes a little more one way than the other. `turns` are as in
        `harmonic_impedance`.
        """
        impedance = self.harmonic_impedance(0.0, turns)
        impedance = (impedance + impedance.T) / 2
        return impedance.imag / self.angular_frequency, impedance.real

    def leakage_inductance(self, turns: Matrix) -> Matrix:
        """Return the inductance of slots and ends [H], shape (m, m); `turns` as in `harmonic_impedance`."""
        inductance: Matrix = turns.T @ self.leakage @ turns
        return inductance


@dataclass(frozen=True)
class HarmonicRotor:
    """Rotor circuits of the orders, referred to a coil with the turns of a phase's fundamental.

    Parameters
    ----------
    orders : ndarray, shape (v,)
        Their pole pairs, the motor's own first.
    coupling : ndarray, shape (v,)
        Square of the coupling: the field's inductance over that between coil and rotor, squared [H^2].
    inductance : ndarray, shape (v,)
        Inductance of the circuit [H].
    resistance : ndarray, shape (v,)
        Its resistance [ohm].
    field_inductance_H : float
        L_s.
    angular_frequency : float
        Rated angular frequency of the supply [rad/s].
    """

    orders: Matrix
    coupling: Matrix
    inductance: Matrix
    resistance: Matrix
    field_inductance_H: float
    angular_frequency: float

    def left(self, slip: float, frequency: float, part: slice) -> tuple[Complex, Complex]:
        """Return the share of each order's flux that the rotor leaves: forward and backward.

        Slip and frequency are as in `Coils.harmonic_impedance`; `part` is of the orders.
        """
        turning = self.orders[part] / self.orders[0] * (1 - slip)
        return self._left(frequency - turning, part), self._left(frequency + turning, part)

    def _left(self, slip: Matrix, part: slice) -> Complex:
        """Return the share that is left where the rotor sees so many times the rated frequency."""
        jsw = 1j * slip * self.angular_frequency
        driven = jsw * self.coupling[part] / (self.resistance[part] + jsw * self.inductance[part])
        left: Complex = 1 - driven / self.field_inductance_H
        return left


@lru_cache(maxsize=256)
def coils_of(
    motor: Motor, winding: SlotWinding, cage: Cage = USUAL_CAGE, shape: SlotShape = USUAL_SLOTS
) -> Coils:
    """Return the coils of a motor.

    Parameters
    ----------
    motor : Motor
        The motor; its parameters are the totals.
    winding : SlotWinding
        Its winding.
    cage : Cage, optional
        Bars that answer the other orders; the usual cage stands for one of 14 bars a pole pair, and not less
        than its own. A wound rotor has none.
    shape : SlotShape, optional
        What the leakage of slots and ends is shared out by.

    Returns
    -------
    Coils
        The coils.

    Raises
    ------
    ValueError
        If there is no such winding for the motor's poles, or if its field of other orders alone has more
        leakage than the motor.
    """
    p, machine = motor.nameplate.pole_pairs, motor.parameters
    coils = winding.coils(p)
    orders = np.array([p, *(v for v in range(1, HIGHEST_ORDER * p + 1) if v != p)], dtype=np.float64)
    of_phase = np.array([coil.phase for coil in coils])
    branches, N = winding.branches, winding.coils_per_phase()
    rotor = _harmonic_rotor(motor, orders, cage)
    unscaled = Coils(
        of_phase=of_phase,
        branch=np.array([coil.branch for coil in coils]),
        branches=branches,
        orders=orders,
        fields=_fields(coils, winding.slots, orders),
        field_inductance_H=machine.stator_self_inductance_H,
        leakage=np.zeros((len(coils), len(coils))),
        resistance_ohm=0.0,
        rotor=rotor,
        angular_frequency=motor.nameplate.rated_angular_frequency,
    )
    phases = (of_phase[:, None] == np.arange(3)) / branches
    L_other, R_other = (_per_phase(matrix) for matrix in unscaled.quasi_static(phases))
    rest_H = machine.stator_leakage_H - L_other
    if rest_H <= 0 or R_other >= machine.stator_resistance_ohm:
        raise ValueError(
            f"the winding's field of other numbers of poles alone has a leakage of {L_other:.3g} H, and the "
            f"motor's is {machine.stator_leakage_H:.3g} H"
        )
    slots, ends = slot_permeances(coils, winding.slots, winding.layers, shape), end_permeances(coils)
    slots *= (1 - shape.end_share) * rest_H / _per_phase(phases.T @ slots @ phases)
    ends *= shape.end_share * rest_H / _per_phase(phases.T @ ends @ phases)
    copper_ohm = machine.stator_resistance_ohm - R_other
    values = {name: getattr(unscaled, name) for name in unscaled.__dataclass_fields__}
    return Coils(**(values | {"leakage": slots + ends, "resistance_ohm": copper_ohm * branches**2 / N}))


def _per_phase(matrix: Matrix) -> float:
    """Return what a phase has of a three-phase matrix with a current that sums to nothing."""
    return float(np.trace(matrix) / 3 - (matrix.sum() - np.trace(matrix)) / 6)


def _fields(coils: tuple[Coil, ...], slots: int, orders: Matrix) -> Complex:
    """Return the winding function of each coil, see `Coils`."""
    turn = 2 * pi / slots
    pitch = np.array([coil.pitch_slots for coil in coils])
    sign = np.array([coil.sign for coil in coils])
    axis = turn * np.array([(coil.go + coil.back) / 2 for coil in coils])
    v = orders[:, None]
    fields = 2 / (pi * v) * np.sin(v * turn * pitch / 2) * sign * np.exp(1j * v * axis)
    first_phase = np.array([coil.phase == 0 for coil in coils])
    mean = fields[0, first_phase].mean()
    # A phase's current passes through all its coils in series, or through all branches by equal parts.
    fields[0] *= np.exp(-1j * np.angle(mean))
    branch = first_phase.sum() / (max(coil.branch for coil in coils) + 1)
    normed: Complex = fields / abs(mean) / branch
    return normed


def _harmonic_rotor(motor: Motor, orders: Matrix, cage: Cage) -> HarmonicRotor:
    """Return the rotor's circuits: that of the parameters for the motor's own order, of its bars for others.

    N bars that carry the current cos(2 pi v k / N) couple with a coil by (N / (pi v)) sin(pi v / N).
    """
    p, machine = motor.nameplate.pole_pairs, motor.parameters
    L_s = machine.stator_self_inductance_H
    if cage == USUAL_CAGE:
        cage = Cage(max(USUAL_CAGE.bars, USUAL_BARS_PER_POLE_PAIR * p))
    N = cage.bars
    own = max(
        machine.rotor_leakage_H - cage.spread_leakage(machine, p),
        LEAST_OWN_LEAKAGE * machine.rotor_leakage_H,
    )
    R_b, R_e = cage.bar_and_ring(machine.rotor_resistance_ohm, p)
    L_b, L_e = cage.bar_and_ring(own, p)
    bars = 4 * np.sin(pi * orders / N) ** 2
    coupling = (L_s * N / (pi * orders) * np.sin(pi * orders / N)) ** 2
    inductance = L_s + N / 2 * (bars * L_b + 2 * L_e)
    resistance = N / 2 * (bars * R_b + 2 * R_e)
    if motor.kind is MachineKind.WOUND_ROTOR:
        coupling[1:] = 0.0
    coupling[0] = L_s**2
    inductance[0] = L_s + machine.rotor_leakage_H / 1.5
    resistance[0] = machine.rotor_resistance_ohm / 1.5
    return HarmonicRotor(
        orders, coupling, inductance, resistance, L_s, motor.nameplate.rated_angular_frequency
    )
