"""The time base of a COMTRADE record: its rates, checked against the time stamps of its samples.

Only differences of time stamps count: recorders start them anywhere. Where rates are given, stamps are not
critical (C37.111-1999, 6.4): some or all may be missing, and a recorder that leaves them all 0 has none. But
a step forward in them is a gap in the samples, and is kept; steps back, or another rate, contradict the file.
Beside a gap, a step back tells that the recorder began again: what is behind it is set apart, by one period
more, so that nothing is interpolated across it.
"""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.comtrade.configuration import MICROSECOND_S, NANOSECOND_S, Configuration
from core.recordings.errors import RecordingError
from core.recordings.repairs import Repairs
from core.units import NANOSECONDS_PER_SECOND

RATE_TOLERANCE = 1e-3
"""Largest difference between the rate in the configuration and the one the time stamps show, fraction."""

COUNTERS = (1 << 16, 1 << 32)
"""Recorders keep time stamps in so many steps, and start again from 0: of 2^32 ns after 4.295 s."""
LONGEST_STEP = 1.5
"""Without a rate, the step over a counter's end may be so much longer than the longest of the others."""

MAX_STAMP = 1e13
"""The longest that 13 characters hold, all that 2013 allows."""

_BLOCK_SAMPLES = 1 << 14


@dataclass(frozen=True, slots=True)
class TimeBase:
    """Times of the samples.

    Parameters
    ----------
    rate_hz : float
        The first or the typical rate [Hz].
    instants_s : ndarray or None, shape (samples,)
        Time of every sample after the first [s], None if they are evenly spaced.
    """

    rate_hz: float
    instants_s: NDArray[np.float64] | None


def time_base(
    path: Path, stamps: NDArray[np.float64], configuration: Configuration, repairs: Repairs
) -> TimeBase:
    """Find the times of the samples from their stamps and the configuration's rates.

    A lenient reader goes by the rates where the stamps contradict them.

    Parameters
    ----------
    path : pathlib.Path
        File of the stamps, for messages.
    stamps : ndarray, shape (samples,)
        Time stamps in the file's unit.
    configuration : Configuration
        The checked configuration file.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    TimeBase
        The times.

    Raises
    ------
    RecordingError
        If stamps and rates contradict each other, or neither tells the time.
    """
    absurd = (stamps > MAX_STAMP) | (stamps < -MAX_STAMP)
    if absurd.any():
        k = int(np.argmax(absurd))
        raise RecordingError(
            path,
            f"sample {k + 1}, time stamp",
            expected=f"a number up to {MAX_STAMP:.0e}",
            found=f"{stamps[k]:g}",
        )
    if not configuration.rates:
        stamps = _counted_on(path, stamps, repairs)
        return _of_stamps(path, stamps * configuration.time_stamp_unit_s, configuration.time_stamp_unit_s)
    nominal = _Nominal.of(configuration.rates)
    try:
        instants, span = _shown(path, stamps, nominal, configuration.time_stamp_unit_s)
        _tell_turns(path, stamps, span, repairs)
    except RecordingError as fault:
        instants = _otherwise(path, stamps, nominal, configuration, fault, repairs)
    if instants is None and len(configuration.rates) > 1:
        instants = nominal.times(np.arange(stamps.size))
    return TimeBase(configuration.rates[0][0], instants)


def trigger_index(
    path: Path, configuration: Configuration, base: TimeBase, samples: int, repairs: Repairs
) -> int | None:
    """Find the sample next to the trigger.

    Parameters
    ----------
    path : pathlib.Path
        Configuration file, for messages.
    configuration : Configuration
        The checked configuration file.
    base : TimeBase
        Times of the samples.
    samples : int
        Number of samples.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    int or None
        The sample; None where a lenient reader left it out, or found no time.

    Raises
    ------
    RecordingError
        If the trigger is outside the record.
    """
    if configuration.trigger_time_ns is None or configuration.start_time_ns is None:
        return None
    elapsed_s = (configuration.trigger_time_ns - configuration.start_time_ns) / NANOSECONDS_PER_SECOND
    if base.instants_s is None:
        index, duration_s = round(elapsed_s * base.rate_hz), samples / base.rate_hz
        within = 0 <= index < samples
    else:
        index, duration_s = int(np.argmin(np.abs(base.instants_s - elapsed_s))), float(base.instants_s[-1])
        within = 0 <= elapsed_s <= duration_s + 0.5 / base.rate_hz
    if within:
        return index
    fault = RecordingError(
        path,
        "time of the trigger",
        expected=f"within the record, 0 to {duration_s:.6g} s after its first sample",
        found=f"{elapsed_s:.6f} s after it",
    )
    repairs.mend(fault, "the trigger is left out")
    return None


