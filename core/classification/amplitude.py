"""Evidence of amplitudes: of a line whose phase tells nothing.

An amplitude is complex and Gaussian, with the variance of its measurement and that of what a sound motor, or
one with the cause, is expected to have.
"""

from collections.abc import Sequence
from math import log

from core.classification.evidence import Block, log_sum, only
from core.diagnosis.causes import Cause
from core.normal_distribution import NORMAL_95

EVEN_CAGE, UNEVEN_CAGES = 0.005, (0.02, 0.06, 0.18)
"""Asymmetry of a sound cage, rms (-46 dB), and of cages with broken bars: one of 28 has 0.034."""


def rotor_block(severity_dB: float | None, ci95: tuple[float, float] | None) -> Block | None:
    """Return the evidence of the rotor's asymmetry."""
    if severity_dB is None or ci95 is None:
        return None
    value = ratio(severity_dB)
    low, high = map(ratio, ci95)
    # The interval is cut off at the lowest figure that is written.
    deviation = max(high - low, 2.0 * (high - value)) / (2.0 * NORMAL_95)
    return only(
        Cause.ROTOR,
        log_ratio(value, deviation, EVEN_CAGE, UNEVEN_CAGES),
        f"asymmetry of the rotor's resistance {severity_dB:.1f} dB",
    )


def log_ratio(value: float, deviation: float, sound: float, uneven: Sequence[float]) -> float:
    """Return the log of the likelihood ratio of an amplitude: with the cause to without it."""

    def log_density(expected: float) -> float:
        variance = 2.0 * deviation**2 + expected**2
        return -(value**2) / variance - log(variance)

    with_it = log_sum([log_density(one) for one in uneven]) - log(len(uneven))
    return with_it - log_density(sound)


def ratio(level_dB: float) -> float:
    """Return the ratio of amplitudes that a level means."""
    return float(10.0 ** (level_dB / 20.0))
