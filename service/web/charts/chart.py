"""A chart of a page as data: series over one axis, what lies over them, and the table of values behind it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite
from typing import Final

from core.quantity_text import plain
from core.time_words import clock
from core.units import NANOSECONDS_PER_SECOND

MOST_ROWS: Final = 40
"""Rows of the table of values. Longer ones are thinned, and say so."""
DIGITS: Final = 5
MISSING: Final = "–"

Values = Sequence[float | None]


class Tone(StrEnum):
    """The colours of the theme. Those of phases are `--phase-a` and so on in the page's style."""

    INK = "ink"
    MUTED = "muted"
    ACCENT = "accent"
    WATCH = "watch"
    FAULT = "fault"
    MODEL = "model"
    A = "a"
    B = "b"
    C = "c"


class Kind(StrEnum):
    """How values are drawn."""

    LINE = "line"
    STEPS = "steps"
    POINTS = "points"
    ENVELOPE = "envelope"
    """Each value stands for many: what is drawn reaches from the lowest to the highest of them."""
    DASHES = "dashes"
    THIN = "thin"
    """What a model says, or another recording, over what was measured."""


class AxisKind(StrEnum):
    """Whether values of x are numbers, or times in seconds since 1970, which the page shows in local time."""

    NUMBER = "number"
    TIME = "time"


@dataclass(frozen=True, slots=True)
class Series:
    """One quantity. Values that are None or not finite are gaps.

    low, high: ends of each value's interval, or of the envelope that the value stands for.  short: what
    stands at the end of its line; empty for the label.
    """

    label: str
    values: Values
    unit: str = ""
    tone: Tone = Tone.INK
    kind: Kind = Kind.LINE
    low: Values | None = None
    high: Values | None = None
    short: str = ""

    def document(self) -> dict[str, object]:
        """Return the series as the script takes it."""
        document: dict[str, object] = {
            "label": self.label,
            "unit": self.unit,
            "tone": str(self.tone),
            "kind": str(self.kind),
            "values": _finite(self.values),
        }
        if self.short:
            document["short"] = self.short
        if self.low is not None and self.high is not None:
            document |= {"low": _finite(self.low), "high": _finite(self.high)}
        return document


@dataclass(frozen=True, slots=True)
class Mark:
    """An event on the axis of x, such as a start: a line with a label."""

    x: float
    label: str
    tone: Tone = Tone.MUTED


@dataclass(frozen=True, slots=True)
class Limit:
    """A value of y that matters, such as a limit: a line with a label."""

    y: float
    label: str
    tone: Tone = Tone.FAULT


@dataclass(frozen=True, slots=True)
class Band:
    """Values of y between which nothing is the matter, such as those that a standard allows: a ground."""

    low: float
    high: float
    label: str
    tone: Tone = Tone.MUTED


