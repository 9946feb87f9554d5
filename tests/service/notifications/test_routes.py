"""Which routes tell what to whom, at which hours."""

from datetime import datetime
from typing import Any
from zoneinfo import ZoneInfo

import pytest

from core.units import NANOSECONDS_PER_SECOND
from service.configuration.notifications import Digest, NotificationSettings
from service.notifications.due import latest_due
from service.notifications.routes import targets
from service.notifications.silent_claims import SilentClaims
from service.storage.records import NotificationTarget, Occurrence
from service.storage.states import AlarmPriority, NotifiedEvent

BERLIN = ZoneInfo("Europe/Berlin")
MINUTE_NS = 60 * NANOSECONDS_PER_SECOND


def settings(*routes: dict[str, Any], zone: str = "Europe/Berlin") -> NotificationSettings:
    syslog = {"kind": "syslog", "host": "siem"}
    channels = {"ops": syslog, "chief": syslog}
    mail = {"kind": "mail", "host": "mail", "from": "a@b.example", "to": ["c@d.example", "e@f.example"]}
    table = {"time_zone": zone, "channels": {**channels, "mail": mail}, "routes": list(routes)}
    return NotificationSettings.model_validate(table)


def occurrence(
    event: NotifiedEvent = NotifiedEvent.RAISED,
    site: str | None = "NORTH",
    priority: AlarmPriority = AlarmPriority.HIGH,
    kind: str = "condition-watch",
) -> Occurrence:
    return Occurrence(event, site, priority, kind)


def ns(*when: int, zone: ZoneInfo = BERLIN) -> int:
    year, month, day, hour, minute = when
    at = datetime(year, month, day, hour, minute, tzinfo=zone)
    return round(at.timestamp()) * NANOSECONDS_PER_SECOND


NOON = ns(2026, 11, 23, 12, 0)
"""A Monday."""


def told(wanted: NotificationSettings, now_ns: int = NOON, **what: Any) -> list[str]:
    return [target.channel for target in targets(wanted, occurrence(**what), now_ns)]


@pytest.mark.parametrize(
    ("route", "what", "is_told"),
    [
        ({}, {}, True),
        ({"sites": ["NORTH"]}, {}, True),
        ({"sites": ["SOUTH"]}, {}, False),
        ({"sites": ["NORTH"]}, {"site": None}, False),
        ({}, {"site": None}, True),
        ({"sites": ["NORTH"]}, {"site": None, "kind": "alarm-flood"}, True),
        ({"priorities": ["critical", "high"]}, {}, True),
        ({"priorities": ["critical"]}, {}, False),
        ({"kinds": ["condition-watch"]}, {}, True),
        ({"kinds": ["link-down"]}, {}, False),
        ({}, {"event": NotifiedEvent.CLEARED}, False),
        ({"events": ["cleared"]}, {"event": NotifiedEvent.CLEARED}, True),
        ({"events": ["cleared"]}, {}, False),
    ],
)
def test_a_route_takes_what_fits_all_that_it_asks_for(
    route: dict[str, Any], what: dict[str, Any], is_told: bool
) -> None:
    assert told(settings({"channels": ["ops"], **route}), **what) == (["ops"] if is_told else [])


@pytest.mark.parametrize(
    ("hours", "when", "is_told"),
    [
        ({"from": "08:00", "until": "16:00"}, (2026, 11, 23, 8, 0), True),
        ({"from": "08:00", "until": "16:00"}, (2026, 11, 23, 16, 0), False),
        ({"from": "22:00", "until": "06:00"}, (2026, 11, 23, 23, 0), True),
        ({"from": "22:00", "until": "06:00"}, (2026, 11, 24, 5, 59), True),
        ({"from": "22:00", "until": "06:00"}, (2026, 11, 24, 6, 0), False),
        # The night of Friday goes on into Saturday; that of Saturday is not asked for.
        ({"days": ["fri"], "from": "22:00", "until": "06:00"}, (2026, 11, 28, 3, 0), True),
        ({"days": ["fri"], "from": "22:00", "until": "06:00"}, (2026, 11, 29, 3, 0), False),
        ({"days": ["sat", "sun"]}, (2026, 11, 28, 0, 0), True),
        ({"days": ["sat", "sun"]}, (2026, 11, 30, 0, 0), False),
        # The clocks go back on 25 October: this hour comes twice, and both are within.
        ({"from": "02:00", "until": "03:00"}, (2026, 10, 25, 2, 30), True),
    ],
)
def test_hours_are_those_of_the_zone(hours: dict[str, Any], when: tuple[int, ...], is_told: bool) -> None:
    assert told(settings({"channels": ["ops"], **hours}), ns(*when)) == (["ops"] if is_told else [])


