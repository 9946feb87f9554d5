"""Lower sample rates: a zero-phase low-pass filter, then every n-th sample."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TAPS_PER_FACTOR = 20
"""Length of the filter over the factor: wide enough that what folds back is 50 dB down."""


def decimate(x: Array, factor: int) -> Array:
    """Keep every `factor`-th sample of zero-phase filtered signals.

    The filter is a windowed sinc (Hamming) with its cut-off at the new Nyquist frequency and unit gain at
    zero frequency. It equals `scipy.signal.decimate(x, factor, ftype="fir", axis=1)`, which is not used
    because the import of scipy.signal takes longer than a whole diagnosis.

    Parameters
    ----------
    x : (m, n) array
        Signals, one a row, zero beyond their ends.
    factor : int
        Ratio of the sample rates, at least 1.

    Returns
    -------
    (m, ceil(n / factor)) array
        The filtered signals at the lower rate; the first sample is at the time of the first.
    """
    half = TAPS_PER_FACTOR * factor // 2
    k = np.arange(-half, half + 1)
    taps = np.sinc(k / factor) * np.hamming(2 * half + 1)
    taps /= taps.sum()
    n = x.shape[1]
    padded = np.zeros((x.shape[0], n + 2 * half))
    padded[:, half : half + n] = x
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=1)[:, ::factor]
    return np.asarray(windows @ taps)
