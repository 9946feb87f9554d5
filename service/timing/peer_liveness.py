"""Which other processes are dead, told by the counters they raise and by a clock of our own."""


class PeerLiveness:
    """Remembers for how long each peer's heartbeat counter has stood still.

    It wants a clock that stands still while this machine is suspended, `time.monotonic`: time in which nobody
    looked is no evidence against a peer. A peer that was suspended together with this machine thus gets the
    time to renew its lease, or to end itself (`LeaseWatchdog`), before it is declared dead.
    """

    def __init__(self, lease_s: float) -> None:
        """lease_s: a counter that stands still for so long is that of a dead peer [s]."""
        self._lease_s = lease_s
        self._seen: dict[str, tuple[int, float]] = {}

    def dead(self, heartbeats: dict[str, int], now_s: float) -> dict[str, int]:
        """Return the peers, with their counters, that have stood still for a whole lease.

        heartbeats: the counter of every peer at `now_s`, which is monotonic [s].
        """
        self._seen = {
            peer: self._seen[peer]
            if peer in self._seen and self._seen[peer][0] == counter
            else (counter, now_s)
            for peer, counter in heartbeats.items()
        }
        return {
            peer: counter
            for peer, (counter, since_s) in self._seen.items()
            if now_s - since_s >= self._lease_s
        }
