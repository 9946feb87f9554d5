"""What is known of offsets and loads before a record is compared.

A fit compares four real figures, the forward- and the backward-turning current. Level, load, offset and the
resistance of the path are four unknowns, so the record alone decides between none of them. What decides is
how far offsets and loads of real plants go, and what sensors and parameters make of the currents
(`core.diagnosis.propagation`).
"""

from dataclasses import dataclass
from math import log

import numpy as np

from core.machines.base import Array

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
