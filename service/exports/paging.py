"""Reads long lists from the database page by page: an export holds one page at a time."""

from collections.abc import Callable, Iterator
from typing import TypeVar

from service.storage.records import Cursor, Page

Item = TypeVar("Item")

PAGE = 1000


def pages(read: Callable[..., Page[Item]], *, size: int = PAGE) -> Iterator[tuple[Item, ...]]:
    """Return the items of every page. read: takes a `limit`, and the cursor `after` which the page begins."""
    after: Cursor | None = None
    while True:
        page = read(limit=size, after=after)
        yield page.items
        if page.next is None:
            return
        after = page.next
