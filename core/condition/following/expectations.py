"""What is expected of a motor before its first record: how large its errors are, and how changes look."""

from dataclasses import dataclass

import numpy as np

from core.condition.changes.hypotheses import Hypotheses, hypotheses_of
from core.condition.filter.prior import Prior, prior_of
from core.condition.observation import VoltageChannels
from core.machines.base import Array
from core.machines.parameters import Motor


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
    recorder : ndarray, shape (4,)
        Standard deviations of the jumps that another recorder makes.
    """

    prior: Prior
    voltage: Array
    usual_difference: float
    hypotheses: Hypotheses
    recorder: Array


def expectations_of(motor: Motor, channels: VoltageChannels, scale_ohm: float) -> Expectations:
    """Return what a motor's file tells of its records.

    Parameters
    ----------
    motor : Motor
        The motor.
    channels : VoltageChannels
        Which voltages are measured.
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
    return Expectations(
        prior=prior,
        voltage=voltage,
        usual_difference=float(np.sqrt(2.0 * np.trace(prior.channels))),
        hypotheses=hypotheses_of(motor, channels, scale_ohm),
        recorder=np.array([jump] * 2 + [np.sqrt(2.0) * prior.current] * 2),
    )