@dataclass(frozen=True, slots=True)
class Table:
    """Values as text. told: what the table has, in words."""

    told: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class Chart:
    """Series over x, which is ascending.

    key: unique in the page, letters, digits and dashes.  caption: what is shown.  summary: what it says, in
    words.  x_from, x_to, y_from, y_to: values that the axes have to include.  sync: charts of the same name
    share cursor and zoom.  height: in CSS pixels.  in_rows: series are states, 0 or 1, each in a row of its
    own.  table_rows: of the table of values, at most.
    """

    key: str
    caption: str
    x_label: str
    y_label: str
    x: Sequence[float]
    series: Sequence[Series]
    summary: str = ""
    x_unit: str = ""
    y_unit: str = ""
    x_kind: AxisKind = AxisKind.NUMBER
    x_from: float | None = None
    x_to: float | None = None
    y_from: float | None = None
    y_to: float | None = None
    marks: Sequence[Mark] = ()
    limits: Sequence[Limit] = ()
    bands: Sequence[Band] = ()
    sync: str = ""
    height: int = 240
    in_rows: bool = False
    table_rows: int = MOST_ROWS

    def document(self) -> Mapping[str, object]:
        """Return the chart as the script static/js/charts/description.js names it."""
        return {
            "x": {
                "label": self.x_label,
                "unit": self.x_unit,
                "kind": str(self.x_kind),
                "from": self.x_from,
                "to": self.x_to,
                "values": list(self.x),
            },
            "y": {"label": self.y_label, "unit": self.y_unit, "from": self.y_from, "to": self.y_to},
            "series": [one.document() for one in self.series],
            "marks": [{"x": one.x, "label": one.label, "tone": str(one.tone)} for one in self.marks],
            "limits": [{"y": one.y, "label": one.label, "tone": str(one.tone)} for one in self.limits],
            "bands": [
                {"low": one.low, "high": one.high, "label": one.label, "tone": str(one.tone)}
                for one in self.bands
            ],
            "sync": self.sync,
            "height": self.height,
            "rows": self.in_rows,
        }

    @property
    def table(self) -> Table:
        """The values as text: all of them, or some with every series' smallest and largest among them."""
        rows = chosen_rows([one.values for one in self.series], len(self.x), self.table_rows)
        shown = f"All {len(rows)} values."
        if len(rows) < len(self.x):
            chosen = "every so many, and the smallest and largest of each column"
            shown = f"{len(rows)} of {len(self.x)} values: {chosen}."
        x_heading = "time" if self.x_kind is AxisKind.TIME else _heading(self.x_label, self.x_unit)
        headings = [x_heading]
        for one in self.series:
            headings.append(_heading(one.label, one.unit))
            if one.low is not None and one.high is not None:
                headings += [f"{one.label}: low", f"{one.label}: high"]
        return Table(shown, tuple(headings), tuple(self._row(number) for number in rows))

    @property
    def lines_told(self) -> tuple[str, ...]:
        """What lies over the series, in words: limits from above, bands, then marks in their order."""
        unit = f" {self.y_unit}" if self.y_unit else ""
        limits = sorted(self.limits, key=lambda one: one.y, reverse=True)
        marks = sorted(self.marks, key=lambda one: one.x)
        return (
            *(f"{one.label}, at {plain(one.y, DIGITS, with_commas=False)}{unit}" for one in limits),
            *(
                f"{one.label}, {plain(one.low, DIGITS, with_commas=False)} to "
                f"{plain(one.high, DIGITS, with_commas=False)}{unit}"
                for one in self.bands
            ),
            *(f"{one.label}, at {self._place(one.x)}" for one in marks),
        )

    def _place(self, x: float) -> str:
        if self.x_kind is AxisKind.TIME:
            return _instant(x)
        return f"{plain(x, 7, with_commas=False)} {self.x_unit}".rstrip()

    def _row(self, number: int) -> tuple[str, ...]:
        at = self.x[number]
        first = _instant(at) if self.x_kind is AxisKind.TIME else plain(at, 7, with_commas=False)
        cells = [first]
        for one in self.series:
            cells.append(_cell(one.values[number]))
            if one.low is not None and one.high is not None:
                cells += [_cell(one.low[number]), _cell(one.high[number])]
        return tuple(cells)


def chosen_rows(columns: Sequence[Values], count: int, most: int) -> tuple[int, ...]:
    """Return the numbers of the rows to show: evenly spaced ones, and those with a column's extremes."""
    if count <= most:
        return tuple(range(count))
    extremes: set[int] = set()
    for column in columns:
        known = [k for k, value in enumerate(column) if value is not None and isfinite(value)]
        if known:
            extremes |= {
                min(known, key=lambda k: column[k] or 0.0),
                max(known, key=lambda k: column[k] or 0.0),
            }
    spaced = max(2, most - len(extremes))
    every = {round(k * (count - 1) / (spaced - 1)) for k in range(spaced)}
    return tuple(sorted(every | extremes))


def _heading(label: str, unit: str) -> str:
    return f"{label} ({unit})" if unit else label


def _finite(values: Values) -> list[float | None]:
    return [None if value is None or not isfinite(value) else value for value in values]


def _cell(value: float | None) -> str:
    return MISSING if value is None or not isfinite(value) else plain(value, DIGITS, with_commas=False)


def _instant(seconds: float) -> str:
    return clock(round(seconds * NANOSECONDS_PER_SECOND), seconds=True)
