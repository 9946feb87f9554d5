"""Which links are down, since when, and whether a whole site is lost with them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise


@dataclass(frozen=True, slots=True)
class LinkPeriod:
    """A link is up or not from `since_ns` on."""

    since_ns: int
    is_up: bool


def down_since(periods: Sequence[LinkPeriod], now_ns: int, settle_ns: int) -> int | None:
    """Return since when a link is down; None where it is up.

    An answer now and then ends no outage: a link counts as up when it was up for `settle_ns` without a break.
    periods: oldest first; of a link that nobody looked at yet there are none.
    """
    down_ns: int | None = None
    lasting = pairwise([*((one.since_ns, one.is_up) for one in periods), (now_ns, True)])
    for (since_ns, is_up), (end_ns, _) in lasting:
        if not is_up:
            down_ns = since_ns if down_ns is None else down_ns
        elif end_ns - since_ns >= settle_ns:
            down_ns = None
    return down_ns


@dataclass(frozen=True, slots=True)
class SiteRule:
    """A site is lost when at least `share` of its relays went down within `within_ns` of each other.

    It is back when fewer than half that share are down.  least: with fewer relays than this down, each speaks
    for itself.
    """

    share: float
    within_ns: int
    least: int

    def lost_since(self, down_ns: Iterable[int], relays: int) -> int | None:
        """Return since when a site of so many relays is lost, of which some are down since `down_ns`.

        None where it is not.
        """
        needed = max(self.share * relays, self.least)
        began_ns = sorted(down_ns)
        first = 0
        for last, since_ns in enumerate(began_ns):
            while since_ns - began_ns[first] > self.within_ns:
                first += 1
            if last - first + 1 >= needed:
                return began_ns[first]
        return None

    def is_back(self, down: int, relays: int) -> bool:
        """Tell whether a lost site is back, of whose relays so many are down."""
        return down < max(self.share * relays, self.least) / 2.0
