"""What faults of a motor and of its supply add to its losses, in one record."""

from cmath import exp as cexp
from math import pi
from typing import NamedTuple

from core.condition.measuring.impedance import negative_impedance
from core.condition.measuring.turns_grid import HALF_WARM
from core.diagnosis.verdict import Diagnosis, Verdict
from core.losses.other_losses import other_losses
from core.machines.coil_fault import SequencePair, air_gap, faulty_currents, shunt_current
from core.machines.load_point import load_point
from core.machines.parameters import Connection, Motor
from core.rotor.finding import RotorFinding, RotorState
from core.supply.figures import SupplyFigures


class TurnsLosses(NamedTuple):
    """What shorted turns cost.

    Parameters
    ----------
    path_W : float
        Heat in the turns and in the path that bridges them [W].
    backward_W : float
        Heat of the backward current that they drive through stator and rotor [W].
    """

    path_W: float
    backward_W: float


def _winding_V(motor: Motor, supply: SupplyFigures) -> float:
    """Return the mean voltage of a winding, rms."""
    return motor.nameplate.winding_voltage_V * (1.0 + supply.voltage_deviation)


def _backward_ohm(motor: Motor) -> float:
    """Return the resistance in which a backward current of the windings heats stator and rotor."""
    machine = motor.parameters
    ratio = motor.backward_rotor.resistance_ratio
    return HALF_WARM * (machine.stator_resistance_ohm + ratio * machine.rotor_resistance_ohm)


def losses_of_unbalance(motor: Motor, supply: SupplyFigures) -> float:
    """Return what the current that the supply's backward voltage drives heats.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters of the motor.
    supply : SupplyFigures
        What the record shows of the supply.

    Returns
    -------
    float
        Losses [W].
    """
    backward_V = supply.voltage_unbalance_iec * _winding_V(motor, supply)
    current_A = backward_V / abs(negative_impedance(motor, supply.frequency_hz))
    return 3.0 * _backward_ohm(motor) * current_A**2


def losses_of_turns(motor: Motor, diagnosis: Diagnosis, supply: SupplyFigures, slip: float) -> TurnsLosses:
    """Return the heat in shorted turns and in their path, and of the backward current that they drive.

    The turns are a shunt (R_s + j psi X_ls) / m, of which R_s / m takes the heat.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters of the motor.
    diagnosis : Diagnosis
        What the record shows of the stator.
    supply : SupplyFigures
        What it shows of the supply.
    slip : float
        Slip.

    Returns
    -------
    TurnsLosses
        Zero where no shorted turns are found.
    """
    level, fit = diagnosis.mu_f, diagnosis.fit
    if diagnosis.verdict is not Verdict.FAULT or not level or fit is None:
        return TurnsLosses(0.0, 0.0)
    machine, w, seen = motor.parameters, 2.0 * pi * supply.frequency_hz, motor.backward_rotor
    R_s = HALF_WARM * machine.stator_resistance_ohm
    gap = air_gap(
        complex(R_s, w * machine.stator_leakage_H),
        w * machine.magnetising_inductance_H,
        HALF_WARM * machine.rotor_resistance_ohm,
        w * machine.rotor_leakage_H,
        slip,
        seen.resistance_ratio,
        seen.leakage_share,
    )
    voltage = SequencePair(complex(_winding_V(motor, supply)), 0j)
    ahead = cexp(1j * fit.axis_rad) * fit.linkage
    circulating = 1.0 / 3.0 if motor.nameplate.connection is Connection.DELTA else 0.0
    branch = complex(R_s, fit.leakage * w * machine.stator_leakage_H) / level
    shared = (branch, ahead, ahead.conjugate(), circulating)
    turns_A = abs(shunt_current(gap, voltage, *shared))
    backward_A = abs(faulty_currents(gap, voltage, *shared, 0).negative)
    return TurnsLosses(R_s / level * turns_A**2, 3.0 * _backward_ohm(motor) * backward_A**2)


def losses_of_voltage(motor: Motor, supply: SupplyFigures) -> float:
    """Return the losses at this voltage less those at the rated one, at the same torque.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters of the motor.
    supply : SupplyFigures
        What the record shows of the supply.

    Returns
    -------
    float
        Losses; below zero where the voltage saves some [W].
    """
    if supply.active_power_W is None:
        return 0.0
    return _sound_W(motor, supply, _winding_V(motor, supply)) - _sound_W(
        motor, supply, motor.nameplate.winding_voltage_V
    )


def _sound_W(motor: Motor, supply: SupplyFigures, voltage_V: float) -> float:
    """Return the losses that a voltage changes, of a sound motor: of the windings and of the core."""
    machine, plate = motor.parameters, motor.nameplate
    power_W = supply.active_power_W or 0.0
    at = load_point(motor, voltage_V, supply.frequency_hz, power_W)
    copper_W = machine.stator_resistance_ohm * abs(at.current_A) ** 2
    copper_W += machine.rotor_resistance_ohm * abs(at.rotor_current_A) ** 2
    iron_W = other_losses(motor).iron_W * (voltage_V / plate.winding_voltage_V) ** 2
    return 3.0 * HALF_WARM * copper_W + iron_W


def losses_of_cage(rotor: RotorFinding, rotor_copper_W: float) -> float:
    """Return what the rotor loses more because part of its bars do not conduct.

    The severity is the share a by which the resistance of the cage grows on the mean of its axes.

    Parameters
    ----------
    rotor : RotorFinding
        What the record shows of the cage.
    rotor_copper_W : float
        All losses in the rotor [W].

    Returns
    -------
    float
        Losses; zero where no fault of the cage is found [W].
    """
    if rotor.state is not RotorState.FAULT or rotor.severity_dB is None:
        return 0.0
    share = float(10.0 ** (rotor.severity_dB / 20.0))
    return rotor_copper_W * share / (1.0 + share)
