"""A thousand alarms in a minute become one line that says so, and those that stay are told one by one."""

import time
from collections import Counter

import pytest
import structlog
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from service.alarms.kinds import AlarmKind, AlarmPriority
from service.plant import Plant, Site
from service.storage import Repository
from service.storage.models import AlarmRow
from service.storage.records import Alarm, AlarmPlace, AlarmSpec
from service.storage.repository.alarms.causes import clear, locked_place, raised_at
from service.storage.states import AlarmState
from testing.service.plants import NOW_NS, SECOND_NS, relay, two_motor_plant

MOST = 10
CALLS = AlarmState.UNACKNOWLEDGED

log = structlog.get_logger(__name__)


class Floods:
    """Two sites, whose relays raise alarms; times in seconds from NOW_NS."""

    def __init__(self, engine: Engine, repository: Repository, relays: int) -> None:
        self._engine = engine
        self.repository = repository
        plant = two_motor_plant()
        self.relays = [relay(f"{site}{one:04}", site, 11000 + one) for site in "EW" for one in range(relays)]
        sites = (*plant.sites, Site("E", "East"), Site("W", "West"))
        repository.sync_plant(Plant(sites, (*plant.relays, *self.relays), plant.motors))

    def raise_alarms(self, kind: AlarmKind, site: str, number: int, at_s: float = 0.0) -> None:
        """Have so many relays of a site raise an alarm, as gateways do."""
        names = [one.name for one in self.relays if one.site == site]
        with Session(self._engine) as session, session.begin():
            for name in names[:number]:
                place = locked_place(session, AlarmPlace(relay=name))
                raised_at(session, place, AlarmSpec(kind, "why"), now_ns=self.ns(at_s))

    def clear(self, site: str, number: int, at_s: float) -> None:
        names = [one.name for one in self.relays if one.site == site][:number]
        with Session(self._engine) as session, session.begin():
            clear(session, self.ns(at_s), AlarmRow.ied.in_(names))

    def gather(self, at_s: float) -> None:
        began_s = time.monotonic()
        self.repository.gather_floods(MOST, now_ns=self.ns(at_s))
        log.info("gathered", at_s=at_s, lasted_s=time.monotonic() - began_s)
        while self.repository.end_suppressions(now_ns=self.ns(at_s)):
            pass

    def calling(self) -> list[Alarm]:
        found = self.repository.open_alarms(limit=5000).items
        return [alarm for alarm in found if alarm.state is CALLS]

    @staticmethod
    def ns(at_s: float) -> int:
        return NOW_NS + round(at_s * SECOND_NS)


@pytest.fixture
def few(engine: Engine, repository: Repository) -> Floods:
    return Floods(engine, repository, 30)


def test_as_many_as_can_be_read_are_told_one_by_one(few: Floods) -> None:
    few.raise_alarms(AlarmKind.FILE_REFUSED, "E", MOST)
    few.raise_alarms(AlarmKind.LINK_DOWN, "W", MOST)
    few.gather(5.0)
    assert len(few.calling()) == 2 * MOST


def test_a_flood_is_one_line_with_the_number_and_kinds_and_ends_by_itself(few: Floods) -> None:
    few.raise_alarms(AlarmKind.FILE_REFUSED, "E", 30)
    few.raise_alarms(AlarmKind.DAILY_LIMIT, "E", 12, at_s=20.0)
    few.raise_alarms(AlarmKind.LINK_DOWN, "E", 3, at_s=20.0)  # of another priority
    few.gather(21.0)
    told = few.calling()
    assert Counter(alarm.kind for alarm in told) == {AlarmKind.LINK_DOWN: 3, AlarmKind.ALARM_FLOOD: 1}
    (flood,) = [alarm for alarm in told if alarm.kind is AlarmKind.ALARM_FLOOD]
    assert (flood.site, flood.subject, flood.priority) == ("E", "low alarms", AlarmPriority.LOW)
    assert flood.reason == "42 alarms at once: 30 file-refused, 12 daily-limit; 42 of them stand"
    few.raise_alarms(AlarmKind.TIME_ZONE, "E", 5, at_s=70.0)  # it goes on
    few.gather(71.0)
    assert len(few.calling()) == 4
    few.clear("E", 27, at_s=200.0)
    few.gather(201.0)
    assert few.repository.alarm(flood.id).standing is False
    left = [alarm for alarm in few.calling() if alarm.kind is AlarmKind.FILE_REFUSED]
    assert {alarm.ied for alarm in left} == {"E0027", "E0028", "E0029"}
    assert len(few.calling()) == 3


def test_an_urgent_alarm_is_never_hidden_by_minor_ones(few: Floods) -> None:
    few.raise_alarms(AlarmKind.FILE_REFUSED, "E", 30)
    fault = AlarmSpec(AlarmKind.CONDITION_FAULT, "shorted turns", "shorted turns in phase b")
    few.repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), fault, now_ns=NOW_NS)
    few.gather(1.0)
    assert [alarm.kind for alarm in few.calling()] == [AlarmKind.CONDITION_FAULT, AlarmKind.ALARM_FLOOD]


def test_what_people_have_seen_is_left_to_them(few: Floods) -> None:
    few.raise_alarms(AlarmKind.FILE_REFUSED, "E", 30)
    few.clear("E", 25, at_s=1.0)
    few.gather(2.0)
    few.gather(65.0)  # five stand: each is told
    assert len(few.calling()) == 5
    assert few.repository.alarms(limit=100, relay="E0000").items[0].state is AlarmState.NORMAL


@pytest.mark.parametrize("number", [15, pytest.param(500, marks=pytest.mark.campaign)])
def test_a_thousand_alarms_of_two_sites_in_a_minute_are_one_line_each(
    engine: Engine, repository: Repository, number: int
) -> None:
    """docs/reference/alarms.md has the times of the thousand."""
    many = Floods(engine, repository, number)
    for site in "EW":
        many.raise_alarms(AlarmKind.FILE_UNSTEADY, site, number, at_s=30.0)
    many.gather(59.0)
    assert {alarm.site for alarm in many.calling()} == {"E", "W"}
    assert len(many.calling()) == 2
    many.gather(64.0)
    assert len(many.calling()) == 2
