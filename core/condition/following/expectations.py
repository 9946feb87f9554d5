"""What is expected of a motor before its first record: how large its errors are, and how changes look."""

from dataclasses import dataclass

import numpy as np

from core.condition.changes.hypotheses import LEVEL, Hypotheses, hypotheses_of
from core.condition.filter.prior import Prior, prior_of
from core.condition.measuring.turns_grid import FINE, ROUGH, TurnsGrid, turns_grid
from core.condition.observation import VoltageChannels
from core.diagnosis.priors import UNKNOWN_ASYMMETRY
from core.machines.base import Array
from core.machines.parameters import Motor
from core.signals.sequence import PhaseSequence


@dataclass(frozen=True, slots=True)
class Expectations:
    """What a motor's file tells of its records.

    Parameters
    ----------
    prior : Prior
        Spread of the standing errors.
    voltage : ndarray, shape (2, 2)
        Covariance of E.
    usual_difference : float
        What V2/V1 of two voltage transformers of the motor's class usually differs by.
    hypotheses : array of Hypothesis
        All places of all causes of a change.
    rough, coarse, fine : TurnsGrid
        Shorted turns by axis and leakage: near enough for what stands, for a cause, and for a level.
    jumps : ndarray, shape (6,)
        Standard deviations of the parts of free jumps: four of another recorder, one of shorted turns of any
        axis and leakage in y, one of an asymmetry of unknown cause.
    """

    prior: Prior
    voltage: Array
    usual_difference: float
    hypotheses: Hypotheses
    rough: TurnsGrid
    coarse: TurnsGrid
    fine: TurnsGrid
    jumps: Array


def expectations_of(
    motor: Motor, channels: VoltageChannels, sequence: PhaseSequence, scale_ohm: float
) -> Expectations:
    """Return what a motor's file tells of its records.

    Parameters
    ----------
    motor : Motor
        The motor.
    channels : VoltageChannels
        Which voltages are measured.
    sequence : PhaseSequence
        Order of the supply's phases at the terminals.
    scale_ohm : float
        Impedance z that the records are divided by [ohm].

    Returns
    -------
    Expectations
        Errors and changes that may be.
    """
    prior = prior_of(motor, channels)
    voltage = prior.voltage
    jump = float(np.sqrt(np.trace(voltage)))
    grid = turns_grid(motor, sequence, scale_ohm)
    turns = LEVEL * float(np.sqrt(grid.usual @ np.abs(grid.y) ** 2))
    return Expectations(
        prior=prior,
        voltage=voltage,
        usual_difference=float(np.sqrt(2.0 * np.trace(prior.channels))),
        hypotheses=hypotheses_of(motor, sequence, channels, scale_ohm),
        rough=turns_grid(motor, sequence, scale_ohm, ROUGH),
        coarse=grid,
        fine=turns_grid(motor, sequence, scale_ohm, FINE),
        jumps=np.array(
            [jump] * 2 + [np.sqrt(2.0) * prior.current] * 2 + [np.sqrt(0.5) * turns, UNKNOWN_ASYMMETRY]
        ),
    )
