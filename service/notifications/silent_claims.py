"""Messages whose sender died, with its whole host perhaps: found by claims that stand still.

No clock is compared with another. A claim is of one attempt, which has a limit of time; whoever has seen the
same claim for longer than that, by a clock of its own that only goes forward, knows its sender dead.
"""

from collections.abc import Collection, Mapping

from core.units import NANOSECONDS_PER_SECOND


class SilentClaims:
    """Remembers since when claims are seen. For use by one thread."""

    def __init__(self, limit_s: float) -> None:
        self._limit_ns = round(limit_s * NANOSECONDS_PER_SECOND)
        self._since_ns: dict[str, int] = {}

    def among(self, claims: Mapping[str, str], monotonic_ns: int) -> Collection[str]:
        """Return the claims that have stood for too long, from all that stand now, by message."""
        self._since_ns = {claim: self._since_ns.get(claim, monotonic_ns) for claim in claims.values()}
        return {
            claim for claim, since_ns in self._since_ns.items() if monotonic_ns - since_ns > self._limit_ns
        }
