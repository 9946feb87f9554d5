"""Answers that are files: made while they are sent, few at a time, and never shortened in silence."""

import re
import time
from collections.abc import AsyncIterator, Iterable, Iterator, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from itertools import chain
from typing import Annotated, Any, Literal

import structlog
from fastapi import Depends, Query, Request
from fastapi.responses import StreamingResponse
from sqlalchemy.exc import SQLAlchemyError
from starlette.types import Receive, Scope, Send
from structlog.typing import FilteringBoundLogger

from core.time_stamps import SECONDS_END, rfc3339
from service.api.context import Context
from service.api.exports.negotiation import JSON, preferred
from service.api.problems import ProblemError, WrongFieldError, problems
from service.exports.formats import Format
from service.exports.tables import Record, Table
from service.exports.writing import pieces

log: FilteringBoundLogger = structlog.get_logger(__name__)

LONGEST_S = 600.0
"""An export that a client has not taken by then is broken off: it holds a place meanwhile."""

MEDIA_TYPES = {one.media_type: one for one in Format}

FILES: dict[int | str, dict[str, Any]] = {
    **problems(404, 406),
    200: {"content": {one: {"schema": {"type": "string", "format": "binary"}} for one in MEDIA_TYPES}},
}
"""What OpenAPI says of a route that answers with files."""

_UNSAFE = re.compile(r"[^A-Za-z0-9-]+")

ListFormat = Annotated[
    Literal["json", "csv", "xlsx", "parquet"] | None,
    Query(
        alias="format",
        description="A file of the whole list instead of a page; without: by the header Accept, else JSON.",
    ),
]
FileFormat = Annotated[
    Format | None, Query(alias="format", description="Without: by the header Accept, else CSV.")
]


class ExportInterruptedError(RuntimeError):
    """A file that was under way cannot be completed. The connection ends, so that its client notices."""


class _FileResponse(StreamingResponse):
    """A file on its way. Where it is interrupted the server closes the connection before the body's end."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        try:
            await super().__call__(scope, receive, send)
        except ExportInterruptedError as error:
            log.warning("a file was broken off", path=scope["path"], reason=str(error))


@dataclass(frozen=True, slots=True)
class FileAnswer:
    """A file that a client gets, in the format that it wants."""

    format: Format

    def of(
        self, table: Table[Record], batches: Iterable[Sequence[Record]], subject: Sequence[str] | None
    ) -> StreamingResponse:
        """Return the answer, the first piece of which is made.

        subject: the motors it is about; None for all. Raises what reading the first batch raises.
        """
        made = pieces(self.format, table, batches)
        name = _file_name(table.name, subject, self.format)
        first = next(made)
        return _FileResponse(
            _sent(chain([first], made)),
            media_type=_content_type(self.format),
            headers={
                "Content-Disposition": f'attachment; filename="{name}"',
                "Cache-Control": "no-store",
                "Vary": "Accept",
            },
        )


def sent_file(made: Iterator[bytes], content_type: str, name: str) -> StreamingResponse:
    """Return the answer with a file that is no table of a list. Raises what making its first piece raises."""
    first = next(made)
    headers = {"Content-Disposition": f'attachment; filename="{name}"', "Cache-Control": "no-store"}
    return _FileResponse(_sent(chain([first], made)), media_type=content_type, headers=headers)


async def list_answer(
    request: Request, context: Context, wanted: ListFormat = None
) -> AsyncIterator[FileAnswer | None]:
    """Hold a place for a file until it is sent; nothing where the client wants a page of JSON.

    Raises BusyError, ProblemError.
    """
    if wanted is None:
        chosen = MEDIA_TYPES.get(preferred(request.headers.get("accept"), [JSON, *MEDIA_TYPES]))
    else:
        chosen = None if wanted == "json" else Format(wanted)
    if chosen is None:
        yield None
        return
    for name in ("limit", "cursor"):
        if name in request.query_params:
            message = f"a file has the whole list: leave {name} out, or ask for JSON"
            raise WrongFieldError(f"query.{name}", message)
    async with context.exports.admitted():
        yield _answer(chosen)


async def file_answer(
    request: Request, context: Context, wanted: FileFormat = None
) -> AsyncIterator[FileAnswer]:
    """Hold a place for a file until it is sent. Raises BusyError, ProblemError."""
    chosen = wanted or MEDIA_TYPES[preferred(request.headers.get("accept"), list(MEDIA_TYPES))]
    async with context.exports.admitted():
        yield _answer(chosen)


ListAnswer = Annotated[FileAnswer | None, Depends(list_answer)]
"""The file that a client wants instead of a page of a list; None where it wants the page."""

FileOnly = Annotated[FileAnswer, Depends(file_answer)]
"""The file that a client wants."""


def _answer(wanted: Format) -> FileAnswer:
    if wanted.missing is not None:
        raise ProblemError(HTTPStatus.NOT_ACCEPTABLE, wanted.missing)
    return FileAnswer(wanted)


def _sent(made: Iterator[bytes]) -> Iterator[bytes]:
    """Return the pieces while the client takes them in time. Raises ExportInterruptedError."""
    end_s = time.monotonic() + LONGEST_S
    try:
        for piece in made:
            if time.monotonic() > end_s:
                raise ExportInterruptedError(f"its client had not taken it after {LONGEST_S:g} s")
            yield piece
    except SQLAlchemyError as error:
        raise ExportInterruptedError("the database does not answer any more") from error


def _content_type(wanted: Format) -> str:
    return (
        f"{wanted.media_type}; charset=utf-8; header=present" if wanted is Format.CSV else wanted.media_type
    )


def _file_name(table: str, subject: Sequence[str] | None, wanted: Format) -> str:
    """Return TABLE_MOTOR_TIME.SUFFIX in characters that every system takes."""
    motor = f"_{_UNSAFE.sub('_', subject[0])[:80]}" if subject is not None and len(subject) == 1 else ""
    now = rfc3339(time.time_ns())[:SECONDS_END].replace(":", "-")
    return f"{table}{motor}_{now}Z.{wanted}"
