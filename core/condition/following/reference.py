"""How a reference begins, at first and anew, and what is kept where the motor's file becomes another."""

import numpy as np

from core.condition.filter.circle import begin_circle
from core.condition.filter.impedance import impedance_alone, move_impedance
from core.condition.filter.kalman import TEMPERATURE
from core.condition.filter.prior import Prior, prior_of
from core.condition.following.direction_state import DirectionState
from core.condition.following.folding import restart
from core.condition.measuring.circle import NOTHING
from core.condition.measuring.impedance import negative_impedance
from core.machines.parameters import Motor
from core.signals.sequence import PhaseSequence


def begun(motor: Motor, sequence: PhaseSequence) -> DirectionState:
    """Return the state before a motor's first record in one direction of rotation.

    Parameters
    ----------
    motor : Motor
        The motor.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.

    Returns
    -------
    DirectionState
        Nothing is known but the motor's file.
    """
    state = DirectionState(sequence)
    rated = negative_impedance(motor, motor.nameplate.rated_frequency_Hz)
    state.header.scale_ohm = abs(rated)
    state.filter.nominal = rated / abs(rated)
    restart_reference(state, prior_of(motor, state.header.voltage_channels), keep_impedance=False)
    return state


def restart_reference(state: DirectionState, prior: Prior, *, keep_impedance: bool) -> None:
    """Let a reference be learnt anew.

    Parameters
    ----------
    state : DirectionState
        The state; it changes.
    prior : Prior
        Spread of the standing errors before the first record.
    keep_impedance : bool
        Whether what is known of the impedance is kept.
    """
    kalman, header = state.filter, state.header
    errors = np.array([0.0] * 2 + [prior.current] * 2 + [prior.impedance] * 2 + [TEMPERATURE])
    x, P = np.zeros(7), np.diag(errors**2)
    P[:2, :2] = prior.voltage
    if keep_impedance:
        x[4:], P[4:, 4:] = impedance_alone(kalman)
    kalman.x0[:], kalman.P0[:] = x, P
    kalman.current_deviation = prior.current
    state.circles["spread"] = prior.circle
    restart(state.filters, state.sides, state.circles)
    state.parameter_fits[:] = 0
    header.start.clear()
    header.accepted, header.declared = False, None
    header.alarm = header.standing = header.kept = header.gone = header.called = None
    header.held_score = 0.0
    header.bus.restart()
    header.kept_errors = []
    state.later = None


def edit_impedance(state: DirectionState, motor: Motor, edited: Motor) -> None:
    """Keep Z2 and the standing errors as they are known, whatever the motor's file says of Z2.

    Parameters
    ----------
    state : DirectionState
        The state; it changes.
    motor, edited : Motor
        The motor before and after its file was edited.
    """
    frequency_hz, scale_ohm = motor.nameplate.rated_frequency_Hz, state.header.scale_ohm
    before = negative_impedance(motor, frequency_hz) / scale_ohm
    after = negative_impedance(edited, frequency_hz) / scale_ohm
    start = state.header.start
    if motor.parameters != edited.parameters:
        state.parameter_fits[:] = 0
        state.circles["spread"] = prior_of(edited, state.header.voltage_channels).circle
        begin_circle(state.circles.view(np.recarray)[0])
    move_impedance(state.filter, before, after)
    start[:] = [
        record._replace(y=record.y + (before - after) * record.j2, circle=NOTHING) for record in start
    ]
