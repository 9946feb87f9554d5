"""Checks on the voltages: frequency, waveform, and every single channel."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.machines.parameters import Nameplate
from core.quality.assumed_supply import assumed_voltage
from core.quality.finding import QualityFinding, finding
from core.quality.ratios import appended, voltage_advice
from core.quantity_text import plain
from core.recordings import Channel
from core.signals.decimation import decimate
from core.signals.errors import SignalError
from core.signals.phasors import fundamental_frequency, fundamental_phasors
from core.signals.sequence import PhaseSequence, SequencePhasors, sequence_phasors
from core.signals.terminals import Terminals

FREQUENCY_TOLERANCE = 0.06
LOWEST_VOLTAGE, HIGHEST_VOLTAGE = 0.7, 1.25
"""Positive-sequence voltage over rated: wider than any supply a motor runs on (IEC 60034-1: 10 %), narrower
than a line voltage taken for a phase voltage (0.58, 1.73)."""
BESIDE_HARMONICS = 0.06
"""Share of the voltages' energy beside the harmonics to the 25th: noise of 20 dB has 1 %, a drive's pulses
30 % and more, wherever sampling folds them to."""
HIGHEST_HARMONIC = 25
LINE_AMONG_PULSES = 0.3
"""Share of the energy in one line where no frequency can be fitted: pulses carry a line, noise has none."""
LINE_WIDTH_BINS = 2.5
"""Half width of a line in a Hann-windowed spectrum, with a margin for a drifting frequency."""
UNBALANCE = 0.15
"""Ratio V2 / V1 above which a channel is at fault and not the supply.

Motors trip at 5 %, and a lost or reversed channel causes 50 %.
"""
LOST_CHANNEL = 0.5
"""Least over greatest voltage, at such an unbalance: a blown fuse leaves what couples in from the others."""
RATIO_ZERO, RATIO_LIKENESS = 0.055, 0.5
"""V0 / V1 from which on, and how nearly, V0 must equal V2 as one channel's ratio makes it: 17 % of that
channel. Less may be true: a load on one phase lowers its voltage alone."""
TRIANGLE = 0.04
"""Sum of three line voltages over their mean: it is nothing, but for ratios within 1 % and 50 us."""
SMOOTHED_RATE_CYCLES = 24
"""Samples a cycle that a drive's pulses are averaged down to where they hide the fundamental."""

_TURN = np.exp(2j * np.pi / 3.0)


@dataclass(frozen=True, slots=True)
class Feed:
    """The voltages a record is judged against: as measured, or assumed from the currents.

    Parameters
    ----------
    voltage_ab : ndarray, shape (2, n)
        Voltages on power-invariant Clarke axes [V].
    frequency_hz : float
        Supply frequency [Hz].
    phasors : SequencePhasors
        Symmetrical components of the fundamental, phase to neutral, rms [V].
    channels : ndarray of complex, shape (channels,)
        Phasors of the voltage channels, rms [V]; none where the voltages are assumed.
    assumed : bool
        Whether the voltages are assumed.
    """

    voltage_ab: Array
    frequency_hz: float
    phasors: SequencePhasors
    channels: NDArray[np.complex128]
    assumed: bool

    @property
    def strong(self) -> float:
        """The greater of the two sequences, phase to neutral, rms [V]."""
        return max(abs(self.phasors.positive), abs(self.phasors.negative))


def feed_of(terminals: Terminals, nameplate: Nameplate) -> Feed | QualityFinding:
    """Find frequency and phasors of the voltages.

    Parameters
    ----------
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    Feed or QualityFinding
        The voltages, or the finding that there is no one frequency.
    """
    rate = terminals.sample_rate_hz
    try:
        if terminals.voltage_ab is None:
            voltage_ab = assumed_voltage(terminals.current_abc, rate, nameplate)
        else:
            voltage_ab = terminals.voltage_ab
        frequency = _frequency(voltage_ab, rate, nameplate)
        phasors = sequence_phasors(fundamental_phasors(voltage_ab, frequency, rate))
        channels = fundamental_phasors(terminals.voltages, frequency, rate)
    except SignalError as error:
        line = 0.0 if terminals.voltage_ab is None else _strongest_line(terminals.voltage_ab)
        if LINE_AMONG_PULSES < line < 1.0 - BESIDE_HARMONICS:
            return _pulses(1.0 - line)
        return finding("frequency", 0.0, nameplate.rated_frequency_Hz, "Hz", passed=False, message=str(error))
    return Feed(voltage_ab, frequency, phasors, channels, terminals.voltage_ab is None)


def frequency(feed: Feed, nameplate: Nameplate) -> Iterator[QualityFinding]:
    """Check that the supply has the rated frequency.

    Parameters
    ----------
    feed : Feed
        Frequency and phasors of the voltages.
    nameplate : Nameplate
        Rated values of the motor.

    Yields
    ------
    QualityFinding
        The finding.
    """
    rated = nameplate.rated_frequency_Hz
    yield finding(
        "frequency", feed.frequency_hz, rated, "Hz",
        passed=abs(feed.frequency_hz / rated - 1.0) <= FREQUENCY_TOLERANCE,
        message=f"{feed.frequency_hz:.2f} Hz is not the rated {rated:g} Hz within {FREQUENCY_TOLERANCE:.0%}: "
        "fed by a drive, or another motor's nameplate",
    )  # fmt: skip


