"""Checks on the samples of single channels: presence, number, and changes by converter and recorder."""

from collections.abc import Iterator
from math import pi

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.parameters import Nameplate
from core.quality.finding import QualityFinding, finding
from core.quantity_text import plain, with_unit
from core.recordings import Channel
from core.signals.terminals import Terminals

FEWEST_CYCLES = 4.9
"""Least length: delay margin, settling, and the fewest cycles from which a scatter can be estimated."""
FEWEST_SAMPLES_A_CYCLE, MOST_SAMPLES_A_CYCLE = 10.0, 2_000.0
"""Range of sampling rates: 600 Hz at 60 Hz is that of the slowest relays.

Higher rates than the upper limit cost time and add no information about a winding.
"""
AT_FULL_SCALE, CLIPPED_SHARE = 0.999, 0.001
FLAT_SHARE = 0.02
"""Share of samples in runs of three and more that equal a channel's extreme: a crest cut off at 0.998 of its
height. What the converter's own step makes flat at a crest comes on top."""
HELD_CYCLES = 0.15
"""Longest stretch of one value away from the extremes that a converter's step can explain."""
REPEATED_SHARE = 0.02
"""Share of samples on the flanks that equal the one before, beyond what chance does. A recorder that writes
every sample twice has a half."""
FEWEST_REPEATS = 3
"""Number of equal neighbours that a short record may have by chance."""
FLAT, FLANK = 0.05, 0.7
"""Shares of the greatest magnitude: between them a sine always moves, and a saturated transformer does not
rest."""
DIPS_A_CYCLE = 0.8
"""Stretches at zero as frequent as this are a saturated transformer's, not a converter's."""
COARSEST_LAG_CYCLES = 1 / 12
"""A waveform of so few converter steps that it stands still longer cannot be judged by its repeats."""
FEWEST_STEPS = 8.0
"""Steps of the converter in the greatest value from which on jumps tell held samples: a drive's pulses have
fewer levels, between which they jump, too."""
FEWEST_CHANGES, SHORTEST_PERIOD, REGULAR = 8, 4, 0.95
"""How often channels must change together, after how many samples at least, and in which share of cases after
as many, give or take one, to be told as sampled more slowly: steps of a converter come at any time."""
DEAD = 0.03
"""Share of the greatest channel's swing: less is no signal, and for the check on missing phases to name."""
RUN = 3
"""Least number of equal samples in a run. Two occur by chance, one on either side of a crest."""


def extent(terminals: Terminals, nameplate: Nameplate) -> Iterator[QualityFinding]:
    """Check length and rate of the record, and whether all of it is there.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    nameplate : Nameplate
        Rated values of the motor.

    Yields
    ------
    QualityFinding
        A finding.
    """
    per_cycle = terminals.sample_rate_hz / nameplate.rated_frequency_Hz
    cycles = terminals.current_abc.shape[1] / per_cycle
    yield finding(
        "duration", cycles, FEWEST_CYCLES, "cycles", passed=cycles >= FEWEST_CYCLES,
        message=f"{cycles:.1f} cycles of the rated frequency are too few: record at least {FEWEST_CYCLES:g}",
    )  # fmt: skip
    slow = per_cycle < FEWEST_SAMPLES_A_CYCLE
    yield finding(
        "sample rate", per_cycle, FEWEST_SAMPLES_A_CYCLE if slow else MOST_SAMPLES_A_CYCLE, "samples a cycle",
        passed=FEWEST_SAMPLES_A_CYCLE <= per_cycle <= MOST_SAMPLES_A_CYCLE,
        message=f"{plain(per_cycle, 4)} samples a cycle are too {'few' if slow else 'many'}: expected "
        f"{FEWEST_SAMPLES_A_CYCLE:g} to {MOST_SAMPLES_A_CYCLE:g}",
    )  # fmt: skip
    both = (terminals.current_abc, terminals.voltages)
    missing = sum(x.size - int(np.count_nonzero(np.isfinite(x))) for x in both)
    yield finding(
        "missing samples", missing, 0, "samples", passed=missing == 0,
        message=f"{missing} samples are missing or not numbers: record again, or check the recorder",
    )  # fmt: skip


