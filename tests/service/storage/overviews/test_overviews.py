"""Lists that show more than one table: what belongs to a relay, a motor or a user, and nothing of others."""

from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor, RelayFindings, RemoteRecord, Role, Sample
from service.storage.records.alarms import AlarmPlace, AlarmSpec
from service.storage.states import AlarmKind, AlarmState, LinkState
from service.timing.backoff import Backoff
from testing.service.links import set_link_state
from testing.service.plants import NOW_NS, SECOND_NS

A, B = "A1_SEL710", "A2_SEL710"
ADMIN = Actor("admin", "command line")
DIFFERENCE = {"kind": "logical-node", "expected": "X/FLTRDRE1", "found": None}


def test_relays_with_all_that_belongs_to_them(repository: Repository, store: RecordingStore) -> None:
    set_link_state(repository, A, LinkState.UP, None, now_ns=NOW_NS)
    repository.set_aside(B, "crashed", backoff=Backoff(60.0, 600.0), now_ns=NOW_NS)
    repository.note_findings(RelayFindings(A, NOW_NS, {}, [DIFFERENCE] * 3, [], 7))
    repository.raise_alarm(A, AlarmKind.DAILY_LIMIT, "", "too much", now_ns=NOW_NS)
    record, later = RemoteRecord("C_1", 7, 1), RemoteRecord("C_2", 7, 2)
    repository.announce_recording(A, "PUMP-A1", record, now_ns=NOW_NS + 3)
    repository.add_recording(
        store.store({"E.CFF": b"pulled"}), motor="PUMP-A1", relay=A, remote=record, now_ns=NOW_NS + 4
    )
    repository.add_recording(store.store({"E.CFF": b"uploaded"}), motor="PUMP-A1", now_ns=NOW_NS + 5)
    repository.announce_recording(A, "PUMP-A1", later, now_ns=NOW_NS + 6)
    first, second = repository.relay_overviews(limit=10).items
    assert (first.relay.name, first.motors, second.motors) == (A, ("PUMP-A1",), ("FAN-A2",))
    assert (first.differences, first.ignored_files, first.standing_alarms) == (3, 7, 1)
    assert (second.differences, second.ignored_files) == (None, None), "nobody has visited it"
    assert first.quarantine is None
    assert second.quarantine is not None
    assert second.quarantine.reason == "crashed"
    assert first.last_record_ns == NOW_NS + 3, "neither what people uploaded nor what is yet to be fetched"
    assert second.last_record_ns is None
    assert repository.relay_overview(A) == first
    differing = repository.relay_overviews(limit=10, differing=True).items
    assert [one.relay.name for one in differing] == [A]
    assert repository.visited_relays() == (1, 2)
    assert repository.link_states() == {LinkState.UP: 1, LinkState.QUARANTINED: 1}


def test_relays_are_chosen_by_site_link_and_text(repository: Repository) -> None:
    set_link_state(repository, A, LinkState.DOWN, "refused", now_ns=NOW_NS)

    def names(
        *, site: str | None = None, link: LinkState | None = None, text: str | None = None
    ) -> list[str]:
        page = repository.relay_overviews(limit=10, site=site, link=link, text=text)
        return [one.relay.name for one in page.items]

    assert names(link=LinkState.DOWN) == [A]
    assert names(site="FACTORY_A") == [A, B]
    assert names(site="elsewhere") == []
    assert names(text="fan-") == [B], "the name of its motor, in any capitals"
    assert names(text="a1_sel") == [A]
    assert names(text="%") == []


def test_a_link_over_time_begins_with_how_it_was_before(repository: Repository) -> None:
    for hour, state in enumerate((LinkState.UP, LinkState.DOWN, LinkState.UP)):
        set_link_state(repository, A, state, None, now_ns=NOW_NS + hour * 3600 * SECOND_NS)
    history = repository.link_history(A, from_ns=NOW_NS + 1800 * SECOND_NS)
    assert [change.state for change in history] == [LinkState.UP, LinkState.DOWN, LinkState.UP]
    later = repository.link_history(A, from_ns=NOW_NS + 9000 * SECOND_NS)
    assert [change.state for change in later] == [LinkState.UP]
    assert repository.link_history(B, from_ns=0) == ()


