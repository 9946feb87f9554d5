"""Numbers as people write them: 130 kA or 0.00012, and never 1.3e+05."""

from math import floor, isfinite, log10
from typing import Final

PREFIXES: Final = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "u"))

PREFIXED: Final = frozenset({"A", "V", "W", "VA", "var", "ohm", "H", "Hz", "s"})
"""Units that take a prefix. Others, such as kA or kgm2, stay as they are."""

LEAST_WITHOUT_PREFIX: Final = 0.1
MOST_WITHOUT_PREFIX: Final = 1e4

LONGEST_POWER: Final = 12
"""Numbers beyond this power of ten are no measurements, and are written with it."""


def plain(value: float, digits: int = 3, *, with_commas: bool = True) -> str:
    """Return a number rounded to significant digits, without a power of ten; large ones with commas.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        How many significant digits are kept.
    with_commas : bool
        Without them the text can be written into a file as it is.

    Returns
    -------
    str
        The number as text, such as 0.00012, 1250 or 130,000.
    """
    if not isfinite(value) or value == 0.0:
        return f"{value:g}"
    power = floor(log10(abs(value)))
    if abs(power) > LONGEST_POWER:
        return f"{value:.{digits}g}"
    decimals = digits - 1 - power
    rounded = round(value, decimals)
    commas = "," if with_commas and abs(rounded) >= MOST_WITHOUT_PREFIX else ""
    text = f"{rounded:{commas}.{max(decimals, 0)}f}"
    return text.rstrip("0").rstrip(".") if decimals > 0 else text


def with_unit(value: float, unit: str, digits: int = 3) -> str:
    """Return a quantity rounded to significant digits, with a prefix where that is shorter.

    Parameters
    ----------
    value : float
        The quantity in `unit`.
    unit : str
        Its unit without a prefix, such as A; another one is kept as it is.
    digits : int
        How many significant digits are kept.

    Returns
    -------
    str
        The quantity as text, such as 130 kA, 1250 A or 120 us.
    """
    size = abs(value)
    if unit not in PREFIXED or not isfinite(value) or LEAST_WITHOUT_PREFIX <= size < MOST_WITHOUT_PREFIX:
        return f"{plain(value, digits)} {unit}".rstrip()
    for factor, prefix in PREFIXES:
        if size >= factor:
            return f"{plain(value / factor, digits)} {prefix}{unit}"
    return f"{plain(value, digits)} {unit}"