def clipping(channels: tuple[Channel, ...], samples: Array) -> Iterator[QualityFinding]:
    """Check for crests cut off by a converter or an amplifier, at the full scale or at any other level.

    Parameters
    ----------
    channels : tuple of Channel
        The channels.
    samples : ndarray, shape (channels, n)
        Their samples.

    Yields
    ------
    QualityFinding
        A finding.
    """
    for channel, x in _alive(channels, samples):
        share, limit, where = _flat_share(x), FLAT_SHARE + _crest_share(x), "its own extreme"
        if channel.full_scale is not None:
            at_full = float(np.mean(np.abs(x) >= AT_FULL_SCALE * channel.full_scale))
            if at_full > CLIPPED_SHARE or share <= limit:
                share, limit = at_full, CLIPPED_SHARE
                where = f"its full scale of {with_unit(channel.full_scale, channel.unit, 6)}"
        yield finding(
            f"clipping {channel.name}", share, limit, "share", passed=share <= limit,
            message=f"{channel.name} sits at {where} for {share:.1%} of the record: its crests are cut off; "
            "choose a larger range",
        )  # fmt: skip


def holding(channels: tuple[Channel, ...], samples: Array, per_cycle: float) -> Iterator[QualityFinding]:
    """Check for values that stand still where a waveform moves.

    They stand still for one stretch, or every sample several times.

    Parameters
    ----------
    channels : tuple of Channel
        The channels.
    samples : ndarray, shape (channels, n)
        Their samples.
    per_cycle : float
        Samples in one cycle.

    Yields
    ------
    QualityFinding
        A finding.
    """
    for channel, x in _alive(channels, samples):
        stretch, repeated = _longest_stretch(x, per_cycle) / per_cycle, _repeated_share(x, per_cycle)
        stuck = stretch > HELD_CYCLES
        yield finding(
            f"held samples {channel.name}",
            stretch if stuck else repeated, HELD_CYCLES if stuck else REPEATED_SHARE,
            "cycles" if stuck else "share", passed=not stuck and repeated <= REPEATED_SHARE,
            message=f"{channel.name} stands still for {stretch:.2f} cycles: samples were lost or the "
            "converter froze" if stuck else f"{repeated:.0%} of {channel.name} repeat the sample before: "
            "it was sampled more slowly than the file says",
        )  # fmt: skip


def sampled_slowly(channels: tuple[Channel, ...], samples: Array) -> Iterator[QualityFinding]:
    """Check for samples that are repeated until the next one was taken; only failures are told.

    Either the channels change together every so many samples and rest between. Or one jumps by several steps
    of the converter and rests between: what is small, coarse or noisy rests, too, but moves by single steps.
    Neither depends on ratios or on what the motor does, so that it may be asked before these are known.

    Parameters
    ----------
    channels : tuple of Channel
        The channels.
    samples : ndarray, shape (channels, n)
        Their samples, finite and far from the largest number.

    Yields
    ------
    QualityFinding
        A failure.
    """
    if (period := _common_period(samples)) > 0:
        names = ", ".join(channel.name for channel in channels)
        yield _slow(channels[0].name, 1.0 - 1.0 / period, f"{names} change together every {period} samples")
        return
    for channel, x in _alive(channels, samples):
        share = _jumping_share(x)
        if share > REPEATED_SHARE:
            yield _slow(channel.name, share, f"{share:.1%} of {channel.name} repeat the sample before")


def _slow(name: str, share: float, what: str) -> QualityFinding:
    return finding(
        f"held samples {name}", share, REPEATED_SHARE, "share", passed=False,
        message=f"{what}: sampled more slowly than the file says",
    )  # fmt: skip


def _alive(channels: tuple[Channel, ...], samples: Array) -> Iterator[tuple[Channel, Array]]:
    swing = np.ptp(samples, axis=1) if samples.size else np.zeros(len(channels))
    for channel, x, its in zip(channels, samples, swing.tolist(), strict=True):
        if its > DEAD * float(swing.max()):
            yield channel, x


