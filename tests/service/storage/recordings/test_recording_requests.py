import pytest

from service.storage import NotFoundError, Repository, StateConflictError
from service.storage.states import RecordingRequestState
from testing.service.plants import NOW_NS, SECOND_NS


def test_a_request_goes_through_its_states(repository: Repository) -> None:
    request = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    assert (request.state, request.ied, request.requested_ns) == ("requested", "A1_SEL710", NOW_NS)
    assert repository.open_recording_requests("A1_SEL710") == (request,)
    assert repository.open_recording_requests("A2_SEL710") == ()
    assert repository.relays_with_requests() == ("A1_SEL710",)

    repository.mark_triggered(request.id, now_ns=NOW_NS + 1)
    assert repository.relays_with_requests() == ()
    repository.mark_recorded(request.id, now_ns=NOW_NS + 2)
    assert [r.state for r in repository.open_recording_requests("A1_SEL710")] == [
        RecordingRequestState.RECORDED
    ]

    request = repository.fail_recording_request(request.id, "the relay made no record", now_ns=NOW_NS + 3)
    assert (request.triggered_ns, request.recorded_ns, request.failed_ns) == (
        NOW_NS + 1,
        NOW_NS + 2,
        NOW_NS + 3,
    )
    assert request.reason == "the relay made no record"
    assert repository.recording_request(request.id) == request
    assert repository.open_recording_requests("A1_SEL710") == ()


def test_a_request_waits_until_the_relay_owes_no_record(repository: Repository) -> None:
    first = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    repository.request_recording("PUMP-A1", now_ns=NOW_NS + 1)
    repository.request_recording("FAN-A2", now_ns=NOW_NS + 2)
    assert repository.relays_with_requests() == ("A1_SEL710", "A2_SEL710")
    repository.mark_triggered(first.id, now_ns=NOW_NS + 3)
    assert repository.relays_with_requests() == ("A2_SEL710",)
    repository.mark_recorded(first.id, now_ns=NOW_NS + 4)
    assert repository.relays_with_requests() == ("A2_SEL710",)
    repository.fail_recording_request(first.id, "the record was refused", now_ns=NOW_NS + 5)
    assert repository.relays_with_requests() == ("A1_SEL710", "A2_SEL710")


def test_a_repeated_step_changes_nothing(repository: Repository) -> None:
    request = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    first = repository.mark_triggered(request.id, now_ns=NOW_NS + 1)
    assert repository.mark_triggered(request.id, now_ns=NOW_NS + 9) == first


def test_a_step_that_does_not_follow_is_refused(repository: Repository) -> None:
    request = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    repository.fail_recording_request(request.id, "relay is down", now_ns=NOW_NS)
    with pytest.raises(
        StateConflictError, match=f"event report {request.id} is failed and cannot become triggered"
    ):
        repository.mark_triggered(request.id, now_ns=NOW_NS)


def test_the_same_key_gives_the_same_request(repository: Repository) -> None:
    first = repository.request_recording("PUMP-A1", now_ns=NOW_NS, idempotency_key="k")
    again = repository.request_recording("PUMP-A1", now_ns=NOW_NS + 5, idempotency_key="k")
    other_motor = repository.request_recording("FAN-A2", now_ns=NOW_NS, idempotency_key="k")
    without = [repository.request_recording("PUMP-A1", now_ns=NOW_NS) for _ in range(2)]
    assert first == again
    assert len({first.id, other_motor.id, *(request.id for request in without)}) == 4


def test_the_oldest_request_is_triggered_first(repository: Repository) -> None:
    late = repository.request_recording("PUMP-A1", now_ns=NOW_NS + SECOND_NS)
    early = repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    assert [r.id for r in repository.open_recording_requests("A1_SEL710")] == [early.id, late.id]


def test_requests_are_listed_latest_first_page_by_page(repository: Repository) -> None:
    ids = [repository.request_recording("PUMP-A1", now_ns=NOW_NS + i // 2).id for i in range(5)]
    repository.request_recording("FAN-A2", now_ns=NOW_NS)
    page = repository.recording_requests(motor="PUMP-A1", limit=2)
    listed = list(page.items)
    while page.next is not None:
        page = repository.recording_requests(motor="PUMP-A1", limit=2, after=page.next)
        listed += page.items
    assert {request.id for request in listed} == set(ids)
    assert [request.requested_ns for request in listed] == sorted(
        (r.requested_ns for r in listed), reverse=True
    )
    assert len(repository.recording_requests(limit=10).items) == 6


def test_what_does_not_exist_is_named(repository: Repository) -> None:
    with pytest.raises(NotFoundError, match="there is no motor 'PUMP-X'"):
        repository.request_recording("PUMP-X", now_ns=NOW_NS)
    with pytest.raises(NotFoundError, match="there is no event report 'nope'"):
        repository.mark_triggered("nope", now_ns=NOW_NS)


def test_a_key_of_a_client_is_never_one_of_a_schedule(repository: Repository) -> None:
    """A client that sent the keys of coming schedules kept the motor from being recorded."""
    clients = repository.request_recording(
        "PUMP-A1", now_ns=NOW_NS, idempotency_key=f"schedule {NOW_NS + SECOND_NS}"
    )
    repository.fail_recording_request(clients.id, "no record", now_ns=NOW_NS)
    ours = repository.schedule_recording("PUMP-A1", due_ns=NOW_NS + SECOND_NS, now_ns=NOW_NS + SECOND_NS)
    assert ours is not None
    assert (ours.origin, ours.id != clients.id) == ("schedule", True)
    again = repository.request_recording(
        "PUMP-A1", now_ns=NOW_NS, idempotency_key=f"schedule {NOW_NS + SECOND_NS}"
    )
    assert again.id == clients.id
