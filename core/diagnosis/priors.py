"""What is known before a record is compared: how sensors, parameters, delays and loads are distributed.

A fit compares four real figures, the forward- and the backward-turning current. Level, load, offset and the
resistance of the path are four unknowns, so the record alone decides between none of them. What decides is
how far sensors, parameters and delays of real plants are off.
"""

from dataclasses import dataclass, replace
from math import log

import numpy as np

from core.diagnosis.fundamental import Fundamental, components
from core.diagnosis.refinement import CHANNEL_RATIO, COMPONENTS_OF_A_RATIO
from core.machines.base import Array
from core.machines.candidates import Candidates
from core.machines.running import SteadyRunning

PARAMETER_RATIO = 0.06
"""Standard deviation of each machine parameter over its value: within 10 %, uniformly."""
PARAMETER_STEP = 0.01
OFFSET_S, LONG_OFFSET_S = 100e-6, 1e-3
"""Standard deviations of the offset between a relay's currents and voltages: of nearly all relays, and of
those with a filter or a setting in only one of the two."""
LONG_OFFSETS = 0.01
"""Share of the relays with a long offset."""
GENERATING = 0.05
"""Load below zero that counts as one standard deviation: a motor drives, but its no-load losses are not
known exactly."""


@dataclass(frozen=True, slots=True)
class Beliefs:
    """Squared misfit and rows of least squares of the priors on offset and load, for a batch.

    Parameters
    ----------
    misfit : ndarray, shape (candidates,)
        Minus twice the log of the priors' density over its greatest.
    offset, load : ndarray, shape (candidates,)
        Rows of a least-squares fit; their squares have the slope of `misfit`.
    offset_slope, load_slope : ndarray, shape (candidates,)
        Slopes of the rows by offset [1/s] and load.
    """

    misfit: Array
    offset: Array
    load: Array
    offset_slope: Array
    load_slope: Array


def beliefs(time_offset_s: Array, load_level: Array) -> Beliefs:
    """Return what the priors make of offsets and loads.

    The offset's density is Gaussian with tails, (1 - e) N(0, OFFSET_S) + e N(0, LONG_OFFSET_S): a record that
    does tell a long offset is believed. The load's is flat, and falls below zero.

    Parameters
    ----------
    time_offset_s : ndarray, shape (candidates,)
        Delay of the currents against the voltages [s].
    load_level : ndarray, shape (candidates,)
        Load torque over rated torque.

    Returns
    -------
    Beliefs
        Misfit and rows.
    """
    usual = (1.0 - LONG_OFFSETS) / OFFSET_S * np.exp(-0.5 * (time_offset_s / OFFSET_S) ** 2)
    long = LONG_OFFSETS / LONG_OFFSET_S * np.exp(-0.5 * (time_offset_s / LONG_OFFSET_S) ** 2)
    density = usual + long
    offset_slope = np.sqrt((usual / OFFSET_S**2 + long / LONG_OFFSET_S**2) / density)
    load_slope = np.where(load_level < 0.0, 1.0 / GENERATING, 0.0)
    load = load_slope * load_level
    greatest = log((1.0 - LONG_OFFSETS) / OFFSET_S + LONG_OFFSETS / LONG_OFFSET_S)
    return Beliefs(
        misfit=2.0 * (greatest - np.log(density)) + load**2,
        offset=offset_slope * time_offset_s,
        load=load,
        offset_slope=offset_slope,
        load_slope=load_slope,
    )


def systematic_covariance(
    record: Fundamental, running: SteadyRunning, near: Candidates, admittance: Array, known_share: float
) -> Array:
    """Return the covariance of the current's components that sensors and parameters cause.

    Every channel's complex ratio errs by CHANNEL_RATIO, that of a voltage through the machine's admittance;
    each of the five parameters errs by PARAMETER_RATIO, independently.

    Parameters
    ----------
    record : Fundamental
        Phasors of currents and voltages.
    running : SteadyRunning
        The motor on the record's voltage.
    near : Candidates
        Candidate near the truth, a batch of one.
    admittance : ndarray, shape (4, 4)
        How the current's components follow the voltage's [A/V].
    known_share : float
        Share of the channels' errors that a baseline has taken off.

    Returns
    -------
    ndarray, shape (4, 4)
        Covariance [A^2].
    """
    ratio = (CHANNEL_RATIO * (1.0 - known_share)) ** 2 / COMPONENTS_OF_A_RATIO
    amperes = abs(record.current.forward) ** 2 + abs(record.current.backward) ** 2
    covariance = ratio * amperes * np.eye(4)
    covariance += ratio * abs(record.voltage.forward) ** 2 * admittance @ admittance.T
    here = components(running.state(near).current)[0]
    machine = running.motor.parameters
    for name in (
        "stator_resistance_ohm", "rotor_resistance_ohm",
        "stator_leakage_H", "rotor_leakage_H", "stator_self_inductance_H",
    ):  # fmt: skip
        other = replace(machine, **{name: getattr(machine, name) * (1.0 + PARAMETER_STEP)})
        motor = replace(running.motor, parameters=other)
        moved = SteadyRunning(running.model, motor, running.angular_frequency, running.phasor)
        slope = (components(moved.state(near).current)[0] - here) / PARAMETER_STEP
        covariance += PARAMETER_RATIO**2 * np.outer(slope, slope)
    return np.asarray(covariance)
