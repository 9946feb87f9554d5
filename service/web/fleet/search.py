"""What the search at the top of each page finds beside motors."""

from collections.abc import Sequence
from typing import Final

from service.storage import Repository
from service.storage.records import IedEntry

MOST_FOUND: Final = 50
"""More of a kind are not shown: another word leads to the one that is meant."""
PAGE: Final = 500


def relays_with(repository: Repository, words: Sequence[str]) -> list[IedEntry]:
    """Return the relays whose names or hosts have all words, by name."""
    found: list[IedEntry] = []
    after = None
    while len(found) < MOST_FOUND:
        page = repository.relays(limit=PAGE, after=after)
        found += [one for one in page.items if all(word in _searched(one) for word in words)]
        after = page.next
        if after is None:
            break
    return found[:MOST_FOUND]


def _searched(relay: IedEntry) -> str:
    return f"{relay.name}\n{relay.host}".casefold()
