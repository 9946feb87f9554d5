"""Every event in every state: what follows, or that it is not possible and changes nothing."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import count

import pytest

from core.units import NANOSECONDS_PER_DAY
from service.storage import Repository
from service.storage.errors import AlarmActionError
from service.storage.records import Actor, Alarm, AlarmPlace, AlarmSpec
from service.storage.states import AlarmEvent, AlarmKind, AlarmState
from service.timing.backoff import Backoff
from testing.service.plants import NOW_NS

RELAY = "A1_SEL710"
KIND = AlarmKind.FILE_REFUSED
ANN = Actor("ann", "command line")
PAUSE = Backoff(3600.0, 3600.0)

EVENTS = tuple(AlarmEvent)
EXPECTED = """
                              raised     cleared    superseded reopened ack     undo    shelve  unshelve ended   suppr   unsuppr  out  back
unacknowledged                .          returned   normal     .        ack     .       shelved -        .       suppr   .        out  -
acknowledged                  .          normal     normal     unack    -       unack   shelved -        .       .       .        out  -
returned-unacknowledged       unack      .          normal     .        normal  .       shelved -        .       suppr   .        out  -
normal                        new        .          .          .        -       .       -       -        .       .       .        -    -
shelved/standing              .          shelved    normal     unack    -       .       shelved unack    unack   .       .        out  -
shelved/gone                  shelved    .          normal     .        -       .       shelved normal   normal  .       .        out  -
suppressed/standing           .          suppr      normal     .        -       .       -       -        .       .       unack    out  -
suppressed/gone               suppr      .          normal     .        -       .       -       -        .       .       normal   out  -
out-of-service/standing       .          out        out        .        -       .       -       -        .       .       .        -    unack
out-of-service/gone           out        .          .          .        -       .       -       -        .       .       .        -    normal
"""  # noqa: E501 - a table
"""What follows. `-`: refused to the person who asks; `.`: changes nothing; `new`: another alarm."""

WORDS = {
    "unack": AlarmState.UNACKNOWLEDGED,
    "ack": AlarmState.ACKNOWLEDGED,
    "returned": AlarmState.RETURNED_UNACKNOWLEDGED,
    "normal": AlarmState.NORMAL,
    "shelved": AlarmState.SHELVED,
    "suppr": AlarmState.SUPPRESSED,
    "out": AlarmState.OUT_OF_SERVICE,
}
COLUMNS: Mapping[str, AlarmEvent] = {
    "raised": AlarmEvent.RAISED,
    "cleared": AlarmEvent.CLEARED,
    "superseded": AlarmEvent.SUPERSEDED,
    "reopened": AlarmEvent.REOPENED,
    "ack": AlarmEvent.ACKNOWLEDGED,
    "undo": AlarmEvent.ACKNOWLEDGEMENT_UNDONE,
    "shelve": AlarmEvent.SHELVED,
    "unshelve": AlarmEvent.UNSHELVED,
    "ended": AlarmEvent.SHELVING_ENDED,
    "suppr": AlarmEvent.SUPPRESSED,
    "unsuppr": AlarmEvent.UNSUPPRESSED,
    "out": AlarmEvent.TAKEN_OUT_OF_SERVICE,
    "back": AlarmEvent.PUT_BACK_IN_SERVICE,
}


def rows() -> dict[str, dict[AlarmEvent, str]]:
    heading, *lines = EXPECTED.strip().splitlines()
    events = [COLUMNS[word] for word in heading.split()]
    assert set(events) == set(AlarmEvent)
    return {line.split()[0]: dict(zip(events, line.split()[1:], strict=True)) for line in lines}


@dataclass
class Life:
    """Alarms of one relay, each with a subject of its own, and a clock that goes on."""

    repository: Repository

    def __post_init__(self) -> None:
        self.subjects = map(str, count())
        self.times_ns = count(NOW_NS)

    @property
    def now_ns(self) -> int:
        return next(self.times_ns)

    def raise_one(self, subject: str | None = None) -> Alarm:
        subject = next(self.subjects) if subject is None else subject
        return self.repository.raise_alarm(RELAY, KIND, subject, "refused", now_ns=self.now_ns)

    def in_state(self, name: str) -> Alarm:
        """Return an alarm in a state, whose cause stands or is gone."""
        state, _, cause = name.partition("/")
        self.repository.release(RELAY, now_ns=self.now_ns)
        if state == AlarmState.SUPPRESSED:
            self.let(AlarmEvent.SUPPRESSED, None)
        alarm = self.raise_one()
        for event in WAYS.get(state, ()):
            self.let(event, alarm)
        if cause == "gone":
            self.let(AlarmEvent.CLEARED, alarm)
        alarm = self.repository.alarm(alarm.id)
        assert (alarm.state, cause) in {(state, ""), (state, "standing" if alarm.standing else "gone")}
        return alarm

    def let(self, event: AlarmEvent, alarm: Alarm | None) -> None:
        """Let an event happen."""
        doing = OF_PLANT.get(event)
        if doing is not None:
            doing(self.repository, self.now_ns)
            return
        assert alarm is not None
        OF_ALARM[event](self, alarm)


WAYS = {
    "acknowledged": (AlarmEvent.ACKNOWLEDGED,),
    "returned-unacknowledged": (AlarmEvent.CLEARED,),
    "normal": (AlarmEvent.ACKNOWLEDGED, AlarmEvent.CLEARED),
    "shelved": (AlarmEvent.SHELVED,),
    "out-of-service": (AlarmEvent.TAKEN_OUT_OF_SERVICE,),
}

OF_PLANT: Mapping[AlarmEvent, Callable[[Repository, int], object]] = {
    AlarmEvent.SUPPRESSED: lambda r, now: r.set_aside(RELAY, "crashed", backoff=PAUSE, now_ns=now),
    AlarmEvent.UNSUPPRESSED: lambda r, now: r.release(RELAY, now_ns=now),
    AlarmEvent.SHELVING_ENDED: lambda r, now: r.end_shelvings(now_ns=now + NANOSECONDS_PER_DAY),
}


def _supersede(life: Life, alarm: Alarm) -> None:
    successor = life.raise_one()
    life.repository.supersede_alarm(alarm.id, successor.id, now_ns=life.now_ns)


def _shelve(life: Life, alarm: Alarm) -> None:
    now_ns = life.now_ns
    life.repository.shelve_alarm(alarm.id, until_ns=now_ns + NANOSECONDS_PER_DAY // 2, by=ANN, now_ns=now_ns)


OF_ALARM: Mapping[AlarmEvent, Callable[[Life, Alarm], object]] = {
    AlarmEvent.RAISED: lambda life, alarm: life.raise_one(alarm.subject),
    AlarmEvent.CLEARED: lambda life, alarm: life.repository.clear_alarms(
        RELAY, [alarm.id], now_ns=life.now_ns
    ),
    AlarmEvent.SUPERSEDED: _supersede,
    AlarmEvent.REOPENED: lambda life, alarm: life.repository.reopen_alarm(
        alarm.id, "worse", now_ns=life.now_ns
    ),
    AlarmEvent.ACKNOWLEDGED: lambda life, alarm: life.repository.acknowledge_alarm(
        alarm.id, by=ANN, now_ns=life.now_ns
    ),
    AlarmEvent.ACKNOWLEDGEMENT_UNDONE: lambda life, alarm: life.repository.undo_acknowledgements(
        [alarm.id], by=ANN, since_ns=NOW_NS, now_ns=life.now_ns
    ),
    AlarmEvent.SHELVED: _shelve,
    AlarmEvent.UNSHELVED: lambda life, alarm: life.repository.unshelve_alarm(
        alarm.id, by=ANN, now_ns=life.now_ns
    ),
    AlarmEvent.TAKEN_OUT_OF_SERVICE: lambda life, alarm: life.repository.take_alarm_out_of_service(
        alarm.id, by=ANN, now_ns=life.now_ns
    ),
    AlarmEvent.PUT_BACK_IN_SERVICE: lambda life, alarm: life.repository.put_alarm_back_in_service(
        alarm.id, by=ANN, now_ns=life.now_ns
    ),
}


@pytest.mark.parametrize("state", rows())
def test_what_follows_in_a_state(repository: Repository, state: str) -> None:
    life = Life(repository)
    for event, expected in rows()[state].items():
        before = life.in_state(state)
        history = repository.alarm_changes(before.id, limit=1).items
        if expected == "-":
            with pytest.raises(AlarmActionError, match=f"it is {before.state}.*possible now: "):
                life.let(event, before)
            expected = "."
        else:
            life.let(event, before)
        after = repository.alarm(before.id)
        if expected in {".", "new"}:
            assert after == before, event
            assert repository.alarm_changes(before.id, limit=1).items == history
            again = repository.alarms(limit=1).items[0]
            assert (again.subject == before.subject and again.id != before.id) == (expected == "new")
            continue
        assert after.state is WORDS[expected], event
        (change,) = repository.alarm_changes(before.id, limit=1).items
        assert (change.event, change.before, change.after) == (event, before.state, after.state)
        assert after.standing == (
            event is AlarmEvent.RAISED
            or (before.standing and event not in {AlarmEvent.CLEARED, AlarmEvent.SUPERSEDED})
        )


def test_a_refusal_says_what_is_possible(repository: Repository) -> None:
    life = Life(repository)
    shelved, over = life.in_state("shelved/standing"), life.in_state("normal")
    with pytest.raises(AlarmActionError) as refused:
        life.let(AlarmEvent.ACKNOWLEDGED, shelved)
    assert str(refused.value) == (
        f"alarm {shelved.id} cannot be acknowledged: it is shelved (by ann); possible now: shelve, unshelve, "
        "take out of service"
    )
    with pytest.raises(AlarmActionError, match="possible now: nothing; it is over"):
        life.let(AlarmEvent.SHELVED, over)


def test_where_an_alarm_may_be(repository: Repository) -> None:
    """At a motor, a relay, a site or the service itself: each cause is another one."""
    places = (
        AlarmPlace(motor="PUMP-A1"),
        AlarmPlace(relay=RELAY),
        AlarmPlace(site="FACTORY_A"),
        AlarmPlace(),
    )
    spec = AlarmSpec(AlarmKind.DAILY_LIMIT, "full")
    for number in range(2):
        for place in places:
            repository.raise_alarm_at(place, spec, now_ns=NOW_NS + number)
    found = repository.alarms(limit=10).items
    assert {(one.site, one.ied, one.motor) for one in found} == {
        ("FACTORY_A", RELAY, "PUMP-A1"),
        ("FACTORY_A", RELAY, None),
        ("FACTORY_A", None, None),
        (None, None, None),
    }
    assert len(found) == 4
    assert repository.counts().alarms == {AlarmKind.DAILY_LIMIT: 4}
    for place in places:
        assert repository.clear_alarms_at(place, spec.kind, now_ns=NOW_NS + 5, why="room again") == 1
        assert repository.clear_alarms_at(place, spec.kind, now_ns=NOW_NS + 5) == 0
    assert repository.counts().alarms == {}
