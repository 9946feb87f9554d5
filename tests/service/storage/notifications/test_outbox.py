"""Messages that wait to be sent: taken once, tried again, given up, found after a kill. On both databases."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from service.roles import Role
from service.storage import Repository
from service.storage.errors import StateConflictError
from service.storage.records import NewNotification, Notification
from service.storage.records.actors import Actor
from service.storage.repository.notifications.outbox import INTERRUPTED
from service.storage.states import NotificationKind, NotificationState
from service.timing.backoff import Backoff
from testing.service.plants import NOW_NS, SECOND_NS

ANN = Actor("ann", "command line", frozenset({Role.ENGINEER}))
BACKOFF = Backoff(10.0, 3600.0)


def queue(repository: Repository, number: int = 1, channel: str = "ops") -> tuple[Notification, ...]:
    new = [
        NewNotification(NotificationKind.DIGEST, channel, f"{count}@plant.example", {"number": count})
        for count in range(number)
    ]
    return repository.add_notifications(new, now_ns=NOW_NS)


def claim(repository: Repository, word: str = "a 1", now_ns: int = NOW_NS) -> Notification:
    found = repository.claim_notification("ops", claim=word, now_ns=now_ns)
    assert found is not None
    return found


def fail(
    repository: Repository, of: str, word: str, now_ns: int, *, most: int = 3, final: bool = False
) -> object:
    return repository.fail_notification(
        of, "no answer", claim=word, now_ns=now_ns, most_attempts=most, backoff=BACKOFF, is_final=final
    )


def test_a_message_is_sent_once(repository: Repository) -> None:
    (queued,) = queue(repository)
    taken = claim(repository)
    assert (taken.id, taken.state, taken.attempts) == (queued.id, NotificationState.SENDING, 1)
    assert repository.claim_notification("ops", claim="b 1", now_ns=NOW_NS) is None
    assert repository.finish_notification(queued.id, claim="a 1", now_ns=NOW_NS + SECOND_NS)
    assert repository.claim_notification("ops", claim="b 2", now_ns=NOW_NS + 10**15) is None
    sent = repository.notification(queued.id)
    assert (sent.state, sent.finished_ns, sent.error) == (NotificationState.SENT, NOW_NS + SECOND_NS, None)


def test_another_channel_takes_nothing(repository: Repository) -> None:
    queue(repository, channel="siem")
    assert repository.claim_notification("ops", claim="a 1", now_ns=NOW_NS) is None


def test_attempts_follow_each_other_with_growing_pauses_until_the_message_is_given_up(
    repository: Repository,
) -> None:
    (queued,) = queue(repository)
    now_ns = NOW_NS
    for attempt, pause_s in enumerate((10, 20), start=1):
        word = f"a {attempt}"
        claim(repository, word, now_ns)
        assert fail(repository, queued.id, word, now_ns) is NotificationState.QUEUED
        early_ns = now_ns + pause_s * SECOND_NS - 1
        assert repository.claim_notification("ops", claim="b", now_ns=early_ns) is None
        now_ns = early_ns + 1
    claim(repository, "a 3", now_ns)
    assert fail(repository, queued.id, "a 3", now_ns) is NotificationState.DEAD
    dead = repository.notification(queued.id)
    assert (dead.error, dead.attempts, dead.finished_ns) == ("no answer", 3, now_ns)
    assert repository.waiting_notifications() == {("ops", NotificationState.DEAD): 1}
    again = repository.retry_notification(queued.id, by=ANN, now_ns=now_ns)
    assert (again.state, again.attempts) == (NotificationState.QUEUED, 0)
    with pytest.raises(StateConflictError):
        repository.retry_notification(queued.id, by=ANN, now_ns=now_ns)
    assert claim(repository, "a 4", now_ns).id == queued.id


def test_what_would_fail_again_is_given_up_at_once(repository: Repository) -> None:
    (queued,) = queue(repository)
    claim(repository)
    assert fail(repository, queued.id, "a 1", NOW_NS, final=True) is NotificationState.DEAD


def test_a_test_is_not_tried_again(repository: Repository) -> None:
    new = NewNotification(NotificationKind.TEST, "ops", "", {"by": "ann"})
    (queued,) = repository.add_notifications([new], now_ns=NOW_NS)
    claim(repository)
    assert fail(repository, queued.id, "a 1", NOW_NS) is NotificationState.DEAD


def test_a_clock_that_was_set_back_holds_nothing_up(repository: Repository) -> None:
    queue(repository)
    assert claim(repository, now_ns=NOW_NS - 10**15)


def test_the_claims_of_the_dead_are_free_and_what_they_bring_late_does_not_count(
    repository: Repository,
) -> None:
    (queued,) = queue(repository)
    claim(repository, "dead 1")
    assert repository.claims() == {queued.id: "dead 1"}
    assert repository.release_claims(["dead 1", "other"], now_ns=NOW_NS, most_attempts=3) == 1
    waiting = repository.notification(queued.id)
    assert (waiting.state, waiting.error, waiting.attempts) == (NotificationState.QUEUED, INTERRUPTED, 1)
    assert claim(repository, "next 1").attempts == 2
    assert not repository.finish_notification(queued.id, claim="dead 1", now_ns=NOW_NS)
    assert fail(repository, queued.id, "dead 1", NOW_NS) is None
    assert repository.finish_notification(queued.id, claim="next 1", now_ns=NOW_NS)


def test_a_message_that_takes_the_service_down_each_time_is_given_up(repository: Repository) -> None:
    (queued,) = queue(repository)
    for attempt in range(3):
        claim(repository, f"dead {attempt}")
        repository.release_claims([f"dead {attempt}"], now_ns=NOW_NS, most_attempts=3)
    assert repository.notification(queued.id).state is NotificationState.DEAD


def test_what_is_made_once_only_is_made_once(repository: Repository) -> None:
    new = NewNotification(NotificationKind.DIGEST, "ops", "", {}, key="daily 2026-11-23")
    with ThreadPoolExecutor(4) as threads:
        made = list(threads.map(lambda _: repository.add_notifications([new], now_ns=NOW_NS), range(4)))
    assert sorted(map(len, made)) == [0, 0, 0, 1]
    assert repository.is_known_notification("daily 2026-11-23")


def test_services_that_share_a_database_take_each_message_once(repository: Repository) -> None:
    queue(repository, 30)

    def work(service: int) -> list[str]:
        taken: list[str] = []
        while found := repository.claim_notification("ops", claim=f"{service} {len(taken)}", now_ns=NOW_NS):
            taken.append(found.id)
            repository.finish_notification(found.id, claim=f"{service} {len(taken) - 1}", now_ns=NOW_NS)
        return taken

    with ThreadPoolExecutor(4) as threads:
        taken = [message for of_service in threads.map(work, range(4)) for message in of_service]
    assert len(taken) == len(set(taken)) == 30


def test_old_messages_are_forgotten_and_waiting_ones_kept(repository: Repository) -> None:
    sent, waiting = queue(repository, 2)
    first = claim(repository)
    repository.finish_notification(first.id, claim="a 1", now_ns=NOW_NS)
    assert repository.forget_notifications(before_ns=NOW_NS) == 0
    assert repository.forget_notifications(before_ns=NOW_NS + 1) == 1
    left = repository.notifications(limit=10).items
    assert {one.id for one in left} == {sent.id, waiting.id} - {first.id}


def test_messages_for_a_channel_that_is_gone_are_given_up(repository: Repository) -> None:
    (queued,) = queue(repository)
    assert repository.give_up_unknown(["ops"], before_ns=NOW_NS + 1, now_ns=NOW_NS) == 0
    assert repository.give_up_unknown(["siem"], before_ns=NOW_NS, now_ns=NOW_NS) == 0
    assert repository.give_up_unknown(["siem"], before_ns=NOW_NS + 1, now_ns=NOW_NS) == 1
    assert repository.notification(queued.id).error == "the settings have no channel ops"
