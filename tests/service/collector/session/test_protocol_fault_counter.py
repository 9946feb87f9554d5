"""A relay that breaks the protocol again and again is quarantined; one that works is trusted again."""

from dataclasses import replace

from service.collector.gateway.batch_writer import BatchWriter
from service.collector.session.protocol_fault_counter import ProtocolFaultCounter
from service.collector.session.quarantine import QuarantinePolicy
from service.collector.session.session_policy import SESSION_POLICY, SessionPolicy
from service.storage import Repository
from service.storage.states import LinkState
from service.timing.backoff import Backoff
from testing.service.plants import NOW_NS
from testing.waiting import eventually
from tests.hostile.dialogue import overheard
from tests.hostile.relay import LIST_OF_NAMES, lying
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]

A = "A1_SEL710"
PAUSE_S = 60.0
POLICY = QuarantinePolicy.starting_with(PAUSE_S)


def test_a_relay_that_breaks_the_protocol_again_and_again_is_set_aside(repository: Repository) -> None:
    counter = ProtocolFaultCounter(A, repository, POLICY)
    counter.recall()
    told = [counter.count_fault("nonsense") for _ in range(SESSION_POLICY.faults_in_a_row)]
    assert told[:-1] == [None] * (SESSION_POLICY.faults_in_a_row - 1)
    assert told[-1] == repository.quarantine(A)
    assert "broke the protocol 5 times in a row, at last: nonsense" in (repository.relay(A).link_reason or "")


def test_a_relay_that_answers_with_nonsense_is_set_aside_with_its_reason(bench: Bench) -> None:
    bench.policy = SessionPolicy(reconnect=Backoff(first_s=0.01, longest_s=10.0))
    with lying(overheard(), {LIST_OF_NAMES: lambda _: b"\xa1\x00"}) as port:
        bench.relay = replace(bench.relay, port=port)
        with bench.session():
            assert eventually(lambda: bench.link() is LinkState.QUARANTINED)
    reason = bench.repository.relay(NAME).link_reason or ""
    assert f"broke the protocol {SESSION_POLICY.faults_in_a_row} times in a row" in reason
    assert "connect: malformed message" in reason
    states = [change.state for change in bench.repository.link_changes(NAME, limit=100).items]
    assert states == [LinkState.QUARANTINED, LinkState.DOWN], "each once, latest first"


def test_notes_that_wait_take_no_link_out_of_quarantine(bench: Bench) -> None:
    """A gateway writes what its sessions note up to a second later, after a locked database much later."""
    batches = bench.notes = BatchWriter(bench.repository, period_s=0.05)
    bench.policy = SessionPolicy(reconnect=Backoff(first_s=0.01, longest_s=10.0))
    with lying(overheard(), {LIST_OF_NAMES: lambda _: b"\xa1\x00"}) as port:
        bench.relay = replace(bench.relay, port=port)
        with bench.session():
            assert eventually(lambda: bench.repository.quarantine(NAME) is not None)
    quarantine = bench.repository.quarantine(NAME)
    batches.start()
    batches.stop(10)
    link = bench.repository.relay(NAME)
    assert quarantine is not None
    assert (link.link_state, link.link_reason) == (LinkState.QUARANTINED, quarantine.link_reason)
    states = [change.state for change in bench.repository.link_changes(NAME, limit=100).items]
    assert LinkState.DOWN in states, "the notes that waited are written"


def test_good_visits_between_count(repository: Repository) -> None:
    now_s = 0.0
    counter = ProtocolFaultCounter(A, repository, POLICY, clock=lambda: now_s)
    counter.recall()
    for _ in range(3 * SESSION_POLICY.faults_in_a_row):
        counter.visit_begins()
        now_s += 11.0
        counter.round_succeeded()
        assert not counter.count_fault("nonsense")


def test_a_relay_that_works_as_long_as_it_was_set_aside_is_trusted(repository: Repository) -> None:
    repository.set_aside(A, "why", backoff=Backoff(PAUSE_S, 86_400.0), now_ns=NOW_NS)
    now_s = 0.0
    counter = ProtocolFaultCounter(A, repository, POLICY, clock=lambda: now_s)
    counter.recall()
    counter.visit_begins()
    now_s += PAUSE_S - 1
    counter.round_succeeded()
    assert repository.quarantine(A) is not None
    now_s += 2
    counter.round_succeeded()
    assert repository.quarantine(A) is None
    assert repository.standing_alarms(A) == ()
