"""A link that is down for long, and a site that is lost: one line, whose members return with the site."""

import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import structlog
from sqlalchemy import Engine, insert, update

from service.alarms.kinds import AlarmKind
from service.background.alarm_sources.links import MOST_A_LOOK, LinkSource
from service.background.alarm_sources.worker import AlarmSources
from service.configuration.settings import Settings
from service.plant import Plant, Site
from service.storage import Repository
from service.storage.models import IedRow, LinkChangeRow
from service.storage.records import Alarm
from service.storage.states import AlarmState, LinkState
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS, relay, two_motor_plant

CALLS = AlarmState.UNACKNOWLEDGED

BACK_NS = NOW_NS + 800 * SECOND_NS

log = structlog.get_logger(__name__)


class Site40:
    """A site of 40 relays, and two relays elsewhere; times in seconds from NOW_NS."""

    def __init__(self, repository: Repository, directory: Path) -> None:
        self.repository = repository
        plant = two_motor_plant()
        here = tuple(relay(f"R{number:02}", "WEST", 11000 + number) for number in range(40))
        repository.sync_plant(
            Plant((*plant.sites, Site("WEST", "West")), (*plant.relays, *here), plant.motors)
        )
        self.source = LinkSource(Settings(data_directory=directory), repository, started_ns=0)
        self.relays = [one.name for one in here]
        for name in (*self.relays, "A1_SEL710", "A2_SEL710"):
            self.set(name, LinkState.UP, -1000.0)

    def set(self, name: str, state: LinkState, at_s: float) -> None:
        reason = None if state is LinkState.UP else "connection refused"
        set_link_state(self.repository, name, state, reason, now_ns=self.ns(at_s))

    def look(self, at_s: float) -> None:
        self.source.look(self.ns(at_s))
        while self.repository.end_suppressions(now_ns=self.ns(at_s)):
            pass

    def standing(self, state: AlarmState | None = None) -> list[Alarm]:
        found = self.repository.alarms(limit=1000, standing=True).items
        return [alarm for alarm in found if state is None or alarm.state is state]

    def calling(self) -> Counter[AlarmKind]:
        return Counter(alarm.kind for alarm in self.standing(AlarmState.UNACKNOWLEDGED))

    @staticmethod
    def ns(at_s: float) -> int:
        return NOW_NS + round(at_s * SECOND_NS)


@pytest.fixture
def site(repository: Repository, tmp_path: Path) -> Site40:
    return Site40(repository, tmp_path)


def test_a_link_that_is_down_for_long_is_told_until_it_is_up_for_a_minute(site: Site40) -> None:
    site.set("R00", LinkState.DOWN, 0.0)
    site.look(599.0)
    assert site.standing() == []
    site.look(600.0)
    (alarm,) = site.standing()
    assert (alarm.kind, alarm.ied, alarm.site) == (AlarmKind.LINK_DOWN, "R00", "WEST")
    assert alarm.reason == "down since 2025-10-09T08:53:20Z; connection refused"
    site.set("R00", LinkState.UP, 700.0)
    site.look(759.0)
    assert site.standing() == [alarm]
    site.look(760.0)
    assert site.standing() == []
    site.look(761.0)
    assert site.repository.alarm(alarm.id).raises == 1


def test_a_link_that_flaps_is_down_and_does_not_chatter(site: Site40) -> None:
    for at_s in range(0, 3600, 100):
        site.set("R00", LinkState.DOWN, at_s)
        site.look(at_s + 89.0)
        site.set("R00", LinkState.UP, at_s + 90.0)
        site.look(at_s + 99.0)
    (alarm,) = site.standing()
    assert alarm.raises == 1
    assert len(site.repository.alarm_changes(alarm.id, limit=10).items) == 1


def test_a_service_that_starts_anew_does_not_count_from_the_beginning(site: Site40) -> None:
    site.set("R00", LinkState.DOWN, 0.0)
    site.repository.reset_links(now_ns=site.ns(590.0))
    site.look(595.0)
    assert site.standing() == []  # all the others are unknown for a moment, and no site is lost
    site.set("R00", LinkState.DOWN, 598.0)
    for name in site.relays[1:]:
        site.set(name, LinkState.UP, 599.0)
    site.look(600.0)
    assert [alarm.ied for alarm in site.standing()] == ["R00"]