def test_the_hour_that_comes_twice_is_within_both_times() -> None:
    wanted = settings({"channels": ["ops"], "from": "02:00", "until": "03:00"})
    first_ns = ns(2026, 10, 25, 2, 30)
    assert told(wanted, first_ns) == told(wanted, first_ns + 60 * MINUTE_NS) == ["ops"]
    assert told(wanted, first_ns + 120 * MINUTE_NS) == []


def test_what_may_wait_is_told_when_the_hours_begin() -> None:
    wanted = settings(
        {
            "channels": ["ops"],
            "days": ["mon", "tue", "wed", "thu", "fri"],
            "from": "08:00",
            "until": "16:00",
            "outside_hours": "wait",
            "escalations": [{"after_min": 30, "channels": ["chief"]}],
        }
    )
    friday_evening, monday = ns(2026, 11, 27, 20, 0), ns(2026, 11, 30, 8, 0)
    assert targets(wanted, occurrence(), friday_evening) == [
        NotificationTarget("ops", "", 0, monday),
        NotificationTarget("chief", "", 30 * MINUTE_NS, monday),
    ]
    assert targets(wanted, occurrence(NotifiedEvent.CLEARED), friday_evening) == []
    assert targets(wanted, occurrence(), monday)[0].held_until_ns is None


def test_each_receiver_is_told_once_and_each_address_for_itself() -> None:
    later = {"channels": ["mail"], "from": "20:00", "until": "21:00", "outside_hours": "wait"}
    wanted = settings(later, {"channels": ["mail", "ops"]}, {"channels": ["ops"]})
    assert [
        (one.channel, one.recipient, one.held_until_ns) for one in targets(wanted, occurrence(), NOON)
    ] == [
        ("mail", "c@d.example", None),
        ("mail", "e@f.example", None),
        ("ops", "", None),
    ]


def test_what_is_over_escalates_nothing() -> None:
    escalations = [{"after_min": 5, "channels": ["chief"]}]
    wanted = settings({"channels": ["ops"], "events": ["raised", "cleared"], "escalations": escalations})
    assert told(wanted) == ["ops", "chief"]
    assert told(wanted, event=NotifiedEvent.CLEARED) == ["ops"]


def test_digests_are_due_each_day_or_once_a_week() -> None:
    table = {"channels": ["ops"], "at": "07:00"}
    daily = Digest.model_validate({**table, "period": "daily"})
    weekly = Digest.model_validate({**table, "period": "weekly", "day": "fri"})
    monday = datetime(2026, 11, 23, 6, 59, tzinfo=BERLIN)
    assert latest_due(daily, monday) == datetime(2026, 11, 22, 7, 0, tzinfo=BERLIN)
    assert latest_due(weekly, monday) == datetime(2026, 11, 20, 7, 0, tzinfo=BERLIN)
    assert latest_due(daily, monday.replace(hour=7, minute=0)).day == 23


def test_a_claim_that_stands_still_for_too_long_is_of_the_dead() -> None:
    silent = SilentClaims(90.0)
    assert silent.among({"m1": "a", "m2": "b"}, 0) == set()
    # The second message was taken anew meanwhile: somebody lives.
    assert silent.among({"m1": "a", "m2": "c"}, 91 * NANOSECONDS_PER_SECOND) == {"a"}
    assert silent.among({"m1": "a", "m2": "c"}, 10**15) == {"a", "c"}
