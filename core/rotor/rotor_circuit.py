"""What the voltages and currents at the sidebands say of the rotor's circuit.

In the frame of the supply, with complex space vectors and Omega = 2 s w_s, the stator gives the flux of every
line and so the current in the rotor (3.13 to 3.15):

    psi_s = (v - R_s i_s) / (j (w_s +- Omega)),   i_r = (psi_s - (L_ls + L_m) i_s) / L_m,
    psi_r = L_lr i_r + L_m (i_s + i_r)

The rotor's equation is 0 = R_r i_r + d(psi_r)/dt + j (w_s - w) psi_r + d, where d is the drop that a cage has
beside R_r i_r. With broken bars it is d = a R_r e^{-j Omega t} conj(I_r) (core.machines.broken_bars): it lies
at the lower sideband alone. A ripple w of the speed, whatever makes it, adds -j w Psi_r at both. Hence

    upper:  j w Psi_r / R_r       = i_r + 3 j lambda psi_r
    lower:  a conj(I_r)           = -(i_r - j lambda psi_r) + j conj(w) Psi_r / R_r,   lambda = s w_s / R_r

so the upper sideband tells the ripple, and what the same ripple makes of the lower one is taken off. Neither
inertia nor load enters, nor does R_r, for lambda follows from the torque. The voltages' own sidebands are in
psi_s, so that a supply that pulsates is no rotor's fault.

The load's share of the ripple is what the equation of motion lacks, T_load = T_e - (J / p) dw/dt.
"""

from dataclasses import dataclass

from core.machines.base import Array
from core.machines.parameters import MachineParameters, Motor
from core.machines.steady_state import ComplexArray
from core.rotor.running_point import RunningPoint
from core.rotor.sidebands import Lines


@dataclass(frozen=True, slots=True)
class RotorLines:
    """What pairs of lines mean for the rotor.

    Parameters
    ----------
    asymmetry : ndarray of complex, shape (pairs,)
        Half the difference of the resistances of the cage's axes, over R_r: a.
    load_torque : ndarray of complex, shape (pairs,)
        Amplitude of the load's torque, over rated torque.
    inertia_torque : ndarray of complex, shape (pairs,)
        Amplitude of the torque that the ripple of the speed takes, over rated torque.
    """

    asymmetry: ComplexArray
    load_torque: ComplexArray
    inertia_torque: ComplexArray


def rotor_lines(lines: Lines, distance: Array, point: RunningPoint, motor: Motor) -> RotorLines:
    """Tell the rotor's asymmetry from the load's swing in pairs of lines.

    Parameters
    ----------
    lines : Lines
        Amplitudes of voltage and current.
    distance : ndarray, shape (pairs,)
        Omega, the distance of each pair from the fundamental, which is taken to be 2 s w_s [rad/s].
    point : RunningPoint
        Operating point as the motor's parameters see it. It gives lambda, so that another distance means
        another rotor resistance.
    motor : Motor
        Nameplate and parameters of the motor.

    Returns
    -------
    RotorLines
        The rotor's asymmetry and the load's torque.
    """
    machine, p = motor.parameters, motor.nameplate.pole_pairs
    w_s, lam = point.angular_frequency, point.slip_over_resistance
    I_s, Psi_s, Psi_r, I_r = point.current, point.stator_flux, point.rotor_flux, point.rotor_current
    psi_s_upper, i_r_upper, psi_r_upper = rotor_side(lines.upper, w_s + distance, machine)
    psi_s_lower, i_r_lower, psi_r_lower = rotor_side(lines.lower, w_s - distance, machine)
    ripple = (i_r_upper + 3j * lam * psi_r_upper) / (1j * Psi_r)  # w / R_r
    asymmetry = (1j * ripple.conj() * Psi_r - i_r_lower + 1j * lam * psi_r_lower) / I_r.conjugate()
    # T_e = p Im(i_s conj(psi_s)); the amplitude of what is real is twice its part at +Omega.
    torque = (p / 1j) * (
        lines.upper[:, 1] * Psi_s.conjugate()
        + I_s * psi_s_lower.conj()
        - lines.lower[:, 1].conj() * Psi_s
        - I_s.conjugate() * psi_s_upper
    )
    R_r = distance / (2.0 * lam)
    inertia_torque = 2.0 * (machine.inertia_kgm2 / p) * 1j * distance * ripple * R_r
    rated = motor.nameplate.rated_torque_Nm
    return RotorLines(asymmetry, (torque - inertia_torque) / rated, inertia_torque / rated)


def rotor_side(
    line: ComplexArray, w: Array, machine: MachineParameters
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return what a line at the terminals is in the machine.

    Parameters
    ----------
    line : ndarray of complex, shape (lines, 2)
        Amplitudes of voltage and current.
    w : ndarray, shape (lines,)
        Angular frequency of each line [rad/s].
    machine : MachineParameters
        Parameters of the machine.

    Returns
    -------
    tuple of ndarray of complex, shape (lines,)
        Stator flux psi_s [V s], rotor current i_r [A] and rotor flux psi_r [V s].
    """
    L_ls, L_m = machine.stator_leakage_H, machine.magnetising_inductance_H
    v, i_s = line.T
    psi_s = (v - machine.stator_resistance_ohm * i_s) / (1j * w)
    i_r = (psi_s - (L_ls + L_m) * i_s) / L_m
    return psi_s, i_r, machine.rotor_leakage_H * i_r + L_m * (i_s + i_r)