def test_a_quarantine_is_an_alarm_of_its_own(site: Site40) -> None:
    site.set("R00", LinkState.QUARANTINED, 0.0)
    site.look(1000.0)
    assert site.standing() == []


def test_a_relay_that_leaves_the_plant_has_no_alarm(site: Site40) -> None:
    site.set("R00", LinkState.DOWN, 0.0)
    site.look(600.0)
    site.repository.sync_plant(two_motor_plant())
    site.look(601.0)
    assert site.standing() == []


def test_a_site_that_is_lost_is_one_line_and_its_members_return_when_it_is_back(site: Site40) -> None:
    site.set("R39", LinkState.DOWN, -700.0)
    site.look(-50.0)
    assert site.calling() == {AlarmKind.LINK_DOWN: 1}  # it was told long before
    for number, name in enumerate(site.relays[:38]):
        site.set(name, LinkState.DOWN, number)
    site.look(40.0)
    assert site.calling() == {AlarmKind.LINK_DOWN: 1}  # a switch may only restart
    site.look(70.0)
    lost = next(alarm for alarm in site.standing() if alarm.kind is AlarmKind.SITE_LOST)
    assert (lost.site, lost.ied, lost.reason) == ("WEST", None, "39 of 40 relays do not answer")
    site.look(900.0)
    assert site.calling() == {AlarmKind.LINK_DOWN: 1, AlarmKind.SITE_LOST: 1}
    assert len(site.standing(AlarmState.SUPPRESSED)) == 38
    for name in site.relays[:36]:
        site.set(name, LinkState.UP, 1000.0)
    site.look(1059.0)
    assert AlarmKind.SITE_LOST in site.calling()
    site.look(1060.0)
    assert {alarm.ied for alarm in site.standing()} == {"R36", "R37", "R39"}
    assert site.calling() == {AlarmKind.LINK_DOWN: 3}
    assert site.repository.alarm(lost.id).cleared_ns == site.ns(1060.0)
    called = [
        change
        for alarm in site.repository.alarms(limit=1000, relay="R00").items
        for change in site.repository.alarm_changes(alarm.id, limit=10).items
        if change.after is AlarmState.UNACKNOWLEDGED
    ]
    assert called == []


def test_the_time_in_which_the_service_was_off_is_nobodys_outage(site: Site40, tmp_path: Path) -> None:
    site.repository.reset_links(now_ns=site.ns(0.0))
    site.source = LinkSource(Settings(data_directory=tmp_path), site.repository, started_ns=site.ns(5000.0))
    site.look(5010.0)
    assert site.standing() == []
    for name in site.relays[1:]:
        site.set(name, LinkState.UP, 5020.0)
    site.look(5605.0)
    told = {alarm.ied: alarm.reason for alarm in site.standing()}
    assert set(told) == {"R00", "A1_SEL710", "A2_SEL710"}
    assert told["R00"].startswith("down since 2025-10-09T08:53:20Z")


def test_a_site_that_goes_down_relay_by_relay_is_told_relay_by_relay(site: Site40) -> None:
    for number, name in enumerate(site.relays):
        site.set(name, LinkState.DOWN, 200.0 * number)
    site.look(40 * 200.0 + 600.0)
    assert site.calling() == {AlarmKind.LINK_DOWN: 40}


def test_two_services_on_one_database_raise_each_alarm_once(site: Site40, tmp_path: Path) -> None:
    other = LinkSource(Settings(data_directory=tmp_path), site.repository, started_ns=0)
    for name in site.relays[:5]:
        site.set(name, LinkState.DOWN, 0.0)
    for at_s in (600.0, 605.0):
        site.look(at_s)
        other.look(site.ns(at_s))
    assert site.calling() == {AlarmKind.LINK_DOWN: 5}
    assert all(alarm.raises == 1 for alarm in site.standing())