@dataclass(frozen=True, slots=True)
class _Nominal:
    """Times by the rates alone: of each rate its first sample (from 0), its time, the period [s]."""

    firsts: NDArray[np.intp]
    starts: NDArray[np.float64]
    periods: NDArray[np.float64]

    @classmethod
    def of(cls, rates: tuple[tuple[float, int], ...]) -> "_Nominal":
        periods = np.array([1 / rate_hz for rate_hz, _ in rates])
        firsts = np.array([0, *(last for _, last in rates[:-1])], dtype=np.intp)
        # The step to the first sample of a rate is one of its periods.
        starts = np.concatenate([[0.0], np.cumsum((np.diff(firsts) - 1) * periods[:-1] + periods[1:])])
        return cls(firsts, starts, periods)

    def times(self, samples: NDArray[np.intp]) -> NDArray[np.float64]:
        k = np.searchsorted(self.firsts, samples, side="right") - 1
        return self.starts[k] + (samples - self.firsts[k]) * self.periods[k]

    def period(self, samples: NDArray[np.intp]) -> NDArray[np.float64]:
        return self.periods[np.searchsorted(self.firsts, samples, side="right") - 1]


def _shown(
    path: Path, stamps: NDArray[np.float64], nominal: _Nominal, unit_s: float
) -> tuple[NDArray[np.float64] | None, int | None]:
    """Return the times with the gaps that stamps show, None without any, and the span of their counter."""
    span = _counter_span(stamps, 2.0 * nominal.periods.max() / unit_s)
    return _with_gaps(path, stamps, nominal, unit_s, span), span


def _otherwise(
    path: Path,
    stamps: NDArray[np.float64],
    nominal: _Nominal,
    configuration: Configuration,
    fault: RecordingError,
    repairs: Repairs,
) -> NDArray[np.float64] | None:
    """Return the times of stamps that contradict the rates: as microseconds, or begun again beside gaps.

    Editions before 2013 know only microseconds: some recorders write more decimals of a second in their dates
    all the same. Where microseconds are just what the rates give, that is the only way to read the stamps.
    """
    if configuration.revision < 2013 and configuration.time_base_s == NANOSECOND_S:
        with suppress(RecordingError):
            instants, span = _shown(path, stamps, nominal, configuration.time_multiplier * MICROSECOND_S)
            repairs.warn(f"{fault}: the time stamps are microseconds, not nanoseconds as the dates are")
            _tell_turns(path, stamps, span, repairs)
            return instants
    instants = _begun_again(stamps, nominal, configuration.time_stamp_unit_s)
    if instants is None:
        repairs.mend(fault, "the time stamps are ignored")
    else:
        repairs.warn(f"{fault}: the gaps are kept; what is behind a step back is set apart")
    return instants


def _with_gaps(
    path: Path, stamps: NDArray[np.float64], nominal: _Nominal, unit_s: float, span: int | None
) -> NDArray[np.float64] | None:
    """Return the nominal times, later by each gap the stamps show; None where they show none.

    Piece by piece: stamps of a long record need not be held in memory several times over.
    span: steps after which the counter of the stamps starts again, None where it does not.
    """
    if not (np.isfinite(stamps) & (stamps != 0)).any():
        return None
    first = int(np.argmax(np.isfinite(stamps)))
    span_s = 0.0 if span is None else span * unit_s
    instants: NDArray[np.float64] | None = None
    last, late_s, jumps, steps = first, 0.0, 0, 0
    first_jump: RecordingError | None = None
    for begin in range(0, stamps.size, _BLOCK_SAMPLES):
        end = min(begin + _BLOCK_SAMPLES, stamps.size)
        present = np.flatnonzero(np.isfinite(stamps[begin:end])) + begin
        present = np.concatenate([[last], present[present > last]])
        elapsed = (stamps[present] - stamps[first]) * unit_s
        expected = nominal.times(present) - nominal.times(np.array([first]))
        deviation = elapsed - expected
        if span_s:
            deviation = (deviation + span_s / 2) % span_s - span_s / 2
        period = nominal.period(present)
        # Where the rate changes, recorders differ in which period the first step has: either is taken as is.
        longer, shorter = np.maximum(period[1:], period[:-1]), np.minimum(period[1:], period[:-1])
        change = longer != shorter
        most = np.where(change, longer, 0.5 * longer) + unit_s
        step = np.diff(deviation)
        jump = np.abs(step) > most
        jumps, steps = jumps + int(np.count_nonzero(jump)), steps + step.size
        moved = jump | (change & (np.abs(step) > 0.25 * shorter + unit_s))
        gap = np.where(moved, step, 0.0)
        late = late_s + np.cumsum(gap)
        wrong = (jump & (step < 0)) | (np.diff(expected) + gap <= 0)
        wrong |= np.abs(deviation[1:] - late) > most + RATE_TOLERANCE * expected[1:]
        if (wrong | jump).any():
            k = int(np.argmax(wrong if wrong.any() else jump)) + 1
            fault = _contradiction(path, int(present[k]), expected[k], elapsed[k], period[k])
            if wrong.any():
                raise fault
            first_jump = first_jump or fault
        if instants is None and moved.any():
            instants = nominal.times(np.arange(stamps.size))
        if instants is not None:
            at = np.searchsorted(present[1:], np.arange(begin, end), side="right")
            instants[begin:end] += np.concatenate([[late_s], late])[at]
        last, late_s = int(present[-1]), float(late[-1]) if late.size else late_s
    if first_jump and 2 * jumps >= steps:  # no gaps, but another rate
        raise first_jump
    return instants


