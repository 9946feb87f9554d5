"""What is left of a current beside its supply: the spectrum over its own noise.

The supply's harmonics are 60 dB above the lines of the rotor. They are taken off by a joint least-squares fit
of both sequences, of which the largest may grow through the record. The spectrum of the rest is measured over
its running median: noise alone is then exponential with a mean of one, whatever its colour.
"""

from dataclasses import dataclass
from math import log, pi
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, median_filter

from core.machines.base import Array
from core.machines.steady_state import ComplexArray
from core.signals.decimation import TAPS_PER_FACTOR, decimate

GROWING: Final = (1, 3, 5, 7)
"""Orders of harmonics whose amplitude and phase may change through a record."""
PAD: Final = 8
"""Least points of the spectrum a bin."""
MEDIAN_STEP: Final = 4
"""Of so many points one enters the running median, which costs the most."""
MEDIAN_HZ: Final = 30.0
"""Half the width of the running median: narrower ones let a line raise its own noise."""
ENOUGH_RATE_HZ: Final = 8_000.0
"""Higher rates are lowered to about this one; slot lines lie below 4 kHz."""
SAME_FREQUENCY_HZ: Final = 2e-3
"""A frequency that is nearer to the supply's is not fitted again."""
GREATEST_EXCESS: Final = 20.0
"""What the top of a strong line is lowered to, with its skirts: they would pass for lines otherwise, and no
foreign line is to outweigh a comb."""
SKIRT_BINS: Final = 4.0
"""Half the width of what is lowered with a strong line."""
GUARD_BINS: Final = 2.0
"""Bins at both ends of the spectrum, and about harmonics of the supply, that show no line."""


@dataclass(frozen=True, slots=True)
class Residue:
    """Spectrum of one piece of a current without its supply's harmonics, over its noise.

    Parameters
    ----------
    excess : ndarray, shape (n,)
        Power over the noise around, from frequency zero upwards; the upper half are negative frequencies.
        Strong lines are lowered to `GREATEST_EXCESS`, in their shape.
    step_hz : float
        Distance of its points [Hz].
    frequency_hz : float
        Frequency of the supply in this piece [Hz].
    duration_s : float
        Length of the piece [s].
    sample_rate_hz : float
        Rate of the samples the spectrum is of [Hz].
    is_one_current : bool
        Whether it is of one current: its negative frequencies then repeat the positive ones.
    """

    excess: Array
    step_hz: float
    frequency_hz: float
    duration_s: float
    sample_rate_hz: float
    is_one_current: bool

    def shows(self, frequency_hz: Array) -> NDArray[np.bool_]:
        """Return where a line could be seen.

        Parameters
        ----------
        frequency_hz : ndarray
            Frequencies, negative ones against the supply's sequence [Hz].

        Returns
        -------
        ndarray of bool
            False beyond the band, near a harmonic of the supply and, of one current, below zero.
        """
        guard_hz, supply_hz = GUARD_BINS / self.duration_s, self.frequency_hz
        within = np.abs(frequency_hz) < 0.5 * self.sample_rate_hz - guard_hz
        apart = np.abs(frequency_hz - supply_hz * np.round(frequency_hz / supply_hz)) > guard_hz
        return np.asarray(within & apart & ((frequency_hz > 0.0) | (not self.is_one_current)))

    def at(self, frequency_hz: Array) -> Array:
        """Return the excess at frequencies, linear between the points of the spectrum.

        Parameters
        ----------
        frequency_hz : ndarray
            Frequencies [Hz].

        Returns
        -------
        ndarray
            Excess.
        """
        place = frequency_hz / self.step_hz
        below = np.floor(place).astype(np.int64)
        share = place - below
        size = self.excess.size
        return np.asarray(self.excess[below % size] * (1.0 - share) + self.excess[(below + 1) % size] * share)


