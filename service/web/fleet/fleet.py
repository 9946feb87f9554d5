"""The whole fleet as it is now, worked out and written once for all who look until something changes."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from threading import Lock

from markupsafe import Markup

from core.condition.kinds import State
from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.access.reach import Sites
from service.configuration.settings import Settings
from service.pictures.looks import PAGE
from service.pictures.sparkline import SparkPoint, sparkline
from service.storage import Repository
from service.storage.records import ConditionDay
from service.storage.states import LinkState
from service.web.fleet.filters import FleetFilter
from service.web.fleet.rows import FleetRow, row_of
from service.web.fleet.states import FleetState
from service.web.pictures import markup

DAYS = 90
"""The small pictures show so many."""

ROWS_KEPT_NS = 300 * NANOSECONDS_PER_SECOND
"""So long a row is used again as it was written."""

MOST_PARTS = 32
"""So many choices of motors are kept as they were written."""


@dataclass(frozen=True, slots=True)
class FleetView:
    """All motors, those that need attention first, and a small picture of each by its name."""

    stamp: str
    rows: tuple[FleetRow, ...]
    pictures: Mapping[str, Markup]

    @property
    def latest_ns(self) -> int | None:
        """Return the time of the latest record that counts; None without any."""
        return max((row.as_of_ns for row in self.rows if row.as_of_ns is not None), default=None)

    @property
    def sites(self) -> list[str]:
        """Return the sites that have motors."""
        return sorted({row.site for row in self.rows})

    @property
    def not_known(self) -> int:
        """Return of how many motors nothing recent is known; one that stands still is not among them."""
        return sum(row.state in (FleetState.UNKNOWN, FleetState.STALE) for row in self.rows)

    @property
    def silent_relays(self) -> list[str]:
        """Return the relays that do not answer."""
        return sorted({row.ied for row in self.rows if row.link is not LinkState.UP})


@dataclass(frozen=True, slots=True)
class _Picture:
    """A motor's picture, and of what it was made: the version of its condition, and the first day."""

    version: int
    from_ns: int
    svg: Markup


@dataclass(frozen=True, slots=True)
class WrittenPart:
    """What is told of all motors, and those that a filter chooses, as written; compressed: both together."""

    summary: Markup
    motors: Markup
    compressed: bytes

    @property
    def text(self) -> str:
        """Return both."""
        return self.summary + self.motors


MOST_FLEETS = 20
"""So many sets of sites are kept in sight at a time."""


class Fleet:
    """Safe to share between threads. It keeps the latest view, and nothing of who looks."""

    def __init__(self, repository: Repository, settings: Settings) -> None:
        self._repository = repository
        self._settings = settings
        self._looking = Lock()
        self._writing = Lock()
        self._view: FleetView | None = None
        self._pictures: dict[str, _Picture] = {}
        self._rows: dict[str, tuple[int, Markup]] = {}
        self._parts: dict[tuple[str, FleetFilter], WrittenPart] = {}

    def part(self, stamp: str, wanted: FleetFilter, write: Callable[[FleetView], WrittenPart]) -> WrittenPart:
        """Return what `write` makes of the fleet as of a stamp, for a filter.

        All who look ask at the same time, when something has changed: one of them writes it, the others wait.
        """
        key = stamp, wanted
        kept = self._parts.get(key)
        if kept is not None:
            return kept
        view = self.view(stamp)
        with self._writing:
            kept = self._parts.get(key)
            if kept is None:
                kept = write(view)
                latest = [(each, part) for each, part in self._parts.items() if each[0] == stamp]
                self._parts = dict(latest[1 - MOST_PARTS :]) | {key: kept}
            return kept

    def view(self, stamp: str) -> FleetView:
        """Return the fleet as of a stamp, which is another one whenever anything else would be shown."""
        with self._looking:
            if self._view is None or self._view.stamp != stamp:
                self._view = self._now(stamp)
            return self._view

    def written_rows(
        self, rows: Sequence[FleetRow], now_ns: int, write: Callable[[FleetRow], Markup]
    ) -> list[Markup]:
        """Return the rows as `write` makes them: anew only those of which anything else is told.

        Ages in words may be some minutes behind; pages with scripts put them right. To be called by `write`
        of `part`, of which one runs at a time.
        """
        oldest_ns = now_ns - ROWS_KEPT_NS
        fresh = {digest: kept for digest, kept in self._rows.items() if kept[0] > oldest_ns}
        for row in rows:
            if row.digest not in fresh:
                fresh[row.digest] = now_ns, write(row)
        present = {row.digest for row in self._view.rows} if self._view is not None else set()
        self._rows = {digest: kept for digest, kept in fresh.items() if digest in present}
        return [fresh[row.digest][1] for row in rows]

    def _now(self, stamp: str) -> FleetView:
        now_ns = time.time_ns()
        found = self._repository.fleet()
        rows = [row_of(motor, now_ns, self._settings.stale_after_days) for motor in found]
        rows.sort(key=lambda row: row.attention)
        self._draw(rows, now_ns)
        return FleetView(stamp, tuple(rows), {name: kept.svg for name, kept in self._pictures.items()})

    def _draw(self, rows: list[FleetRow], now_ns: int) -> None:
        """Draw the pictures of the motors whose conditions have changed, or all on another day."""
        from_ns = now_ns - now_ns % NANOSECONDS_PER_DAY - (DAYS - 1) * NANOSECONDS_PER_DAY
        kept = {name: picture for name, picture in self._pictures.items() if picture.from_ns == from_ns}
        due = {row.name: row for row in rows if _version_of(kept.get(row.name)) != row.version}
        days = self._repository.condition_days(due, from_ns=from_ns)
        drawn = {
            name: _Picture(row.version, from_ns, _picture(row, days.get(name, ()), from_ns))
            for name, row in due.items()
        }
        self._pictures = {row.name: drawn.get(row.name) or kept[row.name] for row in rows}


class Fleets:
    """The fleet as those see it who may see some sites, or all. Safe to share between threads."""

    def __init__(self, repository: Repository, settings: Settings) -> None:
        self._repository = repository
        self._settings = settings
        self._lock = Lock()
        self._fleets: dict[Sites, Fleet] = {}

    def at(self, sites: Sites) -> Fleet:
        """Return the fleet at these sites; the ones that were asked for last are kept."""
        with self._lock:
            fleet = self._fleets.pop(sites, None)
            if fleet is None:
                fleet = Fleet(self._repository.within(sites), self._settings)
            self._fleets[sites] = fleet
            for over in list(self._fleets)[:-MOST_FLEETS]:
                del self._fleets[over]
            return fleet


def _version_of(picture: _Picture | None) -> int | None:
    return None if picture is None else picture.version


def _picture(row: FleetRow, days: tuple[ConditionDay, ...], from_ns: int) -> Markup:
    """Return the highest level of each day; the last one in the motor's state."""
    points = [
        SparkPoint(day.day_ns, day.mu_f_largest, State.HEALTHY)
        for day in days
        if day.mu_f_largest is not None
    ]
    if points:
        points[-1] = SparkPoint(points[-1].time_ns, points[-1].level, row.judged)
    to_ns = from_ns + (DAYS - 1) * NANOSECONDS_PER_DAY
    svg = sparkline(row.name, points, from_ns=from_ns, to_ns=to_ns, reference=row.reference, look=PAGE)
    return markup(svg)
