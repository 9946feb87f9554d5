"""What a pair of lines beside the fundamental means for the air gap and for the load.

A rotor out of the middle of its bore changes the gap's permeance once a turn, and the magnetising current
with it; a load that swings changes the speed, and the torque with it. Both make lines at the same places. In
the frame of the supply, with eps the relative ripple of the permeance and w that of the rotor's speed,

    psi_s = L_ls i_s + psi_m,    psi_m = L_m (1 + eps) (i_s + i_r),    psi_r = psi_m + L_lr i_r
    0 = R_r i_r + d(psi_r)/dt + j (s w_s - w) psi_r

The stator's flux follows from voltage and current. At + Omega and - Omega about the steady running these are
two complex equations, linear in eps and w, so one pair of lines tells both. The load's share of a swing is
what the equation of motion lacks, T_load = T_e - (J / p) dw/dt.
"""

from dataclasses import dataclass

from core.machines.base import Array
from core.machines.parameters import Motor
from core.machines.steady_state import ComplexArray
from core.rotor.running_point import RunningPoint
from core.rotor.sidebands import Lines


@dataclass(frozen=True, slots=True)
class Ripples:
    """What pairs of lines mean.

    Parameters
    ----------
    permeance : ndarray of complex, shape (pairs,)
        Amplitude of the relative ripple of the air gap's permeance.
    load_torque : ndarray of complex, shape (pairs,)
        Amplitude of the load's torque, over rated torque.
    """

    permeance: ComplexArray
    load_torque: ComplexArray


def ripples(
    lines: Lines, distance: Array, point: RunningPoint, motor: Motor, *, even_gap: bool = False
) -> Ripples:
    """Tell ripples of the air gap and of the load apart in pairs of lines.

    Parameters
    ----------
    lines : Lines
        Amplitudes of voltage and current.
    distance : ndarray, shape (pairs,)
        Omega, the distance of each pair from the fundamental [rad/s].
    point : RunningPoint
        Steady running about which the lines are small.
    motor : Motor
        Nameplate and parameters of the motor.
    even_gap : bool, default False
        Whether the gap is known to be even; all of the lines then comes from speed and voltage.

    Returns
    -------
    Ripples
        Ripples of the permeance and of the load's torque.
    """
    machine, p = motor.parameters, motor.nameplate.pole_pairs
    R_s, R_r, L_m = (
        machine.stator_resistance_ohm,
        machine.rotor_resistance_ohm,
        machine.magnetising_inductance_H,
    )
    L_ls, L_lr, w_s = machine.stator_leakage_H, machine.rotor_leakage_H, point.angular_frequency
    I_s, Psi_s, Psi_r = point.current, point.stator_flux, point.rotor_flux
    I_m, w_slip = I_s + point.rotor_current, point.slip_over_resistance * R_r

    v_upper, i_upper = lines.upper.T
    v_lower, i_lower = lines.lower.T
    psi_s_upper = (v_upper - R_s * i_upper) / (1j * (w_s + distance))
    psi_s_lower = (v_lower - R_s * i_lower) / (1j * (w_s - distance))
    psi_m_upper, psi_m_lower = psi_s_upper - L_ls * i_upper, psi_s_lower - L_ls * i_lower
    # Rotor currents in a gap without ripple; a ripple eps takes eps I_m / 2 off them.
    i_r_upper, i_r_lower = psi_m_upper / L_m - i_upper, psi_m_lower / L_m - i_lower
    Z_upper = R_r + 1j * (w_slip + distance) * L_lr
    Z_lower = R_r - 1j * (w_slip - distance) * L_lr
    upper = Z_upper * i_r_upper + 1j * (w_slip + distance) * psi_m_upper
    lower = Z_lower * i_r_lower.conj() - 1j * (w_slip - distance) * psi_m_lower.conj()
    # upper = Z_upper I_m eps / 2 + j Psi_r w,   lower = Z_lower I_m* eps / 2 - j Psi_r* w
    if even_gap:
        permeance = 0.0 * upper
    else:
        permeance = (
            2.0
            * (upper * Psi_r.conjugate() + lower * Psi_r)
            / (Z_upper * I_m * Psi_r.conjugate() + Z_lower * I_m.conjugate() * Psi_r)
        )
    speed = (upper - Z_upper * I_m * permeance / 2.0) / (1j * Psi_r)
    # T_e = p Im(i_s conj(psi_s)); the amplitude of what is real is twice its part at +Omega.
    torque = (p / 1j) * (
        i_upper * Psi_s.conjugate()
        + I_s * psi_s_lower.conj()
        - i_lower.conj() * Psi_s
        - I_s.conjugate() * psi_s_upper
    )
    # A gap that ripples with the shaft's angle pulls at it, too: i^2 / 2 dL/d(theta_m).
    torque += 0.5j * L_m * abs(I_m) ** 2 * permeance
    inertia_torque = 2.0 * (machine.inertia_kgm2 / p) * 1j * distance * speed
    return Ripples(permeance, (torque - inertia_torque) / motor.nameplate.rated_torque_Nm)
