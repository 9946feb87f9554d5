"""A record as the search for its speed sees it: spectra of its pieces, taken once."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from core.machines.base import Array
from core.speed.bars import evidence_of_bars
from core.speed.residue import Residue, residue_of

PIECE_S: Final = 0.5
"""Least length of the pieces whose speeds are averaged: a longer comb fails where the load changes."""
BARS_PIECE_S, BARS_PIECES = 1.0, 2
"""Usual length of the pieces that weigh the number of bars, and how many at most."""
SHORTEST_S: Final = 0.4
LONGEST_S: Final = 4.0
"""Of a longer record only the end is looked at."""
LEAST_RATE_HZ: Final = 3_000.0
"""At a lower rate hardly any slot line is left."""


@dataclass(frozen=True, slots=True)
class SpeedRecord:
    """Currents of steady running, and the spectra of their pieces.

    Parameters
    ----------
    current : ndarray, shape (2, n) or (1, n)
        Line currents on Clarke axes, or one of them [A].
    sample_rate_hz : float
        Sampling rate [Hz].
    frequency_hz : float
        Frequency of the supply [Hz].
    pole_pairs : int
        Pole pairs of the motor.
    pieces : tuple of Residue
        Spectra of equal pieces of at least `PIECE_S`, or of the whole where it is shorter.
    """

    current: Array
    sample_rate_hz: float
    frequency_hz: float
    pole_pairs: int
    pieces: tuple[Residue, ...]

    def evidence(self) -> Array:
        """Weigh all numbers of bars by the end of the record.

        Returns
        -------
        ndarray, shape (bars,)
            Log likelihood ratio of each number of bars [nats].
        """
        samples = self.current.shape[1]
        longest = round(BARS_PIECE_S * BARS_PIECES * self.sample_rate_hz)
        end = self.current[:, max(0, samples - longest) :]
        count = min(BARS_PIECES, max(1, int(end.shape[1] / self.sample_rate_hz / BARS_PIECE_S + 1e-6)))
        spectra = _spectra(end, self.sample_rate_hz, self.frequency_hz, count)
        return np.asarray(sum(evidence_of_bars(one, self.pole_pairs) for one in spectra))


def why_unsuited(samples: int, sample_rate_hz: float) -> str | None:
    """Say why a record cannot show the speed.

    Parameters
    ----------
    samples : int
        Samples of steady running.
    sample_rate_hz : float
        Sampling rate [Hz].

    Returns
    -------
    str or None
        The reason; None where it may.
    """
    duration_s = samples / sample_rate_hz
    if duration_s < SHORTEST_S:
        return f"the recording has {duration_s:.2f} s of steady running: {SHORTEST_S:g} s are needed"
    if sample_rate_hz < LEAST_RATE_HZ:
        return (
            f"the recording has {sample_rate_hz:.0f} samples/s, too few for lines of rotor slots: "
            f"{LEAST_RATE_HZ:.0f} are needed, 4000 are better"
        )
    return None


def speed_record(current: Array, sample_rate_hz: float, frequency_hz: float, pole_pairs: int) -> SpeedRecord:
    """Take the spectra of a record.

    Parameters
    ----------
    current : ndarray, shape (2, n) or (1, n)
        Line currents on Clarke axes, or one of them: finite samples of steady running, for which
        `why_unsuited` has no reason [A].
    sample_rate_hz : float
        Sampling rate [Hz].
    frequency_hz : float
        Frequency of the supply [Hz].
    pole_pairs : int
        Pole pairs of the motor.

    Returns
    -------
    SpeedRecord
        The record, of which not more than the last `LONGEST_S` are looked at.
    """
    end = current[:, max(0, current.shape[1] - round(LONGEST_S * sample_rate_hz)) :]
    count = max(1, int(end.shape[1] / sample_rate_hz / PIECE_S + 1e-6))
    spectra = _spectra(end, sample_rate_hz, frequency_hz, count)
    return SpeedRecord(end, sample_rate_hz, frequency_hz, pole_pairs, spectra)


def _spectra(current: Array, sample_rate_hz: float, frequency_hz: float, count: int) -> tuple[Residue, ...]:
    length = current.shape[1] // count
    first = current.shape[1] - count * length
    return tuple(
        residue_of(current[:, start : start + length], sample_rate_hz, frequency_hz)
        for start in range(first, first + count * length, length)
    )