def drive(feed: Feed, terminals: Terminals) -> Iterator[QualityFinding]:
    """Check for the pulses of an inverter.

    The currents it feeds do not follow from voltages sampled among the pulses.

    Parameters
    ----------
    feed : Feed
        Frequency and phasors of the voltages.
    terminals : Terminals
        Currents and voltages at the motor's terminals.

    Yields
    ------
    QualityFinding
        The finding.
    """
    cycles = feed.voltage_ab.shape[1] / terminals.sample_rate_hz * feed.frequency_hz
    if feed.assumed or cycles < 3 * LINE_WIDTH_BINS:
        # The harmonics' lines of a few cycles lie so close that there is nothing between them.
        return
    yield _pulses(_energy_beside_harmonics(feed.voltage_ab, feed.frequency_hz, terminals.sample_rate_hz))


def channels(feed: Feed, terminals: Terminals) -> Iterator[QualityFinding]:
    """Check that each channel is there, the right way round and of the others' ratio.

    Parameters
    ----------
    feed : Feed
        Frequency and phasors of the voltages.
    terminals : Terminals
        Currents and voltages at the motor's terminals.

    Yields
    ------
    QualityFinding
        A finding.
    """
    if feed.assumed:
        return
    names = [channel.name for channel in terminals.voltage_channels]
    sizes = np.abs(feed.channels)
    unbalance = feed.phasors.unbalance_factor
    broken = unbalance > UNBALANCE or _open_triangle(feed.channels, terminals) > TRIANGLE
    least = float(sizes.min() / sizes.max())
    lost = broken and least < LOST_CHANNEL
    yield finding(
        "voltage loss", least, LOST_CHANNEL, "of the greatest", passed=not lost,
        message=f"{names[int(sizes.argmin())]} shows {least:.0%} of the greatest voltage: fuse blown, wire "
        "or channel open",
    )  # fmt: skip
    if lost:
        return
    reversed_ones = _reversed(feed.channels, terminals) if broken else []
    yield finding(
        "voltage polarity", unbalance, UNBALANCE, "V2/V1", passed=not reversed_ones,
        message=f"with {' or '.join(names[k] for k in reversed_ones)} the other way round the voltages are "
        "balanced: exchange its wires",
    )  # fmt: skip
    if reversed_ones:
        return
    yield finding(
        "voltage unbalance", unbalance, UNBALANCE, "V2/V1", passed=unbalance <= UNBALANCE,
        message=f"V2/V1 of {unbalance:.0%} is no supply's: a channel's ratio, wiring or phase is wrong",
    )  # fmt: skip
    if unbalance <= UNBALANCE and len(names) == 3:
        yield _ratio(feed, terminals, names)


def level(feed: Feed, terminals: Terminals, nameplate: Nameplate) -> Iterator[QualityFinding]:
    """Check that the voltage is near the rated one.

    Parameters
    ----------
    feed : Feed
        Frequency and phasors of the voltages.
    terminals : Terminals
        Currents and voltages at the motor's terminals.
    nameplate : Nameplate
        Rated values of the motor.

    Yields
    ------
    QualityFinding
        The finding.
    """
    if feed.assumed:
        return
    volts = feed.strong * np.sqrt(3.0) / nameplate.rated_voltage_V
    low = volts < LOWEST_VOLTAGE
    yield finding(
        "voltage", volts, LOWEST_VOLTAGE if low else HIGHEST_VOLTAGE, "of rated",
        passed=LOWEST_VOLTAGE <= volts <= HIGHEST_VOLTAGE,
        message=f"{plain(volts)} of the rated voltage"
        + _scaling_hint(float(volts), nameplate, terminals.voltage_channels),
    )  # fmt: skip


def at_rated_voltage(feed: Feed, nameplate: Nameplate) -> Feed:
    """Return the supply as it would be at rated voltage, for voltages whose ratio is not known.

    Parameters
    ----------
    feed : Feed
        Frequency and phasors of the voltages.
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    Feed
        The same with other phasors.
    """
    factor = nameplate.rated_voltage_V / (np.sqrt(3.0) * feed.strong)
    phasors = replace(
        feed.phasors, positive=factor * feed.phasors.positive, negative=factor * feed.phasors.negative
    )
    return replace(feed, phasors=phasors)


