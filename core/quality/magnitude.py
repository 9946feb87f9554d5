"""Checks on the order of magnitude of a record's samples, before anything is squared."""

from collections.abc import Iterator
from math import sqrt

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Nameplate
from core.operation import Operation
from core.quality.finding import QualityFinding, finding
from core.quality.ratios import voltage_cause
from core.quality.supply import FREQUENCY_TOLERANCE, UNBALANCE, feed_of
from core.quantity_text import plain
from core.signals.terminals import Terminals

LEAST_SIGNAL, HIGHEST_SIGNAL = 0.005, 1e4
"""Range of a signal, over the rated amplitude.

A motor that is switched off shows offsets and noise below it. No wrong ratio causes values above it.
"""
NO_CURRENT = 1e-6
"""Share of the rated current that is too small to be explained by a wrong ratio or unit."""
FAINTEST = 1e-4
"""Share of the rated voltage below which no ratio or unit is thought of: kilovolts called volts have more."""
CLEAN = 0.9
"""Least share of the fundamental in the rms value of a voltage that is there, and only scaled wrongly."""
EFFICIENCY_TIMES_POWER_FACTOR = 0.6
"""Value of small motors, from which the order of magnitude of the rated current is estimated."""


def rated_current_A(nameplate: Nameplate) -> float:
    """Estimate the order of magnitude of the rated line current from power and voltage.

    Parameters
    ----------
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    float
        Current, rms [A].
    """
    apparent = nameplate.rated_power_W / EFFICIENCY_TIMES_POWER_FACTOR
    return float(apparent / (sqrt(3.0) * nameplate.rated_voltage_V))


def magnitude(terminals: Terminals, nameplate: Nameplate) -> Iterator[QualityFinding]:
    """Check the order of magnitude of the samples; only failures are told.

    The samples must be finite.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    nameplate : Nameplate
        Rated values of the motor.

    Yields
    ------
    QualityFinding
        A failure.
    """
    amps = _amps(terminals, nameplate)
    yield from _too_large("current", amps)
    if terminals.voltage_ab is None:
        volts = 1.0
    else:
        volts = _volts(terminals, nameplate)
        yield from _too_large("voltage", volts)
    scaled = _cause_of_low_voltage(terminals, nameplate) if FAINTEST < volts < LEAST_SIGNAL else ""
    if scaled:
        yield finding(
            "voltage", volts, LEAST_SIGNAL, "of rated", passed=False,
            message=f"the voltages are a clean supply of {plain(volts, 2)} of the rated one: {scaled}",
        )  # fmt: skip
    elif volts < LEAST_SIGNAL and amps < LEAST_SIGNAL:
        yield finding(
            "not-running", amps, LEAST_SIGNAL, "of rated", passed=False, operation=Operation.NOT_RUNNING,
            message="neither voltage nor current: the motor is switched off",
        )  # fmt: skip
    elif volts < LEAST_SIGNAL:
        yield finding(
            "voltage", volts, LEAST_SIGNAL, "of rated", passed=False,
            message=f"current flows but the voltages are {plain(volts, 2)} of rated: transformers off, fuses "
            "blown or a wrong ratio or unit; without voltages, --currents-only gives a hint",
        )  # fmt: skip
    elif amps < NO_CURRENT:
        yield finding(
            "not-running", amps, NO_CURRENT, "of rated", passed=False, operation=Operation.NOT_RUNNING,
            message="no current flows: the motor is switched off, or the current transformers are",
        )  # fmt: skip


def is_far_too_large(terminals: Terminals, nameplate: Nameplate) -> bool:
    """Tell whether samples are larger than any wrong ratio makes them: nothing can be computed of them.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    bool
        Whether some are, or are no finite numbers.
    """
    volts = 0.0 if terminals.voltage_ab is None else _volts(terminals, nameplate)
    return not (_amps(terminals, nameplate) <= HIGHEST_SIGNAL and volts <= HIGHEST_SIGNAL)


def _amps(terminals: Terminals, nameplate: Nameplate) -> float:
    """Return the swing of the currents over the rated one's."""
    return _swing(terminals.current_abc) / (sqrt(2.0) * rated_current_A(nameplate))


def _volts(terminals: Terminals, nameplate: Nameplate) -> float:
    """Return the swing of the voltages over the rated one's."""
    return _swing(terminals.voltages) / (sqrt(2.0) * nameplate.rated_voltage_V)


def _cause_of_low_voltage(terminals: Terminals, nameplate: Nameplate) -> str:
    """Return which ratio makes the rated voltage of a small one; "" where it is no clean supply."""
    feed = feed_of(terminals, nameplate)
    if isinstance(feed, QualityFinding) or feed.phasors.unbalance_factor > UNBALANCE:
        return ""
    if abs(feed.frequency_hz / nameplate.rated_frequency_Hz - 1.0) > FREQUENCY_TOLERANCE:
        return ""
    if float(np.abs(feed.channels).max()) < CLEAN * float(terminals.voltages.std(axis=1).max()):
        return ""
    return voltage_cause(sqrt(3.0) * feed.strong, nameplate, terminals.voltage_channels)


def _too_large(name: str, share: float) -> Iterator[QualityFinding]:
    if share > HIGHEST_SIGNAL:
        yield finding(
            name, share, HIGHEST_SIGNAL, "of rated", passed=False,
            message=f"the samples reach {plain(share)} times the rated value: wrong ratio or unit",
        )  # fmt: skip


def _swing(samples: Array) -> float:
    """Half of the greatest channel's range; halved first, for numbers near the largest there are."""
    half = samples / 2.0
    return float(np.ptp(half, axis=1).max())
