"""Pages of lists: a limit, and a cursor that is the sort key of the last item, opaque to clients."""

import base64
import json
from collections.abc import Callable
from typing import Annotated, Any, Generic, TypeVar

from fastapi import Query
from pydantic import BaseModel, Field

from service.api.document import LONGEST_LIST
from service.api.problems import WrongFieldError
from service.api.times import MAX_NS
from service.storage.records import Cursor
from service.storage.records import Page as StoredPage

Item = TypeVar("Item")
Stored = TypeVar("Stored")

Limit = Annotated[int, Query(ge=1, le=LONGEST_LIST, description="Most items of this page.")]
CursorText = Annotated[
    str | None,
    Query(max_length=1000, description="`next_cursor` of the page before; without: the first page."),
]
DEFAULT_LIMIT = 100


class Page(BaseModel, Generic[Item]):
    """Some items of a list; `next_cursor` leads to the next page and is null on the last one."""

    items: Annotated[list[Item], Field(max_length=LONGEST_LIST)]
    next_cursor: str | None

    @classmethod
    def model_parametrized_name(cls, params: tuple[Any, ...]) -> str:
        """Return the name of the pages of one list in the OpenAPI document: AlarmPage."""
        return "".join(param.__name__ for param in params) + cls.__name__


def page(stored: StoredPage[Stored], to_item: Callable[[Stored], Item]) -> Page[Item]:
    next_cursor = None if stored.next is None else encode(stored.next)
    return Page(items=[to_item(item) for item in stored.items], next_cursor=next_cursor)


def is_storable(text: str) -> bool:
    """Tell whether every database can hold a text: PostgreSQL takes no NUL, none takes half a character."""
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        return False
    return "\0" not in text


def encode(cursor: Cursor) -> str:
    return base64.urlsafe_b64encode(json.dumps(cursor).encode()).decode("ascii").rstrip("=")


def decode(text: str | None, *kinds: type[int] | type[str]) -> Cursor | None:
    """Return the sort key of a cursor whose parts are of these kinds.

    Raises ProblemError for any other text.
    """
    if text is None:
        return None
    try:
        padded = text.encode("ascii") + b"=" * (-len(text) % 4)
        parts = json.loads(base64.b64decode(padded, altchars=b"-_", validate=True))
    except (ValueError, RecursionError):
        parts = None
    fits = (
        isinstance(parts, list)
        and [type(part) for part in parts] == list(kinds)
        and all(abs(part) <= MAX_NS for part in parts if isinstance(part, int))
        and all(is_storable(part) for part in parts if isinstance(part, str))
    )
    if not fits:
        message = "expected the next_cursor of a page of this list"
        raise WrongFieldError("query.cursor", message)
    return tuple(parts)
