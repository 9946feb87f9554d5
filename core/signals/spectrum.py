"""Amplitude spectra of sampled quantities, and the lines of an induction motor that matter in them."""

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from core.signals.errors import SignalError

FEWEST_SAMPLES = 16
MAIN_LOBE_BINS = 4.0
"""Width of a line under a Hann window. Lines that lie nearer to one another run into one."""
HARMONIC_ORDERS = (3, 5, 7, 11, 13, 17, 19)
LEAST_SLIP = 1e-4
"""At less the sidebands of broken bars lie within the supply's own line in any recording."""


@dataclass(frozen=True, slots=True)
class Spectrum:
    """Amplitudes of the lines of some quantities.

    Parameters
    ----------
    frequency_hz : ndarray, shape (lines,)
        Frequencies [Hz].
    amplitude : ndarray, shape (quantities, lines)
        Rms value of a sine of that frequency, in the quantity's unit.
    resolution_hz : float
        Least distance of two lines that are told apart [Hz].
    """

    frequency_hz: NDArray[np.float64]
    amplitude: NDArray[np.float64]
    resolution_hz: float


@dataclass(frozen=True, slots=True)
class SpectralLine:
    """A line to look for.

    Parameters
    ----------
    frequency_hz : float
        Its frequency [Hz].
    label : str
        What it is, in short, such as "5f" or "(1-2s)f".
    meaning : str
        What makes it.
    """

    frequency_hz: float
    label: str
    meaning: str


def amplitude_spectrum(x: NDArray[np.float64], sample_rate_hz: float) -> Spectrum:
    """Return the amplitude spectrum under a Hann window, without the mean value.

    Parameters
    ----------
    x : ndarray, shape (quantities, n)
        Samples, all finite.
    sample_rate_hz : float
        Sampling rate [Hz].

    Returns
    -------
    Spectrum
        The spectrum. Between two of its frequencies a line reads up to 15 % too low.

    Raises
    ------
    SignalError
        If there are too few samples, or values that are not finite.

    References
    ----------
    .. [1] Harris, "On the use of windows for harmonic analysis with the discrete Fourier transform",
       Proc. IEEE 66 (1978) 51-83.
    """
    n = x.shape[-1]
    if n < FEWEST_SAMPLES:
        raise SignalError(f"{n} samples are too few for a spectrum; at least {FEWEST_SAMPLES} are needed")
    if not np.isfinite(x).all():
        raise SignalError("a spectrum needs finite samples; the waveform has missing values")
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(n) / n)
    lines = np.abs(np.fft.rfft((x - x.mean(axis=-1, keepdims=True)) * window)) / window.sum()
    return Spectrum(
        frequency_hz=np.arange(n // 2 + 1) * (sample_rate_hz / n),
        amplitude=np.sqrt(2.0) * lines,
        resolution_hz=MAIN_LOBE_BINS * sample_rate_hz / n / 2.0,
    )


def lines_of_a_motor(
    frequency_hz: float,
    highest_hz: float,
    *,
    slip: float | None = None,
    pole_pairs: int | None = None,
    rotor_bars: int | None = None,
) -> tuple[SpectralLine, ...]:
    """Return the lines that matter in the stator current, by frequency.

    Parameters
    ----------
    frequency_hz : float
        Frequency of the supply [Hz].
    highest_hz : float
        Highest frequency of the spectrum [Hz].
    slip : float or None, optional
        Slip; None where the speed is not known. Without it there are harmonics alone.
    pole_pairs : int or None, optional
        Number of pole pairs.
    rotor_bars : int or None, optional
        Number of rotor slots; None where it is not known.

    Returns
    -------
    tuple of SpectralLine
        The lines.

    References
    ----------
    .. [1] Thomson, Fenger, "Current signature analysis to detect induction motor faults", IEEE Industry
       Applications Magazine 7(4) (2001) 26-34.
    """
    f = frequency_hz
    lines = [SpectralLine(f, "f", "the supply")]
    lines += [
        SpectralLine(order * f, f"{order}f", "a harmonic of the supply or of saturation")
        for order in HARMONIC_ORDERS
    ]
    if slip is not None and isfinite(slip) and abs(slip) > LEAST_SLIP:
        lines += [
            SpectralLine((1.0 + sign * 2.0 * slip) * f, label, "broken rotor bars, or a load that swings")
            for sign, label in ((-1.0, "(1−2s)f"), (1.0, "(1+2s)f"))
        ]
    if slip is not None and isfinite(slip) and pole_pairs and rotor_bars:
        turning = rotor_bars * (1.0 - slip) / pole_pairs
        lines += [
            SpectralLine(abs(turning + order) * f, label, "the rotor's slots")
            for order, label in ((-1.0, "slots −f"), (1.0, "slots +f"))
        ]
    return tuple(sorted((one for one in lines if 0.0 < one.frequency_hz <= highest_hz), key=_frequency))


def _frequency(line: SpectralLine) -> float:
    return line.frequency_hz
