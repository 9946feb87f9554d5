"""What every page of a motor has at its top: its name, its state, its tabs, and the time that charts show."""

from dataclasses import dataclass
from http import HTTPStatus
from typing import Final

from service.api.conditions.documents import condition_document
from service.api.conditions.schemas import Condition
from service.api.context import ApiContext
from service.api.problems import ProblemError
from service.condition.staleness import stale_after_ns
from service.storage.records import MotorHealth
from service.web.addresses import address
from service.web.motor.nameplate import KnownMotor, known_motor
from service.web.motor.time_range import SPANS, USUAL, TimeRange, span_of, time_range
from service.web.motor.verdict import MotorVerdict, motor_verdict
from service.web.navigation import Link


@dataclass(frozen=True, slots=True)
class Tab:
    """A page of a motor. key: the last part of its address, empty for the first.  is_of_time: has charts."""

    key: str
    words: str
    is_of_time: bool = True


OVERVIEW: Final = Tab("", "Overview")
STATOR: Final = Tab("stator", "Stator")
ROTOR: Final = Tab("rotor", "Rotor")
SUPPLY: Final = Tab("supply", "Supply")
LOAD: Final = Tab("load", "Load and heat")
STARTS: Final = Tab("starts", "Starts", is_of_time=False)
RECORDINGS: Final = Tab("recordings", "Recordings", is_of_time=False)
LOGBOOK: Final = Tab("logbook", "Logbook", is_of_time=False)
NAMEPLATE: Final = Tab("nameplate", "Nameplate")
TABS: Final = (OVERVIEW, STATOR, ROTOR, SUPPLY, LOAD, STARTS, RECORDINGS, LOGBOOK, NAMEPLATE)
_TABS: Final = {one.key: one for one in TABS}


@dataclass(frozen=True, slots=True)
class MotorHead:
    """What is at the top. known: None before a service has read the motors file.

    oldest_ns: age beyond which its latest record is too old.
    """

    name: str
    tab: Tab
    shown: TimeRange
    health: MotorHealth
    condition: Condition
    verdict: MotorVerdict
    known: KnownMotor | None
    oldest_ns: int

    @property
    def tabs(self) -> list[Link]:
        """Return the links to all tabs; the time that is shown goes along."""
        return [Link(self.at(one), one.words, one is self.tab) for one in TABS]

    @property
    def spans(self) -> list[Link]:
        """Return the links to this tab over other times."""
        span = self.shown.span
        return [Link(self.at(self.tab, one.key), one.words, one is span) for one in SPANS]

    @staticmethod
    def tab_of(key: str) -> Tab:
        """Return a tab by the last part of its address. Raises LookupError."""
        return _TABS[key]

    @property
    def here(self) -> str:
        """Return the address of this tab, without the time that is shown."""
        return tab_address(self.name, self.tab)

    def at(self, tab: Tab, days: str | None = None) -> str:
        """Return the address of a tab, over the time that is shown or another one."""
        key = self.shown.span.key if days is None else days
        return address(tab_address(self.name, tab), days=None if key == USUAL else key)


def tab_address(motor: str, tab: Tab) -> str:
    """Return the address of a tab over the usual time."""
    return address("/motors", motor, *([tab.key] if tab.key else []))


def motor_head(context: ApiContext, name: str, tab: Tab, days: str, now_ns: int) -> MotorHead:
    """Read what is at the top. Raises NotFoundError, and ProblemError (422) for an unknown time."""
    try:
        span = span_of(days)
    except LookupError as error:
        expected = ", ".join(one.key for one in SPANS)
        raise ProblemError(
            HTTPStatus.UNPROCESSABLE_ENTITY, f"query.days: expected one of {expected}, found {days!r}"
        ) from error
    repository = context.repository
    health = repository.health(name)
    oldest_ns = stale_after_ns(health.motor.schedule, context.settings.stale_after_days)
    condition = condition_document(
        health.condition, now_ns, oldest_ns, health.diagnosis, source=health.motor.parameters_source
    )
    known = known_motor(name, repository.motor_versions(name))
    limit = None if known is None else known.motor.limits.fault_level
    return MotorHead(
        name=name,
        tab=tab,
        shown=time_range(repository, name, span, now_ns),
        health=health,
        condition=condition,
        verdict=motor_verdict(health, condition, now_ns, oldest_ns, limit),
        known=known,
        oldest_ns=oldest_ns,
    )
