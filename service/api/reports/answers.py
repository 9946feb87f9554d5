"""A report as an answer: made whole before it is sent, one at a time."""

import time
from collections.abc import AsyncIterator
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import Depends, Query, Response
from pydantic import StringConstraints

from core.units import NANOSECONDS_PER_DAY
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, WrongFieldError, problems
from service.reports.errors import ReportError, ReportRequestError
from service.reports.making import make_report
from service.reports.source import ReportSource
from service.reports.times import minute_before
from service.reports.wanted import ReportFormat, WantedReport

FILES: dict[int | str, dict[str, Any]] = {
    **problems(404),
    200: {
        "content": {
            one.media_type: {"schema": {"type": "string", "format": "binary"}} for one in ReportFormat
        }
    },
}
"""What OpenAPI says of a route that answers with a report."""

Format = Annotated[ReportFormat, Query(alias="format", description="PDF, or an Excel workbook.")]
Sites = Annotated[
    list[Annotated[str, StringConstraints(max_length=200)]] | None,
    Query(alias="site", max_length=100, description="Only these sites; without: all."),
]


EARLIEST_NS = 31 * NANOSECONDS_PER_DAY
"""The period before an earlier time would have no number in the database."""


async def _turn(context: Context) -> AsyncIterator[None]:
    """Hold the turn to make a report. Raises BusyError."""
    async with context.reports.admitted():
        yield


TURN = Depends(_turn)
"""One report is made at a time: each takes a process of its own, and memory."""


def until(wanted_ns: int | None) -> int:
    """Return the minute until which data is wanted, by default now. Raises ProblemError."""
    now_ns = time.time_ns()
    if wanted_ns is not None and wanted_ns > now_ns:
        raise WrongFieldError("query.until", "lies ahead")
    if wanted_ns is not None and wanted_ns < EARLIEST_NS:
        raise WrongFieldError("query.until", "expected a time after 1970-01-31")
    return minute_before(now_ns if wanted_ns is None else wanted_ns)


def report_answer(context: ApiContext, wanted: WantedReport, wanted_format: ReportFormat) -> Response:
    """Return the file. Raises ProblemError, NotFoundError, SQLAlchemyError."""
    try:
        made = make_report(ReportSource.of(context.repository, context.settings), wanted, wanted_format)
    except ReportRequestError as error:
        raise WrongFieldError(f"query.{error.parameter}", error.problem) from error
    except ReportError as error:
        raise ProblemError(HTTPStatus.SERVICE_UNAVAILABLE, str(error)) from error
    return Response(
        made.content,
        media_type=wanted_format.media_type,
        headers={
            "Content-Disposition": f'attachment; filename="{made.name}"',
            "Cache-Control": "no-store",
        },
    )
