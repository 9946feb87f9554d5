"""What faults of a motor and of its supply add to its losses, in one record.

The motor is taken at work, with warm resistances.
"""

from cmath import exp as cexp
from math import pi
from typing import NamedTuple

from core.diagnosis.verdict import Diagnosis, Verdict
from core.losses.other_losses import copper_W, other_losses
from core.machines.coil_fault import AirGap, SequencePair, air_gap, faulty_currents, shunt_current
from core.machines.load_point import load_point
from core.machines.parameters import Connection, Motor
from core.rotor.finding import RotorFinding, RotorState
from core.supply.figures import SupplyFigures


class TurnsLosses(NamedTuple):
    """What shorted turns cost: heat in them and their path, and of the backward current they drive [W]."""

    path_W: float
    backward_W: float


def losses_of_turns(motor: Motor, diagnosis: Diagnosis, supply: SupplyFigures, slip: float) -> TurnsLosses:
    """Return what shorted turns cost: a shunt (R_s + j psi X_ls) / m, of which R_s / m takes the heat."""
    level, fit = diagnosis.mu_f, diagnosis.fit
    if diagnosis.verdict is not Verdict.FAULT or not level or fit is None:
        return TurnsLosses(0.0, 0.0)
    gap = _air_gap(motor, supply, slip)
    ahead = cexp(1j * fit.axis_rad) * fit.linkage
    circulating = 1.0 / 3.0 if motor.nameplate.connection is Connection.DELTA else 0.0
    branch = complex(gap.stator.real, fit.leakage * gap.stator.imag) / level
    shared = (branch, ahead, ahead.conjugate(), circulating)
    voltage = SequencePair(complex(_winding_V(motor, supply)), 0j)
    turns_A = abs(shunt_current(gap, voltage, *shared))
    backward_A = abs(faulty_currents(gap, voltage, *shared, 0).negative)
    return TurnsLosses(branch.real * turns_A**2, backward_W(motor, backward_A))


def losses_of_unbalance(motor: Motor, supply: SupplyFigures, slip: float) -> float:
    """Return what the current that the supply's backward voltage drives heats [W]."""
    gap = _air_gap(motor, supply, slip)
    backward_V = supply.voltage_unbalance_iec * _winding_V(motor, supply)
    return backward_W(motor, backward_V / abs(gap.stator + gap.backward))


def losses_of_voltage(motor: Motor, supply: SupplyFigures, power_W: float) -> float:
    """Return the losses at this voltage less those at the rated one, at the same torque [W]."""
    rated_V = motor.nameplate.winding_voltage_V

    def lost_W(voltage_V: float) -> float:
        at = load_point(motor, voltage_V, supply.frequency_hz, power_W)
        return copper_W(motor, at) + other_losses(motor).iron_W * (voltage_V / rated_V) ** 2

    return lost_W(_winding_V(motor, supply)) - lost_W(rated_V)


def losses_of_cage(rotor: RotorFinding, rotor_copper_W: float) -> float:
    """Return what the rotor loses more because part of its bars do not conduct [W].

    The severity is the share a by which the resistance of the cage grows on the mean of its axes.
    """
    if rotor.state is not RotorState.FAULT or rotor.severity_dB is None:
        return 0.0
    share = float(10.0 ** (rotor.severity_dB / 20.0))
    return rotor_copper_W * share / (1.0 + share)


def backward_W(motor: Motor, current_A: float) -> float:
    """Return what a backward current of the windings heats in stator and rotor [W]."""
    return 3.0 * (motor.parameters.stator_resistance_ohm + backward_rotor_ohm(motor)) * current_A**2


def backward_rotor_ohm(motor: Motor) -> float:
    """Return the resistance of the rotor as a backward current sees it [ohm]."""
    return motor.backward_rotor.resistance_ratio * motor.parameters.rotor_resistance_ohm


def _winding_V(motor: Motor, supply: SupplyFigures) -> float:
    """Return the mean voltage of a winding, rms."""
    return motor.nameplate.winding_voltage_V * (1.0 + supply.voltage_deviation)


def _air_gap(motor: Motor, supply: SupplyFigures, slip: float) -> AirGap:
    machine, w = motor.parameters, 2.0 * pi * supply.frequency_hz
    return air_gap(
        complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H),
        w * machine.magnetising_inductance_H,
        machine.rotor_resistance_ohm,
        w * machine.rotor_leakage_H,
        slip,
        *motor.backward_rotor,
    )
