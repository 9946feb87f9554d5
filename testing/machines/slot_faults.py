"""Steady state of a motor with turns shorted inside one coil: all its coils at one slip, by phasors.

The physics is that of the simulator's coils (`ied_sim.motor.coils`), each order of the field with a forward
and a backward wave of its own. Here they are solved by one linear system at one slip: some 3 ms a case, for
thousands of them. The speed is constant, as of an infinite inertia.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from core.machines.parameters import Motor
from ied_sim.motor.cage import USUAL_CAGE, Cage
from ied_sim.motor.coils import OWN_ORDER, Coils, coils_of
from ied_sim.motor.fault import TurnFault
from ied_sim.motor.slot_leakage import USUAL_SLOTS, SlotShape
from ied_sim.motor.slots import SlotWinding
from ied_sim.motor.stator import CoilLoops, coil_loops
from testing.machines.phase_circuits import FORTESCUE, Operation

Complex = NDArray[np.complex128]

LEAST_SLIP, MOST_SLIP = -0.01, 0.12
OPEN = 1e-9
"""Slip below which the rotor is as good as open."""


@dataclass(frozen=True, slots=True)
class CoilFault:
    """Turns of one coil, bridged by a path.

    phase: 0, 1 or 2.  coil: 1 to N of the phase, group by group; 1 to q are those of the first group.
    share: of the coil's turns.  path_ratio: resistance of the path over that of the shorted turns.
    """

    phase: int
    coil: int
    share: float
    path_ratio: float = 0.0

    def level(self, winding: SlotWinding) -> float:
        """Shorted turns over all turns of the phase, mu."""
        return self.share / winding.coils_per_phase()

    def equivalent_level(self, winding: SlotWinding) -> float:
        """Level m = mu / (1 + p)."""
        return self.level(winding) / (1.0 + self.path_ratio)

    def of(self, motor: Motor, winding: SlotWinding) -> TurnFault:
        """The simulator's fault."""
        mu, R_s = self.level(winding), motor.parameters.stator_resistance_ohm
        path_ohm = self.path_ratio * mu * winding.branches**2 * R_s
        return TurnFault(mu, self.phase, path_ohm, self.coil, winding.branches)


@dataclass(frozen=True)
class SteadyCoils:
    """All coils of a motor, healthy or with a fault, in steady running.

    quasi_static: take the field's other orders as the simulator's integration does.
    """

    motor: Motor
    coils: Coils
    loops: CoilLoops
    quasi_static: bool = False

    @classmethod
    def of(
        cls,
        motor: Motor,
        winding: SlotWinding,
        fault: CoilFault | None = None,
        *,
        cage: Cage = USUAL_CAGE,
        shape: SlotShape = USUAL_SLOTS,
        quasi_static: bool = False,
    ) -> "SteadyCoils":
        """The coils of a motor with this winding; a fault of no turns is none."""
        coils = coils_of(motor, winding, cage, shape)
        turns = fault.of(motor, winding) if fault is not None and fault.share > 0.0 else None
        return cls(motor, coils, coil_loops(coils, motor.nameplate.connection, turns), quasi_static)

    def impedance(self, slip: float, frequency: float = 1.0) -> Complex:
        """Impedance of the loops [ohm], shape (m, m), at a slip and a frequency over the rated one.

        The slip is that against the forward wave of rated frequency, 2 - s where the motor runs backwards.
        """
        coils = self.coils
        jw = 1j * frequency * coils.angular_frequency
        Z = self.loops.resistance + self.loops.path + jw * self._leakage
        if self.quasi_static:
            inductance, resistance = coils.quasi_static(self.loops.turns)
            Z = Z + resistance + jw * inductance
        else:
            Z = Z + coils.impedance_of_fields(slip, self._fields[1:], frequency=frequency)
        forward, backward = self._main_field(slip, frequency)
        F = self._fields[0]
        ahead, behind = np.outer(F.conj(), F), np.outer(F, F.conj())
        return np.asarray(
            Z + 0.5 * jw * coils.field_inductance_H * (forward * ahead + backward * behind), np.complex128
        )

    def currents(self, voltage: Complex, slip: float, frequency: float = 1.0) -> tuple[Complex, Complex]:
        """Line currents (3) and loop currents (m) with these phase voltages (rms phasors of a, b, c)."""
        drive = self.loops.drive
        loop = np.asarray(np.linalg.solve(self.impedance(slip, frequency), drive @ voltage), np.complex128)
        return np.asarray(drive.T @ loop, np.complex128), loop

    def torque(self, loop: Complex, slip: float) -> float:
        """Torque of the motor's own order of the field [N m], which is nearly all of it."""
        forward, backward = self._main_field(slip, 1.0)
        F = self._fields[0]
        half = 0.5 * self.coils.field_inductance_H * self.motor.nameplate.pole_pairs
        pull = backward.imag * abs(F.conj() @ loop) ** 2 - forward.imag * abs(F @ loop) ** 2
        return float(half * pull)

    def running(
        self,
        load_level: float,
        *,
        unbalance: complex = 0.0,
        relative_voltage: complex = 1.0,
        reverse: bool = False,
        zero_sequence: complex = 0.0,
    ) -> Operation:
        """Line currents, phase voltages (rms phasors of a, b, c) and slip at a load.

        relative_voltage: V1 over the rated one.  unbalance, zero_sequence: V2 and V0 over V1.  reverse: the
        supply turns a-c-b, and so does the motor; V1 is then the voltage of that sequence.
        """
        nameplate = self.motor.nameplate
        sequences = [zero_sequence, unbalance, 1.0] if reverse else [zero_sequence, 1.0, unbalance]
        volts = nameplate.rated_voltage_V / np.sqrt(3) * relative_voltage
        voltage = np.asarray(FORTESCUE @ np.array(sequences) * volts, np.complex128)
        direction = -1.0 if reverse else 1.0

        def forward_slip(slip: float) -> float:
            slip = slip if abs(slip) > OPEN else OPEN
            return 2.0 - slip if reverse else slip

        def surplus(slip: float) -> float:
            _, loop = self.currents(voltage, forward_slip(slip))
            torque = direction * self.torque(loop, forward_slip(slip))
            return torque - load_level * nameplate.rated_torque_Nm

        slip = float(brentq(surplus, LEAST_SLIP, MOST_SLIP, xtol=1e-12))
        return Operation(self.currents(voltage, forward_slip(slip))[0], voltage, slip)

    @cached_property
    def _fields(self) -> Complex:
        return np.asarray(self.coils.fields @ self.loops.turns, np.complex128)

    @cached_property
    def _leakage(self) -> NDArray[np.float64]:
        return self.coils.leakage_inductance(self.loops.turns)

    def _main_field(self, slip: float, frequency: float) -> tuple[complex, complex]:
        """Share of the flux of the motor's own order that the rotor leaves, forward and backward."""
        forward, backward = self.coils.rotor.left(slip, frequency, OWN_ORDER)
        return complex(forward[0]), complex(backward[0])


def sequences_of(phasors: Complex) -> Complex:
    """Zero, positive (a-b-c) and negative sequence of phasors of a, b, c."""
    return np.asarray(np.linalg.solve(FORTESCUE, phasors), np.complex128)
