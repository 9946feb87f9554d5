from dataclasses import replace

import pytest

from service.storage import NotFoundError, Repository
from service.storage.states import AlarmKind, LinkState
from testing.service.plants import NOW_NS, two_motor_plant


def test_the_tables_follow_the_plant(repository: Repository) -> None:
    plant = two_motor_plant()
    smaller = replace(
        plant, relays=(replace(plant.relays[0], host="10.0.0.7", port=102),), motors=plant.motors[:1]
    )
    repository.save_entry_id("A1_SEL710", b"\x01\x02")
    repository.sync_plant(smaller)

    assert [site.name for site in repository.sites(limit=10).items] == ["FACTORY_A"]
    assert [ied.name for ied in repository.ieds(limit=10).items] == ["A1_SEL710"]
    assert [motor.name for motor in repository.motors(limit=10).items] == ["PUMP-A1"]
    assert (repository.ied("A1_SEL710").host, repository.ied("A1_SEL710").port) == ("10.0.0.7", 102)
    assert repository.entry_id("A1_SEL710") == b"\x01\x02"
    assert repository.motor("FAN-A2").site == "FACTORY_A", "a motor out of service keeps its history"

    repository.sync_plant(plant)
    assert len(repository.motors(limit=10).items) == 2


def test_only_so_much_history_is_kept(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.storage.repository.links.MOST_CHANGES", 5)
    monkeypatch.setattr("service.storage.repository.alarms.MOST_CLEARED", 2)
    for number in range(9):
        repository.set_link_state("A1_SEL710", LinkState.DOWN, f"reason {number}", now_ns=NOW_NS + number)
        alarm = repository.raise_alarm(
            "A1_SEL710", AlarmKind.FILE_REFUSED, f"{number}", "bad", now_ns=NOW_NS + number
        )
        repository.clear_alarms("A1_SEL710", [alarm.id], now_ns=NOW_NS + number)
    repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, "stands", "bad", now_ns=NOW_NS)
    changes = repository.link_changes("A1_SEL710", limit=100).items
    assert [change.reason for change in changes] == [f"reason {number}" for number in (8, 7, 6, 5, 4)]
    alarms = repository.alarms(limit=100).items
    assert [alarm.subject for alarm in alarms] == ["8", "7", "stands"]


def test_links_change_state_with_a_reason(repository: Repository) -> None:
    assert repository.ied("A1_SEL710").link_state is LinkState.UNKNOWN
    repository.set_link_state("A1_SEL710", LinkState.UP, None, now_ns=NOW_NS)
    repository.set_link_state("A1_SEL710", LinkState.UP, None, now_ns=NOW_NS + 1)
    up = repository.ied("A1_SEL710")
    assert (up.link_changed_ns, up.last_success_ns) == (NOW_NS, NOW_NS + 1)
    repository.set_link_state("A1_SEL710", LinkState.DOWN, "connection refused", now_ns=NOW_NS + 2)
    down = repository.ied("A1_SEL710")
    assert (down.link_reason, down.link_changed_ns, down.last_success_ns) == (
        "connection refused",
        NOW_NS + 2,
        NOW_NS + 1,
    )
    repository.reset_links(now_ns=NOW_NS + 3)
    assert repository.ied("A1_SEL710").link_state is LinkState.UNKNOWN
    with pytest.raises(NotFoundError):
        repository.set_link_state("X", LinkState.UP, None, now_ns=NOW_NS)
