"""What a gateway says of itself with each heartbeat."""

import pytest

from service.storage import LeaseLostError, Repository
from testing.service.plants import NOW_NS

RELAYS = ["A1_SEL710"]


@pytest.mark.parametrize("problem", ["batch writer: RuntimeError: no room", None])
def test_a_heartbeat_says_what_does_not_work(repository: Repository, problem: str | None) -> None:
    repository.register_gateway("g", host="here", process_id=1, now_ns=NOW_NS)
    repository.share_relays("g", RELAYS, most=1, problem="another")
    share = repository.share_relays("g", RELAYS, most=1, problem=problem)
    assert share.heartbeats == {"g": 2}
    (gateway,) = repository.gateways()
    assert (gateway.problem, gateway.relays) == (problem, 1)


def test_a_gateway_that_starts_anew_has_no_problem(repository: Repository) -> None:
    for _ in range(2):
        repository.register_gateway("g", host="here", process_id=1, now_ns=NOW_NS)
        (gateway,) = repository.gateways()
        assert gateway.problem is None
        repository.share_relays("g", RELAYS, most=1, problem="no room")
    assert repository.end_gateway("g", now_ns=NOW_NS)
    with pytest.raises(LeaseLostError):
        repository.share_relays("g", RELAYS, most=1, problem="no room")
