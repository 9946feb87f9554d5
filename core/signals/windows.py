"""Window functions."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def tukey_window(samples: int, tapered: float) -> Array:
    """Return a Tukey window: flat, with half a cosine at both ends.

    It equals `scipy.signal.windows.tukey(samples, tapered)`, which is not used because the import of
    scipy.signal takes longer than a whole diagnosis.

    Parameters
    ----------
    samples : int
        Length, at least 2.
    tapered : float
        Share of the window inside the two tapers, above 0 and at most 1.

    Returns
    -------
    (samples,) array
        Weights between 0 and 1.

    References
    ----------
    Harris, "On the use of windows for harmonic analysis with the discrete Fourier transform", Proc. IEEE 66
    (1978), doi:10.1109/PROC.1978.10837.
    """
    from_end = np.arange(samples) * (2.0 / (tapered * (samples - 1)))
    from_end = np.minimum(from_end, from_end[::-1])
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.minimum(from_end, 1.0)))
