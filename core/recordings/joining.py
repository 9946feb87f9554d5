"""Consecutive records of one recorder put together to a longer one.

Each record begins before the one before it ends: the recorder is triggered again while its pre-trigger time
still reaches back into that record. Time stamps tell roughly where a record belongs. Where exactly, to a
fraction of a sample, is told by the waveforms that both records have: the shift that makes them differ least,
in all channels together.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import PurePath
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.recordings.errors import RecordingError
from core.recordings.skew import without_skew
from core.recordings.waveform import Digitals, Quantity, Recording
from core.units import NANOSECONDS_PER_SECOND

Array = NDArray[np.float64]

USUAL_FREQUENCY_HZ: Final = 50.0
LEAST_OVERLAP_CYCLES: Final = 1.0
"""So much of the waveforms must two records share."""
MOST_STAMP_ERROR_CYCLES: Final = 0.2
"""Two time stamps may be wrong by so much. A shift is sought no further: after a cycle all looks alike."""
MOST_DIFFERENCE: Final = 0.05
"""Rms difference of two waveforms that are the same, over the largest rms of their quantity."""
SAME_RATE: Final = 1e-6
NO_SHIFT: Final = 0.01
"""A fraction of a sample that is left as it is."""


class JoinError(RecordingError):
    """The error of two records that do not belong together, or do not overlap."""


@dataclass(frozen=True, slots=True)
class Seam:
    """Where two records meet.

    Parameters
    ----------
    offset : float
        First sample of the later record, in samples of the earlier one.
    overlap_s : float
        Time that both have [s].
    stamp_error_s : float
        What the later record's time stamp is ahead of its place by the waveforms [s].
    difference : float
        Rms difference where both have samples, of the channel where it is largest, over the largest rms of
        the channels of its quantity.
    """

    offset: float
    overlap_s: float
    stamp_error_s: float
    difference: float


@dataclass(frozen=True, slots=True)
class Joined:
    """A record made of several.

    Parameters
    ----------
    recording : Recording
        All of them as one: time, trigger and names are those of the first.
    parts : tuple of int
        Which of the given records it is made of.
    seams : tuple of Seam
        Where they meet, one less than parts.
    refusals : tuple of str
        Why it holds no more of them; empty where it holds all.
    """

    recording: Recording
    parts: tuple[int, ...]
    seams: tuple[Seam, ...]
    refusals: tuple[str, ...] = ()


def join(recordings: Sequence[Recording]) -> Joined:
    """Put consecutive records together.

    Parameters
    ----------
    recordings : sequence of Recording
        Records of one recorder in their order, each begun before the one before it ends.

    Returns
    -------
    Joined
        All of them as one record.

    Raises
    ------
    JoinError
        If two neighbours do not overlap, have different channels, or differ where they overlap: a clock that
        was set meanwhile shows in this way, too.
    ValueError
        If there are none.
    """
    if not recordings:
        raise ValueError("no records to join")
    seams = tuple(seam(earlier, later) for earlier, later in pairwise(recordings))
    return Joined(_put_together(recordings, seams), tuple(range(len(recordings))), seams)


def join_longest(recordings: Sequence[Recording]) -> Joined:
    """Put the longest run of records together that belong together.

    Parameters
    ----------
    recordings : sequence of Recording
        Records of one recorder in their order.

    Returns
    -------
    Joined
        The run that spans the longest time; one record alone where no two belong together.

    Raises
    ------
    ValueError
        If there are none.
    """
    if not recordings:
        raise ValueError("no records to join")
    runs: list[list[int]] = [[0]]
    seams: list[list[Seam]] = [[]]
    refusals = []
    for number, (earlier, later) in enumerate(pairwise(recordings), 1):
        try:
            meeting = seam(earlier, later)
        except RecordingError as error:
            refusals.append(str(error))
            runs.append([number])
            seams.append([])
        else:
            runs[-1].append(number)
            seams[-1].append(meeting)
    joined = [
        Joined(_put_together([recordings[k] for k in run], met), tuple(run), tuple(met), tuple(refusals))
        for run, met in zip(runs, seams, strict=True)
    ]
    return max(joined, key=lambda one: one.recording.duration_s)


def seam(earlier: Recording, later: Recording) -> Seam:
    """Find where a record goes on with another.

    Parameters
    ----------
    earlier, later : Recording
        The two records.

    Returns
    -------
    Seam
        Where they meet.

    Raises
    ------
    JoinError
        If they do not belong together.
    """
    _require_alike(earlier, later)
    rate_hz = earlier.sample_rate_hz
    cycle = rate_hz / (earlier.nominal_frequency_hz or USUAL_FREQUENCY_HZ)
    stamped = (later.first_time_ns - earlier.first_time_ns) / NANOSECONDS_PER_SECOND * rate_hz
    shared = earlier.samples.shape[1] - stamped
    if stamped <= 0 or shared < LEAST_OVERLAP_CYCLES * cycle:
        raise JoinError(
            later.source,
            "time of its first sample",
            expected=f"after that of {_name(earlier)} and a cycle or more before its end",
            found=f"{stamped / rate_hz:.3f} s after it, and {shared / rate_hz:.3f} s before its end",
        )
    reach = int(MOST_STAMP_ERROR_CYCLES * cycle)
    middle = round(stamped)
    shifts = range(max(1, middle - reach), middle + reach + 1)
    scales = _scales(earlier)
    sums = [float(np.mean(_differences(earlier, later, shift, scales) ** 2)) for shift in shifts]
    best = shifts[int(np.argmin(sums))]
    offset = best + _fraction(earlier, later, best, scales)
    difference = float(
        _differences(earlier, _resampled(later, offset - round(offset)), round(offset), scales).max()
    )
    if not difference <= MOST_DIFFERENCE:
        raise JoinError(
            later.source,
            "waveforms",
            expected=f"those of {_name(earlier)} at the same time",
            found=f"others, by {100 * difference:.0f} %: the clock was set, or they are of another motor",
        )
    return Seam(
        offset=offset,
        overlap_s=(earlier.samples.shape[1] - offset) / rate_hz,
        stamp_error_s=(stamped - offset) / rate_hz,
        difference=difference,
    )


def _name(recording: Recording) -> str:
    """Return the file's name alone: where it lies tells a reader nothing, and may be a store's own matter."""
    return PurePath(recording.source).name


def _require_alike(earlier: Recording, later: Recording) -> None:
    names = [[(one.name, one.unit) for one in record.channels] for record in (earlier, later)]
    if names[0] != names[1]:
        raise JoinError(
            later.source,
            "channels",
            expected=f"those of {_name(earlier)}",
            found="others, or others in order",
        )
    if abs(later.sample_rate_hz / earlier.sample_rate_hz - 1) > SAME_RATE:
        raise JoinError(
            later.source,
            "sampling rate",
            expected=f"{earlier.sample_rate_hz:g} Hz, that of {_name(earlier)}",
            found=f"{later.sample_rate_hz:g} Hz",
        )
    for record in (earlier, later):
        if record.instants_s is not None:
            raise JoinError(
                record.source, "samples", expected="one sampling rate throughout", found="several, or a gap"
            )


def _scales(recording: Recording) -> Array:
    """Return for each channel the largest rms of its quantity; infinite where this is zero or not known."""
    rms = np.sqrt(np.mean(np.nan_to_num(recording.samples) ** 2, axis=1))
    measured = [one.quantity for one in recording.channels]
    scales = np.full(rms.size, np.inf)
    for quantity in set(measured) - {Quantity.OTHER}:
        rows = [k for k, one in enumerate(measured) if one is quantity]
        largest = float(rms[rows].max())
        if largest > 0:
            scales[rows] = largest
    return scales


def _differences(earlier: Recording, later: Recording, offset: int, scales: Array) -> Array:
    """Return the rms difference of each channel over its scale; a missing sample counts for nothing."""
    count = min(earlier.samples.shape[1] - offset, later.samples.shape[1])
    apart = np.nan_to_num(earlier.samples[:, offset : offset + count] - later.samples[:, :count])
    differences: Array = np.sqrt(np.mean(apart**2, axis=1)) / scales
    return differences


def _fraction(earlier: Recording, later: Recording, offset: int, scales: Array) -> float:
    """Return by what fraction of a sample the later record comes after sample `offset` of the earlier one."""
    count = min(earlier.samples.shape[1] - offset, later.samples.shape[1])
    inner = slice(1, count - 1)
    here = later.samples[:, :count]
    slope = np.gradient(here, axis=1)[:, inner] / scales[:, None]
    apart = (here - earlier.samples[:, offset : offset + count])[:, inner] / scales[:, None]
    steepness = float(np.nansum(slope**2))
    return float(np.clip(np.nansum(slope * apart) / steepness, -0.5, 0.5)) if steepness > 0 else 0.0


def _resampled(recording: Recording, delay: float) -> Recording:
    """Return a record that was sampled `delay` of a sample late at the instants of the one before it."""
    if abs(delay) < NO_SHIFT:
        return recording
    return replace(recording, samples=np.vstack([without_skew(row, delay) for row in recording.samples]))


def _put_together(recordings: Sequence[Recording], seams: Sequence[Seam]) -> Recording:
    """Return the records as one. In the middle of each overlap the later record takes over."""
    first = recordings[0]
    starts = np.concatenate([[0.0], np.cumsum([one.offset for one in seams])])
    places = np.rint(starts).astype(int)
    ends = [place + one.samples.shape[1] for place, one in zip(places, recordings, strict=True)]
    cuts = [0, *((end + place) // 2 for end, place in zip(ends, places[1:], strict=False)), ends[-1]]
    samples, states = [], []
    for one, start, place, (begin, end) in zip(recordings, starts, places, pairwise(cuts), strict=True):
        rows = slice(begin - place, end - place)
        samples.append(_resampled(one, float(start - place)).samples[:, rows])
        states.append(None if one.digitals is None else one.digitals.packed[rows])
    return replace(
        first,
        samples=np.hstack(samples),
        digitals=_joined_digitals(recordings, states),
        source=first.source if len(recordings) == 1 else f"{first.source} to {recordings[-1].source}",
    )


def _joined_digitals(
    recordings: Sequence[Recording], packed: Sequence[NDArray[np.uint8] | None]
) -> Digitals | None:
    """Return the states beside the samples; None where the records do not have the same ones."""
    known = [one for one in packed if one is not None]
    names = {None if one.digitals is None else one.digitals.names for one in recordings}
    name = names.pop()
    if names or name is None:
        return None
    return Digitals(name, np.vstack(known))
