"""Steady currents of a motor with shorted turns, in phase variables and by phasors: for the bound.

The split winding is the tests' own circuit; the additional shorted winding of the thesis (6.10-6.15) is
stated here as a fourth stator coil of mu times the turns. Nothing of the estimator's models enters: no
Clarke axes, no flux states, no time steps. The speed is taken as constant, that is, the inertia as infinite.
"""

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from core.machines.parameters import Motor
from testing.machines.phase_circuits import FORTESCUE, Fault, Operation, running

Complex = NDArray[np.complex128]
BACKWARD_OPEN = 1e-12
"""Slip below which the rotor is as good as open."""


class FaultModel(StrEnum):
    """What shorted turns are: part of the phase, or the thesis's additional winding."""

    SPLIT = "split-winding"
    ADDITIONAL = "shorted-winding"


@dataclass(frozen=True, slots=True)
class Condition:
    """A running motor: load over rated torque, voltage unbalance V2/V1, turns mu shorted in a phase 0, 1, 2.

    relative_voltage: positive-sequence voltage over the rated one.  path_ratio: resistance of the path that
    bridges the turns over the turns' own (split winding alone).  reverse: whether the supply turns a-c-b.
    """

    load_level: float
    unbalance: complex = 0.0
    level: float = 0.0
    winding: int = 0
    relative_voltage: complex = 1.0
    path_ratio: float = 0.0
    reverse: bool = False

    @property
    def equivalent_level(self) -> float:
        """Level of the dead-shorted turns that draw the same current at one slip."""
        return self.level / (1.0 + self.path_ratio)

    def path_resistance_ohm(self, motor: Motor) -> float:
        """Resistance of the path [ohm]."""
        return self.path_ratio * self.level * motor.parameters.stator_resistance_ohm


def steady(motor: Motor, model: FaultModel, condition: Condition) -> Operation:
    """Line currents and phase voltages (rms phasors of a, b, c) of a star-connected motor, sequence a-b-c."""
    nameplate = motor.nameplate
    # Rated torque does not depend on rated voltage: another voltage is another motor of the same load.
    fed = replace(
        motor,
        nameplate=replace(
            nameplate, rated_voltage_V=nameplate.rated_voltage_V * abs(condition.relative_voltage)
        ),
    )
    if model is FaultModel.SPLIT or condition.level == 0.0:
        path = condition.path_resistance_ohm(motor)
        fault = Fault(condition.level, condition.winding, path) if condition.level else None
        found = running(
            fed, condition.load_level, fault=fault, unbalance=condition.unbalance, reverse=condition.reverse
        )
    else:
        found = _beside_additional_winding(fed, condition)
    turn = condition.relative_voltage / abs(condition.relative_voltage)
    return Operation(found.line_current * turn, found.phase_voltage * turn, found.slip)


def _beside_additional_winding(motor: Motor, condition: Condition) -> Operation:
    volts = motor.nameplate.rated_voltage_V / np.sqrt(3)
    voltage = FORTESCUE @ np.array([0, 1, condition.unbalance]) * volts

    def torque_surplus(slip: float) -> float:
        rotor = _currents(motor, voltage, slip, condition)[3:6]
        power = np.abs(np.linalg.solve(FORTESCUE, rotor)) ** 2 * 3 * motor.parameters.rotor_resistance_ohm
        w_s = motor.nameplate.rated_angular_frequency / motor.nameplate.pole_pairs
        torque = (power[1] / slip if slip else 0.0) - power[2] / (2 - slip)
        return float(torque / w_s - condition.load_level * motor.nameplate.rated_torque_Nm)

    slip = brentq(torque_surplus, -0.01, 0.12, xtol=1e-14)
    return Operation(_currents(motor, voltage, slip, condition)[:3], voltage, slip)


def _currents(motor: Motor, voltage: Complex, slip: float, condition: Condition) -> Complex:
    """Stator currents (3), rotor currents (3, referred), current of the additional winding, star point.

    Coils couple by turns and by the cosine between their axes. The additional one has mu turns, the
    resistance mu R_s and the leakage mu^2 L_ls.
    """
    machine = motor.parameters
    jw = 1j * motor.nameplate.rated_angular_frequency
    mutual = machine.stator_self_inductance_H * np.array([[1, -0.5, -0.5], [-0.5, 1, -0.5], [-0.5, -0.5, 1]])
    slips = np.array([1.0, slip, 2 - slip])
    slips = np.where(np.abs(slips) < BACKWARD_OPEN, BACKWARD_OPEN, slips)
    x, mu = condition.winding, condition.level

    M = np.zeros((8, 8), dtype=np.complex128)
    M[:3, :3] = (machine.stator_resistance_ohm + jw * machine.stator_leakage_H) * np.eye(3) + jw * mutual
    M[:3, 3:6] = M[3:6, :3] = jw * mutual
    M[3:6, 3:6] = (
        FORTESCUE @ np.diag(machine.rotor_resistance_ohm / slips) @ np.linalg.inv(FORTESCUE)
        + jw * machine.rotor_leakage_H * np.eye(3)
        + jw * mutual
    )
    M[:3, 6] = M[3:6, 6] = M[6, :3] = M[6, 3:6] = mu * jw * mutual[:, x]
    M[6, 6] = mu * machine.stator_resistance_ohm + mu**2 * jw * (machine.stator_leakage_H + mutual[x, x])
    M[:3, 7] = 1.0
    M[7, :3] = 1.0
    rhs = np.concatenate([voltage, np.zeros(5)])
    return np.asarray(np.linalg.solve(M, rhs), dtype=np.complex128)