def test_motors_with_what_their_file_says_now(repository: Repository) -> None:
    document = {"limits": {"fault_level": 0.005}, "sensors": {}, "nameplate": {}, "parameters": {}}
    repository.note_motors({"PUMP-A1": document}, now_ns=NOW_NS)
    fan, pump = repository.motor_overviews(limit=10).items
    assert (pump.document, pump.since_ns, fan.document) == (document, None, None)
    repository.note_motors({"PUMP-A1": {**document, "limits": {"fault_level": 0.01}}}, now_ns=NOW_NS + 1)
    (pump,) = repository.motor_overviews(limit=10, text="pump").items
    assert pump.document is not None
    assert pump.document["limits"] == {"fault_level": 0.01}
    assert repository.motor_overviews(limit=10, site="elsewhere").items == ()


def test_what_the_relays_of_motors_measured_last(repository: Repository) -> None:
    samples = [
        Sample(motor, NOW_NS + second * SECOND_NS, {"vab_V": 400.0 + second})
        for motor, seconds in (("PUMP-A1", (0, 10)), ("FAN-A2", (5,)))
        for second in seconds
    ]
    repository.add_samples(samples)
    motors = ["PUMP-A1", "FAN-A2"]
    found = repository.latest_samples(motors, since_ns=NOW_NS)
    assert {motor: sample.values for motor, sample in found.items()} == {
        "PUMP-A1": {"vab_V": 410.0},
        "FAN-A2": {"vab_V": 405.0},
    }
    assert set(repository.latest_samples(motors, since_ns=NOW_NS + 6 * SECOND_NS)) == {"PUMP-A1"}


def test_users_with_sessions_locks_and_tokens(repository: Repository) -> None:
    for name in ("ada", "bob"):
        repository.add_user(name, [Role.SECADM], password=None, by=ADMIN, now_ns=NOW_NS)
    for digest, at_ns in (("1" * 64, NOW_NS), ("2" * 64, NOW_NS + 10)):
        repository.begin_session(
            digest,
            "ada",
            "password",
            most=100,
            oldest_ns=0,
            idle_since_ns=0,
            by=Actor("ada", "::1"),
            now_ns=at_ns,
        )
    repository.add_token(
        "bob", "program", "3" * 64, scope=None, expires_ns=None, by=Actor("bob", "::1"), now_ns=NOW_NS
    )
    users = ["ada", "bob"]
    assert repository.open_sessions(users, oldest_ns=NOW_NS, idle_since_ns=NOW_NS) == {"ada": 2}
    assert repository.open_sessions(users, oldest_ns=NOW_NS, idle_since_ns=NOW_NS + 5) == {"ada": 1}
    assert repository.tokens_of_users(users) == {"bob": 1}
    assert repository.locks_of_users(users, now_ns=NOW_NS) == {}


def test_alarms_are_chosen_by_several_states_and_by_text(repository: Repository) -> None:
    spec = AlarmSpec(AlarmKind.MISSING_DATA, "no record", "")
    pump = repository.raise_alarm_at(AlarmPlace(motor="PUMP-A1"), spec, now_ns=NOW_NS)
    fan = repository.raise_alarm_at(AlarmPlace(motor="FAN-A2"), spec, now_ns=NOW_NS + 1)
    repository.shelve_alarm(fan.id, by=ADMIN, now_ns=NOW_NS + 2, until_ns=NOW_NS + 10)
    active = (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED)
    assert [one.id for one in repository.open_alarms(limit=9, states=active).items] == [pump.id]
    assert [one.id for one in repository.open_alarms(limit=9, states=[AlarmState.SHELVED]).items] == [fan.id]
    assert [one.id for one in repository.alarms(limit=9, text="fan").items] == [fan.id]
    assert [one.id for one in repository.alarms(limit=9, site="FACTORY_A").items] == [fan.id, pump.id]
    assert repository.alarms(limit=9, site="elsewhere").items == ()
