"""Quantiles of the normal distribution, in standard deviations."""

from typing import Final

NORMAL_95: Final = 1.96
"""Half of a 95 % interval."""
NINE_IN_TEN: Final = 1.2816
"""What nine of ten values are below."""
