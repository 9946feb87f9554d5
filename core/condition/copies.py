"""Whether two records are of one event, which a relay gave in two formats: it counts once.

A recorder makes one record at a time. So records of one motor and one trigger time whose currents and
voltages are as large differ in nothing but how finely their format has the values. Names of station and
channels, and ratios of transformers, do not count: formats write them in different ways, or not at all.
"""

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from core.machines.parameters import Motor
from core.recordings import Recording
from core.recordings.errors import RecordingError
from core.recordings.fidelity import Fidelity
from core.signals.terminals import terminals
from core.units import NANOSECONDS_PER_MILLISECOND

SAME_TIME_NS = NANOSECONDS_PER_MILLISECOND
"""Formats have the trigger time to a millisecond at least."""
SAME = 1e-3
"""Largest difference of the rms values of two formats, over the largest of their kind."""


@dataclass(frozen=True, slots=True)
class Outline:
    """What all formats of one record have in common, and how finely this one has it.

    Parameters
    ----------
    time_ns : int
        Trigger time, UTC [ns].
    fidelity : Fidelity
        How finely the file has the values.
    currents_A, voltages_V : tuple of float
        Rms of each terminal over the whole record; no voltages where none are used.
    """

    time_ns: int
    fidelity: Fidelity
    currents_A: tuple[float, ...]
    voltages_V: tuple[float, ...]


def outline_of(recording: Recording, motor: Motor, fidelity: Fidelity) -> Outline | None:
    """Return the outline of a record.

    Parameters
    ----------
    recording : Recording
        The recording.
    motor : Motor
        The motor, for the names of its channels and its transformers.
    fidelity : Fidelity
        How finely the file has the values.

    Returns
    -------
    Outline or None
        The outline; None of a record without a time, or without the motor's currents.
    """
    if recording.start_time_ns is None:
        return None
    try:
        measured = terminals(
            recording,
            currents=motor.channels.currents,
            phase_voltages=motor.channels.phase_voltages,
            line_voltages=motor.channels.line_voltages,
            voltage_ratio=motor.transformers.voltage_ratio,
            current_ratio=motor.transformers.current_ratio,
            inside_delta=motor.transformers.inside_delta,
        )
    except RecordingError:
        return None
    currents, voltages = _rms(measured.current_abc), _rms(measured.voltages)
    if not all(map(isfinite, (*currents, *voltages))):
        return None
    return Outline(recording.trigger_time_ns, fidelity, currents, voltages)


def is_copy(one: Outline, other: Outline) -> bool:
    """Tell whether two records of a motor are of one event.

    Parameters
    ----------
    one, other : Outline
        The outlines.

    Returns
    -------
    bool
        Whether they agree in time and waveform, to the quantisation of their formats.
    """
    return (
        abs(one.time_ns - other.time_ns) < SAME_TIME_NS
        and _agree(one.currents_A, other.currents_A)
        and _agree(one.voltages_V, other.voltages_V)
    )


def _agree(ours: tuple[float, ...], theirs: tuple[float, ...]) -> bool:
    largest = max((*ours, *theirs), default=0.0)
    return len(ours) == len(theirs) and all(
        abs(a - b) <= SAME * largest for a, b in zip(ours, theirs, strict=True)
    )


def _rms(samples: NDArray[np.float64]) -> tuple[float, ...]:
    """Return the rms of each row, of the samples that are there; 0 of a row without any."""
    known = np.isfinite(samples)
    with np.errstate(over="ignore"):
        squares = np.square(samples, where=known, out=np.zeros_like(samples)).sum(axis=1)
    return tuple(float(one) for one in np.sqrt(squares / np.maximum(known.sum(axis=1), 1)))
