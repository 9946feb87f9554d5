"""Stepping candidates whose rotor resistance has an axis that turns with the rotor.

    R_r(th) = mean + asymmetry [[cos 2th, sin 2th], [sin 2th, -cos 2th]],     d(th)/dt = w

As in kernel.py, with the drop across the turning part as one more voltage of the rotor, extrapolated to the
middle of the step. Plain loops, one candidate after the other: this is for simulating, not for searching.
"""

import numpy as np

from core.machines.base import Array, RotorAsymmetry
from core.machines.compiled import compiled
from core.machines.delay import delay_voltage
from core.machines.discretisation import Hold, discretise, multiply
from core.machines.kernel import NO_REFERENCE, REFERENCE_DRIFT, mean_over_next_step
from core.machines.stepping import Comparison, InitialState, MachineRates, SteppedVoltage, Track


@compiled
def turning_drop(asymmetry: float, angle: float, i: Array, drop: Array) -> None:
    """Fill the drop across the turning part of the rotor's resistance.

    Parameters
    ----------
    asymmetry : float
        Half the difference of the axes' resistances [ohm].
    angle : float
        Electrical angle of the axis of more resistance [rad].
    i : ndarray, shape (5, 1)
        Currents i_s, i_r, j [A].
    drop : ndarray, shape (2,)
        Filled [V].
    """
    cosine, sine = asymmetry * np.cos(2.0 * angle), asymmetry * np.sin(2.0 * angle)
    drop[0] = cosine * i[2, 0] + sine * i[3, 0]
    drop[1] = sine * i[2, 0] - cosine * i[3, 0]


@compiled
def simulate_turning(
    u: Array, step: float, turn: float, machine: MachineRates, flux: Array, w: float, asymmetry: float,
    angle: float, track: Track,
) -> None:  # fmt: skip
    """Step one candidate through its voltages.

    Parameters
    ----------
    u : ndarray, shape (columns, 2)
        Delayed Clarke voltages [V].
    step : float
        Step [s].
    turn : float
        Angle that the supply turns in a step [rad].
    machine : MachineRates
        Coefficients of one machine.
    flux : ndarray, shape (5,)
        Flux at the first column [V s].
    w : float
        Electrical speed at the first column [rad/s].
    asymmetry : float
        Half the difference of the rotor axes' resistances [ohm].
    angle : float
        Electrical angle of the axis of more resistance at the first column [rad].
    track : Track
        Currents and speeds that are filled.
    """
    current, speed, load, acceleration = track.current, track.speed, machine.load, machine.gain * step
    hold = Hold(np.empty((5, 5)), np.empty((5, 2)), np.empty((5, 2)), np.empty((5, 2)))
    E, G0, G1, H = hold
    x, x_next, i, rotor_before = np.empty((5, 1)), np.empty((5, 1)), np.empty((5, 1)), np.empty(2)
    drop, drop_before, e = np.zeros(2), np.empty(2), np.empty(2)
    x[:, 0], rotor_before[:], reference, half_kick = flux, flux[2:4], NO_REFERENCE, 0.0
    now, before = mean_over_next_step(turn)
    for k in range(u.shape[0]):
        drop_before[:] = drop
        multiply(machine.current_from_flux, x, i)
        turning_drop(asymmetry, angle, i, drop)
        if k == 0:
            drop_before[:] = drop
        current[k] = i[:2, 0]
        pace = w + half_kick
        demand = load[0] + pace * (load[1] + pace * load[2])
        half_kick = 0.5 * acceleration * (x[3, 0] * i[2, 0] - x[2, 0] * i[3, 0] - demand)
        if k > 0:
            w += half_kick
        speed[k] = w
        w += half_kick
        if k == u.shape[0] - 1:
            break
        if not abs(w - reference) <= REFERENCE_DRIFT:
            reference = w
            discretise(machine.decay, reference, step, hold)
        ahead = w - reference
        e[0] = -ahead * (now * x[3, 0] + before * rotor_before[1]) - now * drop[0] - before * drop_before[0]
        e[1] = ahead * (now * x[2, 0] + before * rotor_before[0]) - now * drop[1] - before * drop_before[1]
        rotor_before[:] = x[2:4, 0]
        multiply(E, x, x_next)
        for row in range(5):
            x[row, 0] = x_next[row, 0] + H[row, 0] * e[0] + H[row, 1] * e[1]
            for axis in range(2):
                x[row, 0] += G0[row, axis] * u[k, axis] + G1[row, axis] * u[k + 1, axis]
        angle += step * w


@compiled
def play_turning(
    feed: SteppedVoltage, delay_s: Array, machines: MachineRates, asymmetry: RotorAsymmetry,
    beginning: InitialState, comparison: Comparison, track: Track,
) -> None:  # fmt: skip
    """Step every candidate like `batch.play`, with the turning part of its rotor's resistance.

    Parameters
    ----------
    feed : SteppedVoltage
        Stator voltage and the columns of it that are stepped through.
    delay_s : ndarray, shape (candidates,)
        Delay of each candidate's voltages [s].
    machines : MachineRates
        Coefficients of the batch.
    asymmetry : RotorAsymmetry
        Turning part of the rotors' resistance.
    beginning : InitialState
        State of the candidates at the first column.
    comparison : Comparison
        Measured current, and the squared errors that are filled.
    track : Track
        Currents and speeds that are filled.
    """
    columns, substeps, measured = feed.last - feed.first, feed.substeps, comparison.measured
    u, own = np.empty((columns, 2)), Track(np.empty((columns, 2)), np.empty(columns))
    for c in range(delay_s.size):
        machine = MachineRates(
            machines.decay[c], machines.current_from_flux[c], machines.load[c], machines.gain
        )
        delay_voltage(feed.voltage, delay_s[c] / feed.step_s, feed.first, u)
        simulate_turning(
            u, feed.step_s, feed.angular_frequency * feed.step_s, machine, beginning.flux[:, c],
            beginning.speed[c], asymmetry.resistance[c], asymmetry.angle[c], own,
        )  # fmt: skip
        error = 0.0
        for k in range(0, columns, substeps):
            if track.speed.shape[1] > 0:
                track.current[c, :, k // substeps] = own.current[k]
                track.speed[c, k // substeps] = own.speed[k]
            if measured.shape[0] > 0 and k >= comparison.compare_from:
                difference = own.current[k] - measured[k // substeps]
                error += difference[0] ** 2 + difference[1] ** 2
        comparison.squared_error[c] = error if np.isfinite(error) else np.inf