def test_services_that_look_at_the_same_time_raise_and_clear_each_alarm_once(
    engine: Engine, site: Site40, tmp_path: Path
) -> None:
    settings = Settings(data_directory=tmp_path)
    services = [
        AlarmSources(settings, Repository(engine), [], started_ns=NOW_NS, slow_period_s=0.0) for _ in range(3)
    ]

    def look(at_s: float) -> None:
        with ThreadPoolExecutor(len(services)) as threads:
            now_ns = site.ns(at_s)
            for done in [threads.submit(one.look, now_ns, now_ns) for one in services]:
                done.result()

    for name in ("A1_SEL710", "R00", "R01", "R02"):
        site.set(name, LinkState.DOWN, 0.0)
    look(600.0)
    assert site.calling() == {AlarmKind.LINK_DOWN: 4}
    for name in site.relays[3:]:
        site.set(name, LinkState.DOWN, 700.0)
    look(800.0)
    assert site.calling() == {AlarmKind.LINK_DOWN: 4, AlarmKind.SITE_LOST: 1}
    look(1400.0)
    assert len(site.standing(AlarmState.SUPPRESSED)) == 37
    for name in site.relays:
        site.set(name, LinkState.UP, 1500.0)
    look(1600.0)
    assert site.calling() == {AlarmKind.LINK_DOWN: 1}
    for alarm in site.repository.alarms(limit=1000).items:
        events = [one.event for one in site.repository.alarm_changes(alarm.id, limit=100).items]
        assert len(events) == len(set(events)), (alarm.kind, events)
    assert len(site.repository.alarms(limit=1000).items) == 42


@pytest.mark.parametrize("number", [40, pytest.param(1000, marks=pytest.mark.campaign)])
def test_a_thousand_relays_that_are_lost_are_one_line(
    engine: Engine, repository: Repository, tmp_path: Path, number: int
) -> None:
    """docs/reference/alarms.md has the times of the thousand."""
    plant = two_motor_plant()
    many = tuple(relay(f"R{one:04}", "WEST", 11000 + one) for one in range(number))
    repository.sync_plant(Plant((*plant.sites, Site("WEST", "West")), (*plant.relays, *many), plant.motors))
    changes = [
        {"id": f"{one.name} {state}", "ied": one.name, "changed_ns": at_ns, "state": state, "reason": None}
        for at, one in enumerate(many)
        for at_ns, state in (
            (NOW_NS - 10**15, LinkState.UP),
            (NOW_NS + at * 50 * SECOND_NS // number, LinkState.DOWN),
        )
    ]
    with engine.begin() as connection:
        connection.execute(insert(LinkChangeRow), changes)
        of_site = update(IedRow).where(IedRow.site == "WEST")
        connection.execute(of_site.values(link_state=LinkState.DOWN))
    sources = AlarmSources(
        Settings(data_directory=tmp_path), repository, [tmp_path], started_ns=NOW_NS, slow_period_s=1e9
    )
    line = (AlarmKind.SITE_LOST, f"{number} of {number} relays do not answer")
    rounds = range(0, number, MOST_A_LOOK)
    for at_s in (85.0, 90.0, *(700.0 + at for at in range(len(rounds) + 1))):
        lasted_s = look(sources, at_s)
        calling = repository.open_alarms(limit=10).items
        assert [(alarm.kind, alarm.reason) for alarm in calling if alarm.state is CALLS] == [line]
        assert lasted_s < 20.0
    began_s = time.monotonic()
    assert repository.end_suppressions(now_ns=NOW_NS + 706 * SECOND_NS) == 0
    log.info("looked at what is suppressed", lasted_s=time.monotonic() - began_s)
    with engine.begin() as connection:
        back = {"changed_ns": BACK_NS, "state": LinkState.UP, "reason": None}
        connection.execute(
            insert(LinkChangeRow), [{"id": f"{one.name} 2", "ied": one.name, **back} for one in many]
        )
        connection.execute(of_site.values(link_state=LinkState.UP, link_changed_ns=BACK_NS))
    for _ in rounds:
        look(sources, 900.0)
        assert AlarmKind.LINK_DOWN not in {
            alarm.kind for alarm in repository.open_alarms(limit=10).items if alarm.state is CALLS
        }
    while repository.end_suppressions(now_ns=NOW_NS + 901 * SECOND_NS):
        pass
    assert repository.alarms(limit=10, standing=True).items == ()
    assert [alarm.kind for alarm in repository.open_alarms(limit=10).items] == [AlarmKind.SITE_LOST]


def look(sources: AlarmSources, at_s: float) -> float:
    """Look at a time, and return how long that took [s]."""
    began_s = time.monotonic()
    sources.look(NOW_NS + round(at_s * SECOND_NS), round(at_s * SECOND_NS))
    lasted_s = time.monotonic() - began_s
    log.info("looked", at_s=at_s, lasted_s=lasted_s)
    return lasted_s
