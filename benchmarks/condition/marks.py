"""What is asked of a section, what was found, and whether that meets it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from benchmarks.condition.circuit import Array
from benchmarks.condition.following import quantile_text
from benchmarks.reporting import mark, rate_interval, rate_text, table

HEADER = ("what", "asked", "found", "met?")
NOTHING = "none to judge"
TOLERANCE = 1e-9
"""Of a product of a share and a number, which may miss a whole number by rounding."""


@dataclass(frozen=True, slots=True)
class Mark:
    """One figure that is asked for.

    The estimate is compared, as it is and without rounding, not its interval.

    what: in words.  asked: the figure that is to be reached.  found: the estimate with its 95 % interval.
    met: None where there was nothing to judge.
    """

    what: str
    asked: str
    found: str
    met: bool | None

    def row(self) -> list[str]:
        """Return the row of a table with `HEADER`."""
        return [self.what, self.asked, self.found, self.verdict]

    @property
    def verdict(self) -> str:
        return "not judged" if self.met is None else mark(self.met)

    def as_dict(self) -> dict[str, object]:
        return asdict(self)

    @classmethod
    def from_dict(cls, document: Mapping[str, Any]) -> "Mark":
        return cls(**document)


def at_least(what: str, count: int, of: int, least: float) -> Mark:
    """A rate that is to be so high."""
    asked = "all" if least == 1.0 else f"at least {percent(least)}"
    return _rate(what, asked, count, of, count >= least * of - TOLERANCE)


def at_most(what: str, count: int, of: int, most: float) -> Mark:
    """A rate that is to be no higher."""
    asked = "none" if most == 0.0 else f"at most {percent(most)}"
    return _rate(what, asked, count, of, count <= most * of + TOLERANCE)


def below(what: str, count: int, of: int, most: float) -> Mark:
    """A rate that is to be lower."""
    return _rate(what, f"below {percent(most)}", count, of, count < most * of - TOLERANCE)


def range_reached(what: str, counts: Mapping[str, tuple[int, int]], low: float, high: float) -> Mark:
    """Rates of several cases: the lowest is to reach the low end of a range, the highest its high end."""
    rates = [count / of for count, of in counts.values() if of]
    found = "; ".join(f"{name}: {_short_rate(*one)}" for name, one in counts.items())
    ends = f"{percent(low)} to {percent(high)}" if low < high else percent(low)
    asked = "all" if low == 1.0 else ends
    met = min(rates) >= low - TOLERANCE and max(rates) >= high - TOLERANCE if rates else None
    return Mark(what, asked, found, met)


def median_at_most(what: str, delays: Array, most: float) -> Mark:
    """A median of delays in records, counted from 0 for the first record that could show it."""
    met = float(np.median(delays)) + 1.0 <= most if delays.size else None
    found = f"{quantile_text(delays)} ({delays.size} cases)" if delays.size else NOTHING
    return Mark(what, f"at most {most:g} records", found, met)


def figure_at_most(what: str, value: float, most: float, unit: str) -> Mark:
    """A figure that is to be no greater."""
    return Mark(what, f"at most {most:g} {unit}", f"{value:.1f} {unit}", value <= most)


def marks_table(marks: Iterable[Mark]) -> list[str]:
    """A Markdown table of them."""
    return table(HEADER, [one.row() for one in marks])


def summary(marks: Sequence[Mark]) -> list[str]:
    """How many are met and how many fall short, as cells of a table."""
    judged = [one for one in marks if one.met is not None]
    short = sum(not one.met for one in judged)
    return [f"{len(judged)}", f"{len(judged) - short}", f"**{short}**" if short else "0"]


def _rate(what: str, asked: str, count: int, of: int, met: bool) -> Mark:
    return Mark(what, asked, rate_text(count, of), met) if of else Mark(what, asked, NOTHING, None)


def _short_rate(count: int, of: int) -> str:
    if not of:
        return NOTHING
    low, high = rate_interval(count, of)
    return f"{percent(count / of)} ({_figure(low)} to {_figure(high)})"


def percent(share: float) -> str:
    """A share in percent, to a hundredth where that is needed; less than all is never 100 %."""
    return f"{_figure(share, digits=2)} %"


def _figure(share: float, digits: int = 1) -> str:
    rounded = round(100.0 * share, digits)
    if rounded >= 100.0 and share < 1.0:
        rounded = 100.0 - 10.0**-digits
    return f"{rounded:.{digits}f}".rstrip("0").rstrip(".")
