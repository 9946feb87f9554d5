"""Which other gateways are dead, told by their counters and our own clock."""


class PeerLiveness:
    """Remembers since when each gateway's counter has stood still."""

    def __init__(self, lease_s: float) -> None:
        self._lease_s = lease_s
        self._seen: dict[str, tuple[int, float]] = {}

    def dead(self, beats: dict[str, int], now_s: float) -> dict[str, int]:
        """Those, with their counters, that stood still for a whole lease. `now_s` is monotonic [s]."""
        self._seen = {
            gateway: self._seen[gateway]
            if gateway in self._seen and self._seen[gateway][0] == count
            else (count, now_s)
            for gateway, count in beats.items()
        }
        return {
            gateway: count
            for gateway, (count, since_s) in self._seen.items()
            if now_s - since_s >= self._lease_s
        }