def residue_of(current: Array, sample_rate_hz: float, frequency_hz: float) -> Residue:
    """Take the supply's harmonics off a piece of steady running, and measure the rest over its noise.

    Parameters
    ----------
    current : ndarray, shape (2, n) or (1, n)
        Line currents on Clarke axes, or a single one, without missing samples, all of one instant [A].
    sample_rate_hz : float
        Sampling rate [Hz].
    frequency_hz : float
        Frequency of the supply, good to a tenth of a cycle over the piece [Hz].

    Returns
    -------
    Residue
        The spectrum, in which the supply turns forward.
    """
    factor = max(1, int(sample_rate_hz / ENOUGH_RATE_HZ))
    if factor > 1:
        # The filter takes samples beyond the ends for zero, so the ends are left out.
        current = decimate(current, factor)[:, TAPS_PER_FACTOR // 2 : -TAPS_PER_FACTOR // 2]
    rate = sample_rate_hz / factor
    one = current.shape[0] == 1
    z = current[0].astype(np.complex128) if one else _forward(current, rate, frequency_hz)
    rest, found_hz = _without_harmonics(z, rate, frequency_hz)
    excess, step_hz = _over_noise(rest, rate)
    return Residue(excess, step_hz, found_hz, z.size / rate, rate, one)


def _forward(current_ab: Array, rate: float, frequency_hz: float) -> ComplexArray:
    """Return the space vector, mirrored where the supply turns backward."""
    z = current_ab[0] + 1j * current_ab[1]
    turn = np.exp(-2j * pi * frequency_hz / rate * np.arange(z.size))
    return np.asarray(z if abs(np.vdot(turn.conj(), z)) >= abs(np.vdot(turn, z)) else z.conj())


def _without_harmonics(z: ComplexArray, rate: float, frequency_hz: float) -> tuple[ComplexArray, float]:
    """Return what is left beside the harmonics, and the supply's frequency.

    What the fundamental's phase does through the record corrects a frequency that is a little off.
    """
    rest, off_hz = _fitted(z, rate, frequency_hz)
    if abs(off_hz) <= SAME_FREQUENCY_HZ:
        return rest, frequency_hz
    frequency_hz += off_hz
    rest, off_hz = _fitted(z, rate, frequency_hz)
    return rest, frequency_hz + off_hz


def _fitted(z: ComplexArray, rate: float, frequency_hz: float) -> tuple[ComplexArray, float]:
    n = z.size
    middle = (n - 1) / 2.0
    u = (np.arange(n) - middle) / middle
    highest = int((0.5 * rate - GUARD_BINS * rate / n) / frequency_hz)
    turning = np.empty((highest + 1, n), np.complex128)
    turning[0], turning[1] = 1.0, np.exp(2j * pi * frequency_hz / rate * (np.arange(n) - middle))
    for order in range(2, highest + 1):
        np.multiply(turning[order - 1], turning[1], out=turning[order])
    orders = np.arange(-highest, highest + 1)
    growing = np.array([sign * order for order in GROWING if order <= highest for sign in (1, -1)])
    # Sums of exp(j m x) times 1, u and u^2 over the samples are all that the normal equations are of.
    powers = np.stack([np.ones(n), u, u * u], axis=1)
    sums = np.concatenate([turning @ powers, (turning @ (turning[highest][:, np.newaxis] * powers))[1:]])
    sums = np.concatenate([sums[:0:-1].conj(), sums])

    def gram(rows: NDArray[np.int64], columns: NDArray[np.int64], power: int) -> ComplexArray:
        return np.asarray(sums[columns[np.newaxis] - rows[:, np.newaxis] + 2 * highest, power])

    normal = np.block(
        [
            [gram(orders, orders, 0), gram(orders, growing, 1)],
            [gram(growing, orders, 1), gram(growing, growing, 2)],
        ]
    )
    samples = np.stack([z, z * u], axis=1)
    right = np.concatenate([(turning @ samples)[:0:-1], turning.conj() @ samples])
    found = np.linalg.solve(normal, np.concatenate([right[:, 0], right[growing + highest, 1]]))
    steady, ramp = found[: orders.size], np.zeros(orders.size, np.complex128)
    ramp[growing + highest] = found[orders.size :]

    def wave(amplitude: ComplexArray) -> ComplexArray:
        backward = (amplitude[:highest][::-1].conj() @ turning[1:]).conj()
        return np.asarray(amplitude[highest:] @ turning + backward)

    ahead = (ramp[highest + 1] / steady[highest + 1]).imag
    return z - wave(steady) - u * wave(ramp), float(ahead / middle * rate / (2.0 * pi))


def _over_noise(rest: ComplexArray, rate: float) -> tuple[Array, float]:
    n = rest.size
    # A half sine: it keeps more of a line than a Hann window does, and its ends fade out.
    window = np.sin(pi * (np.arange(n) + 0.5) / n)
    points = 1 << (PAD * n - 1).bit_length()
    power = np.abs(np.fft.fft(rest * window, points)) ** 2
    step_hz = rate / points
    half = round(MEDIAN_HZ / (step_hz * MEDIAN_STEP))
    median = median_filter(power[::MEDIAN_STEP], 2 * half + 1, mode="wrap") / log(2.0)
    noise = np.interp(np.arange(points), np.arange(0, points, MEDIAN_STEP), median, period=float(points))
    excess = power / np.maximum(noise, np.finfo(np.float64).tiny)
    width = 2 * round(SKIRT_BINS * points / n) + 1
    strongest = maximum_filter1d(excess, width, mode="wrap")
    return np.asarray(excess / np.maximum(1.0, strongest / GREATEST_EXCESS)), step_hz
