"""Who is declared dead: a peer whose counter has been seen to stand still for a whole lease."""

from service.timing.peer_liveness import PeerLiveness


def test_a_peer_whose_counter_stands_still_for_a_lease_is_dead() -> None:
    peers = PeerLiveness(10.0)
    assert peers.dead({"a": 5, "b": 5}, now_s=100.0) == {}
    assert peers.dead({"a": 5, "b": 6}, now_s=109.9) == {}
    assert peers.dead({"a": 5, "b": 6}, now_s=110.0) == {"a": 5}
    assert peers.dead({"a": 6, "b": 6}, now_s=119.9) == {"b": 6}
    assert peers.dead({"a": 6}, now_s=125.0) == {}
