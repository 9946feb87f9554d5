"""Pages of lists."""

from dataclasses import dataclass
from typing import Generic, TypeVar

T = TypeVar("T")

Cursor = tuple[str | int, ...]
"""A cursor is the sort key of the last item of a page."""


@dataclass(frozen=True, slots=True)
class Page(Generic[T]):
    """Some items of a list; `next` is where the next page starts, None at the end."""

    items: tuple[T, ...]
    next: Cursor | None
