"""States of links, as a gateway notes them."""

from service.storage import Repository
from service.storage.records import LinkNote, LinkTraffic
from service.storage.states import LinkState

NOTHING = LinkTraffic()


def set_link_state(
    repository: Repository,
    relay: str,
    state: LinkState,
    reason: str | None,
    *,
    now_ns: int,
    traffic: LinkTraffic = NOTHING,
    day_bytes: tuple[int, int] = (0, 0),
    round_trip_s: float | None = None,
) -> None:
    """Note a link's state from `now_ns` on. day_bytes: a day (since 1970) and the bytes that count in it."""
    day, used_bytes = day_bytes
    note = LinkNote(
        relay, now_ns, traffic, round_trip_s, day=day, day_bytes=used_bytes, state=state, reason=reason
    )
    repository.note_links((note,))