def _flat_share(x: Array) -> float:
    return max(float(np.mean(_in_runs(x == extreme))) for extreme in (x.max(), x.min()))


def _in_runs(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which of the flags stand in runs of three and more."""
    middle = np.zeros_like(flags)
    middle[1:-1] = flags[:-2] & flags[1:-1] & flags[2:]
    runs = middle.copy()
    runs[:-1] |= middle[1:]
    runs[1:] |= middle[:-1]
    return runs


def _crest_share(x: Array) -> float:
    """Share of a sine's samples that lie within one step of the converter below its crest."""
    return float(np.sqrt(4.0 * _step(x) / np.ptp(x))) / pi


def _step(x: Array) -> float:
    """Smallest change there is: the converter's step, or nearly nothing for computed samples."""
    changes = np.abs(np.diff(x))
    return float(changes.min(initial=np.inf, where=changes > 0.0))


def _longest_stretch(x: Array, per_cycle: float) -> int:
    """Sample periods of the longest run of one value that is not an extreme, nor zero in every cycle."""
    ends = np.flatnonzero(np.diff(x) != 0.0)
    first = np.concatenate([[0], ends + 1])
    lengths = np.diff(np.concatenate([first, [x.size]]))
    counted = (x[first] != x.max()) & (x[first] != x.min())
    dips = (np.abs(x[first]) < FLAT * np.ptp(x) / 2.0) & (lengths >= RUN)
    if np.count_nonzero(dips) > DIPS_A_CYCLE * x.size / per_cycle:
        counted &= ~dips
    return int((lengths - 1).max(initial=0, where=counted))


def _common_period(samples: Array) -> int:
    """Return the number of samples after which all channels change together; 0 where they do not."""
    changes = np.flatnonzero((np.diff(samples, axis=1) != 0.0).any(axis=0))
    if changes.size < FEWEST_CHANGES:
        return 0
    gaps = np.diff(changes)
    period = int(np.median(gaps))
    regular = np.count_nonzero(np.abs(gaps - period) <= 1)
    return period if period >= SHORTEST_PERIOD and regular >= REGULAR * gaps.size else 0


def _jumping_share(x: Array) -> float:
    """Share of the flanks' samples equal to the one before, where the others are jumps of several steps."""
    step, centred = _step(x), np.abs(x - x.mean())
    greatest = float(centred.max())
    if not FEWEST_STEPS * step <= greatest:
        return 0.0
    flank = (np.abs(x) > FLAT * greatest) & (centred < FLANK * greatest)
    change = np.abs(np.diff(x))[flank[1:] & flank[:-1]]
    equal, next_to = np.count_nonzero(change == 0.0), np.count_nonzero((change > 0.0) & (change < 1.5 * step))
    jumps = change.size - equal - next_to
    if jumps <= next_to or equal - next_to <= FEWEST_REPEATS:
        return 0.0
    return float((equal - next_to) / change.size)


def _repeated_share(x: Array, per_cycle: float) -> float:
    """Share of the flanks' samples equal to the one before, less the chance of it.

    Chance is what differs by just one step of the converter. A waveform so small that it moves by less than
    three steps a sample is compared with an earlier sample.
    """
    step, centred = _step(x), np.abs(x - x.mean())
    greatest = float(centred.max())
    lag = max(1, int(np.ceil(3.0 * step * per_cycle / (FLANK * greatest * 2.0 * pi))))
    flank = (np.abs(x) > FLAT * greatest) & (centred < FLANK * greatest)
    if lag > max(1.0, COARSEST_LAG_CYCLES * per_cycle):
        return 0.0
    both = flank[lag:] & flank[:-lag]
    if not both.any():
        return 0.0
    change = np.abs(x[lag:] - x[:-lag])[both]
    equal, next_to = (change == 0.0), (change > 0.0) & (change < 1.5 * step)
    surplus = np.count_nonzero(equal) - np.count_nonzero(next_to) - FEWEST_REPEATS
    return max(0.0, float(surplus / change.size))
