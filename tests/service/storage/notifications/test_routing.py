"""What happens to alarms becomes messages: each once, gathered, and with nothing lost. On both databases."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from service.roles import Role
from service.storage import Repository
from service.storage.records import (
    AlarmPlace,
    AlarmSpec,
    Gathering,
    Notification,
    NotificationTarget,
    Occurrence,
)
from service.storage.records.actors import Actor
from service.storage.states import AlarmKind, NotificationKind, NotificationState, NotifiedEvent
from testing.service.plants import NOW_NS, SECOND_NS

ANN = Actor("ann", "command line", frozenset({Role.OPERATOR}))

Decide = Callable[[Occurrence], Sequence[NotificationTarget]]

GATHERING = Gathering(gather_ns=10 * SECOND_NS, pause_ns=60 * SECOND_NS)
MINUTE_NS = 60 * SECOND_NS
CALLS = (NotifiedEvent.RAISED, NotifiedEvent.REOPENED)


def everything(_occurrence: Occurrence) -> Sequence[NotificationTarget]:
    return [NotificationTarget("ops", "shift@plant.example")]


def calls(occurrence: Occurrence) -> Sequence[NotificationTarget]:
    return everything(occurrence) if occurrence.event in CALLS else ()


def escalating(occurrence: Occurrence) -> Sequence[NotificationTarget]:
    return [NotificationTarget("chief", "", 30 * MINUTE_NS)] if occurrence.event in CALLS else ()


def route(repository: Repository, now_ns: int = NOW_NS, decide: Decide = calls) -> int:
    return repository.route_alarm_changes(decide, GATHERING, now_ns=now_ns)


def raise_alarm(repository: Repository, subject: str = "", now_ns: int = NOW_NS) -> str:
    place, spec = AlarmPlace(relay="A1_SEL710"), AlarmSpec(AlarmKind.FILE_REFUSED, "odd name", subject)
    return repository.raise_alarm_at(place, spec, now_ns=now_ns).id


def taken(repository: Repository, now_ns: int, channel: str = "ops") -> Notification | None:
    return repository.claim_notification(channel, claim=f"a {now_ns}", now_ns=now_ns)


def document(notification: Notification | None) -> dict[str, Any]:
    assert notification is not None
    assert notification.document is not None
    return dict(notification.document)


def test_alarms_that_come_together_are_one_message(repository: Repository) -> None:
    first = raise_alarm(repository, "a")
    assert route(repository) == 1
    second = raise_alarm(repository, "b")
    assert route(repository, NOW_NS + 9 * SECOND_NS) == 1
    assert taken(repository, NOW_NS + 9 * SECOND_NS) is None, "it waits for more"
    told = document(taken(repository, NOW_NS + 10 * SECOND_NS))
    assert {alarm["id"] for alarm in told["alarms"]} == {first, second}
    assert told["number"] == 2
    assert route(repository) == 0, "nothing is told twice"
    (listed,) = repository.notifications(limit=10, alarm=second).items
    assert listed.recipient == "shift@plant.example"


def test_the_next_message_to_the_same_receiver_waits_for_the_pause(repository: Repository) -> None:
    raise_alarm(repository, "a")
    route(repository)
    assert taken(repository, NOW_NS + 10 * SECOND_NS)
    raise_alarm(repository, "b")
    route(repository, NOW_NS + 11 * SECOND_NS)
    assert taken(repository, NOW_NS + 69 * SECOND_NS) is None
    assert taken(repository, NOW_NS + 70 * SECOND_NS)


def test_a_thousand_alarms_are_one_message_of_bearable_size(repository: Repository) -> None:
    for number in range(60):
        raise_alarm(repository, f"file {number}")
    while route(repository):
        pass
    told = document(taken(repository, NOW_NS + 10 * SECOND_NS))
    assert told["number"] == 60
    assert told["counts"] == [{"event": "raised", "kind": "file-refused", "number": 60}]
    assert len(told["alarms"]) == 50
    assert taken(repository, NOW_NS + 10**15) is None


def test_a_flood_is_one_line(repository: Repository) -> None:
    for number in range(30):
        raise_alarm(repository, f"file {number}")
    route(repository)
    assert repository.gather_floods(10, now_ns=NOW_NS + 5 * SECOND_NS) == 1
    route(repository, NOW_NS + 6 * SECOND_NS)
    told = document(taken(repository, NOW_NS + 10 * SECOND_NS))
    (line,) = told["alarms"]
    assert (told["number"], line["kind"], line["site"]) == (1, "alarm-flood", "FACTORY_A")
    assert line["reason"].startswith("30 alarms")


def test_services_that_look_at_once_tell_each_alarm_once(repository: Repository) -> None:
    for number in range(40):
        raise_alarm(repository, f"file {number}")
    with ThreadPoolExecutor(4) as threads:
        seen = list(threads.map(lambda _: route(repository), range(8)))
    assert sum(seen) == 40
    told = document(taken(repository, NOW_NS + 10 * SECOND_NS))
    assert told["number"] == 40
    assert len(repository.notifications(limit=10).items) == 1


def test_an_alarm_that_is_over_before_the_message_goes_is_told_as_such(repository: Repository) -> None:
    alarm = raise_alarm(repository)
    repository.clear_alarms("A1_SEL710", [alarm], now_ns=NOW_NS)
    route(repository)
    told = document(taken(repository, NOW_NS + 10 * SECOND_NS))
    assert [(one["event"], one["standing"]) for one in told["alarms"]] == [("raised", False)]


def test_an_alarm_that_another_one_tells_is_not_told(repository: Repository) -> None:
    watch, fault = raise_alarm(repository, "watch"), raise_alarm(repository, "fault")
    repository.supersede_alarm(watch, fault, now_ns=NOW_NS)
    route(repository, decide=everything)
    told = document(taken(repository, NOW_NS + 10 * SECOND_NS))
    assert [(one["id"], one["event"]) for one in told["alarms"]] == [(fault, "raised")]


def test_with_nothing_left_to_tell_the_message_is_withdrawn(repository: Repository) -> None:
    alarm = raise_alarm(repository)
    route(repository)
    repository.acknowledge_alarm(alarm, by=ANN, now_ns=NOW_NS)
    repository.clear_alarms("A1_SEL710", [alarm], now_ns=NOW_NS)
    assert taken(repository, NOW_NS + 10 * SECOND_NS) is None
    (withdrawn,) = repository.notifications(limit=10).items
    assert withdrawn.state is NotificationState.WITHDRAWN
    assert withdrawn.attempts == 0


def test_who_is_told_of_what_is_over_and_known_is_told_by_whom(repository: Repository) -> None:
    alarm = raise_alarm(repository)
    repository.acknowledge_alarm(alarm, by=ANN, comment="on my way", now_ns=NOW_NS)
    repository.clear_alarms("A1_SEL710", [alarm], now_ns=NOW_NS + 1)
    route(repository, decide=lambda occurrence: () if occurrence.event in CALLS else everything(occurrence))
    told = document(taken(repository, NOW_NS + 10 * SECOND_NS))
    assert [one["event"] for one in told["alarms"]] == ["cleared"], "the latest that happened"


def test_an_alarm_that_comes_and_goes_calls_once_an_hour(repository: Repository) -> None:
    times_ns = [NOW_NS + minutes * MINUTE_NS for minutes in (0, 5, 10, 90)]
    messages = []
    for now_ns in times_ns:
        alarm = raise_alarm(repository, now_ns=now_ns)
        route(repository, now_ns)
        messages.append(taken(repository, now_ns + 60 * SECOND_NS))
        repository.clear_alarms("A1_SEL710", [alarm], now_ns=now_ns + MINUTE_NS)
    assert [message is not None for message in messages] == [True, False, False, True]


def test_an_escalation_comes_when_nobody_has_acknowledged(repository: Repository) -> None:
    raise_alarm(repository)
    route(repository, decide=escalating)
    due_ns = NOW_NS + 30 * MINUTE_NS + 10 * SECOND_NS
    assert taken(repository, due_ns - 1, "chief") is None
    escalation = taken(repository, due_ns, "chief")
    assert escalation is not None
    assert escalation.kind is NotificationKind.ESCALATION
    assert document(escalation)["number"] == 1


def test_an_acknowledgement_silences_the_escalation(repository: Repository) -> None:
    alarm = raise_alarm(repository)
    route(repository, decide=escalating)
    repository.acknowledge_alarm(alarm, by=ANN, now_ns=NOW_NS + MINUTE_NS)
    assert taken(repository, NOW_NS + 31 * MINUTE_NS, "chief") is None
    (withdrawn,) = repository.notifications(limit=10).items
    assert withdrawn.state is NotificationState.WITHDRAWN


def test_growth_escalates_anew(repository: Repository) -> None:
    alarm = raise_alarm(repository)
    route(repository, decide=escalating)
    repository.acknowledge_alarm(alarm, by=ANN, now_ns=NOW_NS + MINUTE_NS)
    assert repository.reopen_alarm(alarm, "it has grown", now_ns=NOW_NS + 2 * MINUTE_NS)
    route(repository, NOW_NS + 2 * MINUTE_NS, decide=escalating)
    # The first one is due, and the alarm calls: nobody has acknowledged it since it grew.
    assert taken(repository, NOW_NS + 33 * MINUTE_NS, "chief")


def test_an_escalation_waits_for_a_cause_that_comes_and_goes(repository: Repository) -> None:
    alarm = raise_alarm(repository)
    route(repository, decide=escalating)
    due_ns = NOW_NS + 31 * MINUTE_NS
    repository.clear_alarms("A1_SEL710", [alarm], now_ns=due_ns - 1)
    assert taken(repository, due_ns, "chief") is None
    assert raise_alarm(repository, now_ns=due_ns + 1) == alarm
    assert taken(repository, due_ns + 2, "chief") is None
    assert taken(repository, due_ns + MINUTE_NS, "chief")


def test_what_waits_for_its_hours_is_told_if_somebody_still_has_to_act(repository: Repository) -> None:
    held_ns = NOW_NS + 600 * MINUTE_NS

    def held(occurrence: Occurrence) -> Sequence[NotificationTarget]:
        return [NotificationTarget("ops", "", 0, held_ns)] if occurrence.event in CALLS else ()

    known, unknown = raise_alarm(repository, "known"), raise_alarm(repository, "unknown")
    route(repository, decide=held)
    repository.acknowledge_alarm(known, by=ANN, now_ns=NOW_NS)
    assert taken(repository, held_ns - 1) is None
    assert [one["id"] for one in document(taken(repository, held_ns))["alarms"]] == [unknown]
