"""Periodic steady state from phasors: the slip by one torque balance, the flux of every circuit at t = 0.

At constant speed the five circuits are linear and real, so one complex solution per candidate at +w_s carries
the positive and the negative sequence together: with v(t) = Re(V e^{j w_s t}) on both Clarke axes,

    (j w_s I - A(w)) Psi = [V; 0],   A(w) = -R inv(L) + w Jr,
    T_e / p = Re(Psi_r x conj(I_r)) / 2  (mean)  +  Re((Psi_r x I_r) e^{j 2 w_s t}) / 2  (ripple)

Where both sequences turn, the ripple makes the speed w + Re(W e^{j 2 w_s t}), and that answers in the flux:

    (j w_s I - A(w)) dPsi_1 = W Jr conj(Psi) / 2,     (j 3 w_s I - A(w)) Psi_3 = W Jr Psi / 2

both proportional to W, so that their torque closes one linear equation for W: harmonic balance at w_s and
3 w_s, with the mean speed corrected to the second order in W / w_s (which is below 1 %).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.compiled import compiled
from core.machines.stepping import MachineRates

ComplexArray = NDArray[np.complex128]

SPEED_TOLERANCE = 1e-9
MOST_ITERATIONS = 60


class SinusoidalSupply(NamedTuple):
    """A supply of one frequency, and where the machine pulls out on it.

    Parameters
    ----------
    angular_frequency : float
        Angular frequency w_s [rad/s].
    phasor : ndarray of complex, shape (2,)
        Voltage on the Clarke axes at t = 0 without delay, peak [V].
    pull_out_slip : float
        Slip of the healthy machine's greatest torque.
    """

    angular_frequency: float
    phasor: ComplexArray
    pull_out_slip: float


class SteadyState(NamedTuple):
    """Periodic steady state of a batch.

    Parameters
    ----------
    flux : ndarray, shape (5, candidates)
        Flux of every circuit at t = 0 [V s].
    speed, mean_speed : ndarray, shape (candidates,)
        Electrical speed at t = 0, and its mean [rad/s].
    current : ndarray of complex, shape (2, candidates)
        Phasors of the stator current at w_s on the Clarke axes, peak [A].
    balanced : ndarray of bool, shape (candidates,)
        Whether there is a speed at which the torques balance.
    """

    flux: Array
    speed: Array
    mean_speed: Array
    current: ComplexArray
    balanced: NDArray[np.bool_]


@compiled
def solve_circuits(decay: Array, w: float, frequency: float, drive: ComplexArray, flux: ComplexArray) -> None:
    """Solve flux = inv(j frequency I - decay - w Jr) [drive; 0] by elimination.

    The diagonal dominates, so that no pivoting is needed.

    Parameters
    ----------
    decay : ndarray, shape (5, 5)
        Matrix of the flux's decay, -R inv(L) [1/s].
    w : float
        Electrical speed [rad/s].
    frequency : float
        Angular frequency of the phasors [rad/s].
    drive : ndarray of complex, shape (4,)
        Phasors of the stator's and the rotor's voltage, peak [V].
    flux : ndarray of complex, shape (5,)
        Filled with the phasors of the flux, peak [V s].
    """
    M = np.empty((5, 6), np.complex128)
    for i in range(5):
        for j in range(5):
            M[i, j] = -decay[i, j]
        M[i, i] += 1j * frequency
        M[i, 5] = drive[i] if i < 4 else 0.0
    M[2, 3] += w
    M[3, 2] -= w
    for i in range(5):
        for row in range(i + 1, 5):
            factor = M[row, i] / M[i, i]
            for j in range(i, 6):
                M[row, j] -= factor * M[i, j]
    for i in range(4, -1, -1):
        total = M[i, 5]
        for j in range(i + 1, 5):
            total -= M[i, j] * flux[j]
        flux[i] = total / M[i, i]


@compiled
def rotor_current(current_from_flux: Array, flux: ComplexArray, rotor: ComplexArray) -> None:
    """Fill the rotor current from the flux of all circuits.

    Parameters
    ----------
    current_from_flux : ndarray, shape (5, 5)
        Inverse of the inductances, inv(L) [1/H].
    flux : ndarray of complex, shape (5,)
        Phasors of the flux of every circuit, peak [V s].
    rotor : ndarray of complex, shape (2,)
        Phasors of the rotor current, peak [A].
    """
    for axis in range(2):
        rotor[axis] = 0.0
        for j in range(5):
            rotor[axis] += current_from_flux[2 + axis, j] * flux[j]


@compiled
def mean_torque(
    machine: MachineRates, w: float, w_s: float, drive: ComplexArray, flux: ComplexArray, rotor: ComplexArray
) -> float:
    """Return the mean of T_e / p at a speed; leave the flux and the rotor current of that speed behind.

    Parameters
    ----------
    machine : MachineRates
        Coefficients of one machine.
    w : float
        Electrical speed [rad/s].
    w_s : float
        Angular frequency of the supply [rad/s].
    drive : ndarray of complex, shape (4,)
        Phasors of the stator's and the rotor's voltage, peak [V].
    flux : ndarray of complex, shape (5,)
        Phasors of the flux of every circuit, peak [V s].
    rotor : ndarray of complex, shape (2,)
        Phasors of the rotor current, peak [A].

    Returns
    -------
    float
        Torque over pole pairs [N m].
    """
    solve_circuits(machine.decay, w, w_s, drive, flux)
    rotor_current(machine.current_from_flux, flux, rotor)
    crossed = flux[3] * np.conj(rotor[0]) - flux[2] * np.conj(rotor[1])
    return 0.5 * float(crossed.real)


@compiled
def surplus_torque(
    machine: MachineRates, w: float, w_s: float, drive: ComplexArray, flux: ComplexArray, rotor: ComplexArray
) -> float:
    """Return the mean of (T_e - T_load) / p at a speed; leave flux and rotor current like `mean_torque`.

    Parameters
    ----------
    machine : MachineRates
        Coefficients of one machine.
    w : float
        Electrical speed [rad/s].
    w_s : float
        Angular frequency of the supply [rad/s].
    drive : ndarray of complex, shape (4,)
        Phasors of the stator's and the rotor's voltage, peak [V].
    flux : ndarray of complex, shape (5,)
        Phasors of the flux of every circuit, peak [V s].
    rotor : ndarray of complex, shape (2,)
        Phasors of the rotor current, peak [A].

    Returns
    -------
    float
        Torque over pole pairs [N m].
    """
    load = machine.load
    return mean_torque(machine, w, w_s, drive, flux, rotor) - float(load[0] + w * (load[1] + w * load[2]))


@compiled
def balance(
    machine: MachineRates, w_s: float, drive: ComplexArray, pull_out_slip: float, flux: ComplexArray,
    rotor: ComplexArray,
) -> tuple[float, bool]:  # fmt: skip
    """Find the speed at which motor and load torque agree, by regula falsi (Illinois).

    It is sought between pull-out and synchronism, and a little above for the drag of the negative sequence.

    Parameters
    ----------
    machine : MachineRates
        Coefficients of one machine.
    w_s : float
        Angular frequency of the supply [rad/s].
    drive : ndarray of complex, shape (4,)
        Phasors of the stator's and the rotor's voltage, peak [V].
    pull_out_slip : float
        Slip of the healthy machine's greatest torque.
    flux : ndarray of complex, shape (5,)
        Phasors of the flux of every circuit, peak [V s].
    rotor : ndarray of complex, shape (2,)
        Phasors of the rotor current, peak [A].

    Returns
    -------
    speed : float
        Electrical speed [rad/s].
    balanced : bool
        False where the load is too heavy or the torque is no number.
    """
    low, high = w_s * (1.0 - pull_out_slip), w_s * (1.0 + 0.1 * pull_out_slip)
    surplus_low = surplus_torque(machine, low, w_s, drive, flux, rotor)
    if not surplus_low > 0.0:  # nor is a machine balanced whose torque is no number
        return low, False
    surplus_high = surplus_torque(machine, high, w_s, drive, flux, rotor)
    w, side = high, 0
    for _ in range(MOST_ITERATIONS):
        previous = w
        w = (low * surplus_high - high * surplus_low) / (surplus_high - surplus_low)
        surplus = surplus_torque(machine, w, w_s, drive, flux, rotor)
        if abs(w - previous) < SPEED_TOLERANCE * w_s:
            break
        if surplus > 0.0:
            low, surplus_low = w, surplus
            if side == 1:
                surplus_high *= 0.5
            side = 1
        else:
            high, surplus_high = w, surplus
            if side == -1:
                surplus_low *= 0.5
            side = -1
    return w, True


@compiled
def answer_speed(
    machine: MachineRates, w: float, frequency: float, amplitude: complex, turned: ComplexArray,
    flux: ComplexArray, rotor: ComplexArray,
) -> None:  # fmt: skip
    """Fill flux and rotor current in answer to a voltage of the rotor, amplitude times Jr turned.

    Parameters
    ----------
    machine : MachineRates
        Coefficients of one machine.
    w : float
        Electrical speed [rad/s].
    frequency : float
        Angular frequency of the answer [rad/s].
    amplitude : complex
        Amplitude of the speed's ripple [rad/s].
    turned : ndarray of complex, shape (5,)
        Flux that the ripple turns [V s].
    flux : ndarray of complex, shape (5,)
        Phasors of the flux of every circuit, peak [V s].
    rotor : ndarray of complex, shape (2,)
        Phasors of the rotor current, peak [A].
    """
    drive = np.zeros(4, np.complex128)
    drive[2], drive[3] = -amplitude * turned[3], amplitude * turned[2]
    solve_circuits(machine.decay, w, frequency, drive, flux)
    rotor_current(machine.current_from_flux, flux, rotor)


@compiled
def cross(flux: ComplexArray, rotor: ComplexArray) -> complex:
    """Return psi_r_beta i_r_alpha - psi_r_alpha i_r_beta: T_e / p of two real vectors.

    Parameters
    ----------
    flux : ndarray of complex, shape (5,)
        Phasors of the flux of every circuit, peak [V s].
    rotor : ndarray of complex, shape (2,)
        Phasors of the rotor current, peak [A].

    Returns
    -------
    complex
        The product.
    """
    return complex(flux[3] * rotor[0] - flux[2] * rotor[1])


@compiled
def answer_ripple(
    machine: MachineRates, w: float, w_s: float, flux: ComplexArray, rotor: ComplexArray, third: ComplexArray
) -> tuple[float, complex]:
    """Find the mean speed and the amplitude W of its ripple, and add their answer to the flux.

    The mean torque changes with |W|^2, and the mean speed makes up for it.

    Parameters
    ----------
    machine : MachineRates
        Coefficients of one machine.
    w : float
        Electrical speed without ripple [rad/s].
    w_s : float
        Angular frequency of the supply [rad/s].
    flux : ndarray of complex, shape (5,)
        Phasors of the flux at constant speed, in and out [V s].
    rotor : ndarray of complex, shape (2,)
        Phasors of the rotor current at constant speed, in and out [A].
    third : ndarray of complex, shape (5,)
        Filled with the flux at 3 w_s [V s].

    Returns
    -------
    speed : float
        Mean electrical speed [rad/s].
    ripple : complex
        W [rad/s].
    """
    once, steady, again = np.empty(5, np.complex128), np.empty(5, np.complex128), np.empty(5, np.complex128)
    i_once, i_steady, i_again = (
        np.empty(2, np.complex128), np.empty(2, np.complex128), np.empty(2, np.complex128),
    )  # fmt: skip
    i_third = np.empty(2, np.complex128)
    answer_speed(machine, w, w_s, 0.5, np.conj(flux), once, i_once)
    answer_speed(machine, w, 3.0 * w_s, 0.5, flux, third, i_third)
    answer_speed(machine, w, w_s, 1.0, flux, steady, i_steady)
    load, gain = machine.load, machine.gain
    load_slope = load[1] + 2.0 * w * load[2]
    ripple_slope = 0.5 * (
        cross(once, rotor) + cross(flux, i_once)
        + cross(third, np.conj(rotor)) + cross(np.conj(flux), i_third)
    )  # fmt: skip
    ripple = gain * 0.5 * cross(flux, rotor) / (2j * w_s + gain * (load_slope - ripple_slope))

    # Of second order: the ripple of the third harmonic back at w_s, and the mean torque.
    once *= ripple
    i_once *= ripple
    third *= ripple
    i_third *= ripple
    answer_speed(machine, w, w_s, 0.5 * np.conj(ripple), third, again, i_again)
    mean_slope = 0.5 * (cross(steady, np.conj(rotor)) + cross(np.conj(flux), i_steady)).real
    gained = -0.5 * cross(flux, np.conj(rotor)).real
    flux += once + again
    rotor += i_once + i_again
    gained += 0.5 * (cross(flux, np.conj(rotor)) + cross(third, np.conj(i_third))).real
    # Near pull-out the slopes cancel; what is of second order stays below what is of first.
    most = abs(ripple)
    shift = min(most, max(-most, gained / (load_slope - mean_slope)))
    flux += shift * steady
    return w + shift, complex(ripple)
