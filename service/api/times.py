"""Times of the REST API: integer nanoseconds inside, RFC 3339 in UTC outside."""

from typing import Annotated

from pydantic import BeforeValidator, WithJsonSchema

from core.time_stamps import MAX_LENGTH, MAX_NS, nanoseconds, rfc3339

__all__ = ["MAX_NS", "Time", "TimeParameter", "nanoseconds", "rfc3339"]


def _outside(value: object) -> object:
    return rfc3339(value) if isinstance(value, int) else value


def _inside(value: object) -> int:
    return nanoseconds(value if isinstance(value, str) else "")  # a number in a document is no time


Time = Annotated[str, BeforeValidator(_outside), WithJsonSchema({"type": "string", "format": "date-time"})]
"""A time in a response is made from nanoseconds."""

TimeParameter = Annotated[
    int,
    BeforeValidator(_inside),
    WithJsonSchema({"type": "string", "format": "date-time", "maxLength": MAX_LENGTH}),
]
"""A time in a request is RFC 3339 and becomes nanoseconds."""