def _begun_again(stamps: NDArray[np.float64], nominal: _Nominal, unit_s: float) -> NDArray[np.float64] | None:
    """Return times of a recorder that stepped back beside gaps; None where that is not what the stamps show.

    Stamps that come back to where they were before are wrong for a while, and tell nothing.
    """
    if not np.isfinite(stamps).all():
        return None
    samples = np.arange(stamps.size)
    expected = nominal.times(samples)
    deviation = (stamps - stamps[0]) * unit_s - expected
    step, period = np.diff(deviation), nominal.period(samples)[1:]
    most = 0.5 * period + unit_s
    jump = np.abs(step) > most
    back = jump & (step < 0)
    levels = np.sort(np.concatenate([[0.0], np.cumsum(step[jump])]))
    drift = np.abs(deviation[1:] - np.cumsum(np.where(jump, step, 0.0)))
    if (
        not back.any()
        or (back == jump).all()
        or 2 * np.count_nonzero(jump) >= step.size
        or (np.diff(levels) <= period.max()).any()
        or (drift > most + RATE_TOLERANCE * expected[1:]).any()
    ):
        return None
    later = np.cumsum(np.where(back, period, np.where(jump, step, 0.0)))
    instants: NDArray[np.float64] = expected + np.concatenate([[0.0], later])
    return instants


def _counter_span(stamps: NDArray[np.float64], least: float) -> int | None:
    """Return the steps of the counter that runs over; None where none does.

    Stamps then fall and are all below its end; of a counter with a sign, all above minus half of its steps.
    One of less than `least` steps tells nothing.
    """
    if not (stamps[1:] < stamps[:-1]).any():
        return None
    for span in COUNTERS:
        if span > least and not ((stamps >= span) | (stamps < -(span // 2))).any():
            return span
    return None


def _turns(stamps: NDArray[np.float64], span: int) -> NDArray[np.bool_]:
    """Whether the counter ran over before each sample but the first, of stamps that are there."""
    return np.diff(stamps) < -(span // 2)


def _tell_turns(path: Path, stamps: NDArray[np.float64], span: int | None, repairs: Repairs) -> None:
    if span is None:
        return
    count = int(np.count_nonzero(_turns(stamps[np.isfinite(stamps)], span)))
    if count:
        repairs.warn(
            f"{path.name}: the time stamps start again {count} time{'s' * (count > 1)}, after {span} steps: "
            "counted on"
        )


def _counted_on(path: Path, stamps: NDArray[np.float64], repairs: Repairs) -> NDArray[np.float64]:
    """Stamps that are the only time base, counted on where a counter of 32 bits runs over."""
    span = COUNTERS[-1]
    if np.isnan(stamps).any() or _counter_span(stamps, COUNTERS[0]) != span:
        return stamps
    turns = _turns(stamps, span)
    steps = np.diff(stamps) + span * turns
    if turns.all() or not (steps > 0).all() or steps[turns].max() > LONGEST_STEP * steps[~turns].max():
        return stamps
    _tell_turns(path, stamps, span, repairs)
    return np.concatenate([stamps[:1], stamps[0] + np.cumsum(steps)])


def _contradiction(
    path: Path, sample: int, expected_s: float, elapsed_s: float, period_s: float
) -> RecordingError:
    return RecordingError(
        path,
        f"sample {sample + 1}, time stamp",
        expected=f"{expected_s * 1e3:.6g} ms after the first, as {1 / period_s:.10g} Hz gives, "
        "or a gap after it",
        found=f"{elapsed_s * 1e3:.6g} ms",
    )


def _of_stamps(path: Path, stamps_s: NDArray[np.float64], unit_s: float) -> TimeBase:
    """Where the configuration names no rate: even if no stamp is off by more than a tenth of a sample."""
    missing = int(np.isnan(stamps_s).sum())
    steps = np.diff(stamps_s)
    if missing or steps.size == 0 or not (steps > 0).all():
        raise RecordingError(
            path,
            "time stamps",
            expected="increasing ones on every sample, as the configuration names no sampling rate",
            found=f"{missing} missing on {stamps_s.size} samples" if missing else "none that increase",
        )
    elapsed = stamps_s - stamps_s[0]
    rate_hz = float(steps.size / elapsed[-1])
    if (np.abs(elapsed - np.arange(stamps_s.size) / rate_hz) <= 0.1 / rate_hz + unit_s).all():
        return TimeBase(rate_hz, None)
    return TimeBase(float(1 / np.median(steps)), elapsed)