def _ratio(feed: Feed, terminals: Terminals, names: list[str]) -> QualityFinding:
    """Check the ratios of three voltage channels.

    Three line voltages add up to nothing. Of three phase voltages, one channel's error makes as much zero as
    negative sequence, at an angle that names the channel.
    """
    if _is_triangle(terminals):
        total = _open_triangle(feed.channels, terminals)
        return finding(
            "voltage ratio", total, TRIANGLE, "of one", passed=total <= TRIANGLE,
            message=f"the line voltages add up to {total:.1%}, not to nothing: a channel's ratio or wiring "
            "is wrong",
        )  # fmt: skip
    zero = complex(feed.channels.mean())
    forward = feed.phasors.sequence is PhaseSequence.ABC
    weak = feed.phasors.negative if forward else feed.phasors.positive
    # A surplus on one phase makes V0 = a^k V2 for k = 0, 1, 2 = a, b, c; a^-k where the supply turns a-c-b.
    turn = _TURN if forward else _TURN.conjugate()
    share = abs(zero) / feed.strong
    unlike = [abs(weak * turn**k - zero) / feed.strong for k in range(3)]
    guilty = int(np.argmin(unlike))
    return finding(
        "voltage ratio", share, RATIO_ZERO, "V0/V1",
        passed=share <= RATIO_ZERO or unlike[guilty] > RATIO_LIKENESS * share,
        message=f"{names[guilty]} alone is off by {3.0 * share:.0%}: the ratio of its transformer or channel",
    )  # fmt: skip


def _is_triangle(terminals: Terminals) -> bool:
    """Three line voltages: only of them has the second no part in alpha."""
    return bool(terminals.voltage_axes.shape[1] == 3 and terminals.voltage_axes[0, 1] == 0.0)


def _open_triangle(phasors: NDArray[np.complex128], terminals: Terminals) -> float:
    """Sum of three line voltages over the greatest; 0 for any other set."""
    return float(abs(phasors.sum()) / np.abs(phasors).max()) if _is_triangle(terminals) else 0.0


def _reversed(phasors: NDArray[np.complex128], terminals: Terminals) -> list[int]:
    """Channels that, each alone, put the voltages right when turned over."""
    found = []
    for k in range(len(phasors)):
        turned = phasors.copy()
        turned[k] *= -1.0
        balanced = sequence_phasors(terminals.voltage_axes @ turned).unbalance_factor < UNBALANCE
        if balanced and _open_triangle(turned, terminals) < TRIANGLE:
            found.append(k)
    return found


def _scaling_hint(share: float, nameplate: Nameplate, channels: tuple[Channel, ...]) -> str:
    if abs(share * np.sqrt(3.0) - 1.0) < 0.1 or abs(share / np.sqrt(3.0) - 1.0) < 0.1:
        return ": line and phase voltages mixed up"
    advice = voltage_advice(share * nameplate.rated_voltage_V, nameplate, channels)
    if share < LOWEST_VOLTAGE:
        why = ": secondary volts or kV, a wrong ratio, or a motor being started or switched off"
        return why + appended(advice)
    return f": a wrong ratio or unit, or another motor's nameplate{appended(advice)}"


def _pulses(share: float) -> QualityFinding:
    return finding(
        "drive", share, BESIDE_HARMONICS, "of the energy", passed=share <= BESIDE_HARMONICS,
        message=f"{share:.0%} of the voltages' energy lies beside the supply's harmonics: fed by a drive? "
        "Its pulses cannot be diagnosed; run the motor on the mains",
    )  # fmt: skip


def _frequency(voltage_ab: Array, rate: float, nameplate: Nameplate) -> float:
    """Find the frequency of the voltages; where a drive's pulses hide the fundamental, of their average."""
    try:
        return fundamental_frequency(voltage_ab, rate, search_hz=nameplate.frequency_range_Hz)
    except SignalError:
        factor = int(rate / nameplate.rated_frequency_Hz / SMOOTHED_RATE_CYCLES)
        if factor < 2:
            raise
        return fundamental_frequency(
            decimate(voltage_ab, factor), rate / factor, search_hz=nameplate.frequency_range_Hz
        )


def _strongest_line(voltage_ab: Array) -> float:
    """Share of the energy in the strongest line, both sequences."""
    n = voltage_ab.shape[1]
    energy = (np.abs(np.fft.fft((voltage_ab - voltage_ab.mean(axis=1)[:, None]) * np.hanning(n))) ** 2).sum(
        axis=0
    )
    reach = int(LINE_WIDTH_BINS)
    peak = int(np.argmax(energy[: n // 2]))
    half = energy[: n // 2]
    total = float(half.sum())
    return float(half[max(0, peak - reach) : peak + reach + 1].sum()) / total if total > 0.0 else 0.0


def _energy_beside_harmonics(voltage_ab: Array, frequency_hz: float, rate: float) -> float:
    n = voltage_ab.shape[1]
    vector = voltage_ab[0] + 1j * voltage_ab[1]
    energy = np.abs(np.fft.fft((vector - vector.mean()) * np.hanning(n))) ** 2
    order = np.fft.fftfreq(n, 1.0 / rate) / frequency_hz
    nearest = np.round(order)
    bins = np.abs(order - nearest) * frequency_hz * n / rate
    harmonic = (bins <= LINE_WIDTH_BINS) & (np.abs(nearest) <= HIGHEST_HARMONIC)
    return float(1.0 - energy[harmonic].sum() / energy.sum())
