from dataclasses import replace

import pytest
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from service.plant import Bus, Schedule
from service.storage import NotFoundError, Repository
from service.storage.models import AlarmRow, LinkChangeRow
from service.storage.records import ReportPosition
from service.storage.repository.alarms.causes import MOST_CLEARED
from service.storage.repository.relays.links import MOST_CHANGES
from service.storage.states import AlarmKind, AlarmPriority, AlarmState, LinkState
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, two_motor_plant

RELAY = "A1_SEL710"


def test_the_tables_follow_the_plant(repository: Repository) -> None:
    plant = two_motor_plant()
    smaller = replace(
        plant, relays=(replace(plant.relays[0], host="10.0.0.7", port=102),), motors=plant.motors[:1]
    )
    repository.save_report_positions([ReportPosition("A1_SEL710", b"\x01\x02", None)])
    repository.sync_plant(smaller)

    assert [site.name for site in repository.sites(limit=10).items] == ["FACTORY_A"]
    assert [ied.name for ied in repository.relays(limit=10).items] == ["A1_SEL710"]
    assert [motor.name for motor in repository.motors(limit=10).items] == ["PUMP-A1"]
    assert (repository.relay("A1_SEL710").host, repository.relay("A1_SEL710").port) == ("10.0.0.7", 102)
    assert repository.entry_id("A1_SEL710") == b"\x01\x02"
    assert repository.motor("FAN-A2").site == "FACTORY_A", "a motor out of service keeps its history"

    repository.sync_plant(plant)
    assert len(repository.motors(limit=10).items) == 2


def test_only_so_much_history_is_kept(repository: Repository, engine: Engine) -> None:
    fill_history(engine)
    for number in range(3):
        now_ns = NOW_NS + number
        set_link_state(repository, RELAY, LinkState.DOWN, f"reason {number}", now_ns=now_ns)
        alarm = repository.raise_alarm(RELAY, AlarmKind.FILE_REFUSED, f"file {number}", "bad", now_ns=now_ns)
        repository.clear_alarms(RELAY, [alarm.id], now_ns=now_ns)
    repository.raise_alarm(RELAY, AlarmKind.FILE_REFUSED, "stands", "bad", now_ns=NOW_NS)
    changes = repository.link_changes(RELAY, limit=2 * MOST_CHANGES).items
    assert len(changes) == MOST_CHANGES
    assert [each.reason for each in changes[:4]] == ["reason 2", "reason 1", "reason 0", "old 1"]
    cleared = [
        each for each in repository.alarms(limit=2 * MOST_CLEARED).items if each.cleared_ns is not None
    ]
    assert len(cleared) == MOST_CLEARED
    assert {"file 0", "file 1", "file 2", "old 1"} <= {each.subject for each in cleared}
    assert f"old {MOST_CLEARED}" not in {each.subject for each in cleared}
    assert [each.subject for each in repository.standing_alarms(RELAY)] == ["stands"]


def fill_history(engine: Engine) -> None:
    """As many changes of a link and alarms that are over as are kept; "old 1" is the latest."""
    with Session(engine) as session, session.begin():
        for age in range(1, MOST_CHANGES + 1):
            then_ns = NOW_NS - age
            change = {"ied": RELAY, "changed_ns": then_ns, "state": LinkState.UP, "reason": f"old {age}"}
            session.add(LinkChangeRow(id=f"change {age}", **change))
        for age in range(1, MOST_CLEARED + 1):
            then_ns = NOW_NS - age
            alarm = {"ied": RELAY, "kind": AlarmKind.FILE_REFUSED, "subject": f"old {age}", "reason": "bad"}
            times = {"raised_ns": then_ns, "cleared_ns": then_ns, "changed_ns": then_ns, "changed_by": "ann"}
            state = {"priority": AlarmPriority.LOW, "state": AlarmState.NORMAL, "urgency": 0, "raises": 1}
            session.add(AlarmRow(id=f"alarm {age}", **alarm, **times, **state))


def test_links_change_state_with_a_reason(repository: Repository) -> None:
    assert repository.relay("A1_SEL710").link_state is LinkState.UNKNOWN
    set_link_state(repository, "A1_SEL710", LinkState.UP, None, now_ns=NOW_NS)
    set_link_state(repository, "A1_SEL710", LinkState.UP, None, now_ns=NOW_NS + 1)
    up = repository.relay("A1_SEL710")
    assert (up.link_changed_ns, up.last_success_ns) == (NOW_NS, NOW_NS + 1)
    set_link_state(repository, "A1_SEL710", LinkState.DOWN, "connection refused", now_ns=NOW_NS + 2)
    down = repository.relay("A1_SEL710")
    assert (down.link_reason, down.link_changed_ns, down.last_success_ns) == (
        "connection refused",
        NOW_NS + 2,
        NOW_NS + 1,
    )
    repository.reset_links(now_ns=NOW_NS + 3)
    assert repository.relay("A1_SEL710").link_state is LinkState.UNKNOWN
    with pytest.raises(NotFoundError):
        set_link_state(repository, "X", LinkState.UP, None, now_ns=NOW_NS)


def test_a_motor_without_a_schedule_has_that_of_its_bus(repository: Repository) -> None:
    plant = two_motor_plant()
    pump, fan = plant.motors
    hourly, daily = Schedule.parse("0 * * * *"), Schedule.parse("0 6 * * *")
    bus = Bus("MCC-A", (pump.name, fan.name), hourly)
    motors = (replace(pump, bus=bus.name), replace(fan, bus=bus.name, schedule=daily))
    repository.sync_plant(replace(plant, motors=motors, buses=(bus,)))
    told = {one.name: one.schedule for one in repository.motors(limit=10).items}
    assert told == {pump.name: "0 * * * *", fan.name: "0 6 * * *"}
