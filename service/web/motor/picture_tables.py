"""The values behind the pictures of a motor's page, for those who do not see them."""

from cmath import phase
from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees
from typing import Final

from service.pictures.asymmetry import Asymmetry
from service.pictures.load import LoadPoint
from service.pictures.load_profile import STEP, LoadShare, load_bars
from service.pictures.supply import SupplyPoint
from service.web.charts.chart import MOST_ROWS, Table
from service.web.words import interval, percent

_PHASES: Final = "abc"


@dataclass(frozen=True, slots=True)
class PictureTables:
    """A table for each picture of `MotorDrawings`, by the same names."""

    asymmetry: Table
    load: Table
    supply: Table


def asymmetry_table(found: Asymmetry) -> Table:
    """Return the level and direction of each record, and of what stands and has come since."""
    rows = [("before", one) for one in found.before] + [("since the change", one) for one in found.since]
    known = [("what stands", found.standing), ("with the change", found.now)]
    return Table(
        _told(len(rows)),
        ("record", "level", "angle from phase a", "nearest phase"),
        tuple(
            (name, percent(abs(one)), f"{degrees(phase(one)):.0f}\N{DEGREE SIGN}", _nearest(one))
            for name, one in [*((n, v) for n, v in known if v is not None), *rows[-MOST_ROWS:]]
        ),
    )


def load_table(points: Sequence[LoadPoint]) -> Table:
    """Return the level of each record beside its load, the latest last."""
    return Table(
        _told(len(points)),
        ("load over rated", "fault level", "95 % interval", "state"),
        tuple(
            (
                percent(one.load, 0),
                percent(one.level),
                interval(None if one.low is None or one.high is None else (one.low, one.high)),
                one.state,
            )
            for one in points[-MOST_ROWS:]
        ),
    )


def supply_table(points: Sequence[SupplyPoint]) -> Table:
    """Return the unbalance of voltages and currents of each record, the latest last."""
    return Table(
        _told(len(points)),
        ("unbalance of the voltages V2/V1", "unbalance of the currents I2/I1"),
        tuple(
            (percent(one.voltage_unbalance), percent(one.current_unbalance)) for one in points[-MOST_ROWS:]
        ),
    )


def profile_table(shares: Sequence[LoadShare], of_what: str) -> Table:
    """Return the share of each class of the load."""
    bars = load_bars(shares)
    return Table(
        f"{len(bars)} classes of the load.",
        ("load over rated", f"share {of_what}"),
        tuple(
            (f"{100 * STEP * number:.0f} to {100 * STEP * (number + 1):.0f} %", percent(share, 1))
            for number, share in enumerate(bars)
        ),
    )


def _told(number: int) -> str:
    if number <= MOST_ROWS:
        return f"All {number} records, the latest last."
    return f"The latest {MOST_ROWS} of {number} records, the latest last."


def _nearest(one: complex) -> str:
    return _PHASES[round(degrees(phase(one)) / 120.0) % 3]
