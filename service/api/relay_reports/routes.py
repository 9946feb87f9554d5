"""Text reports of a motor's relay, which people bring: one way in for all kinds."""

import time
from typing import Annotated, Final

from fastapi import APIRouter, Body, Query

from core.relay_reports.clock_times import DateOrder
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name
from service.api.limits.body_limits import MAX_REPORT_BYTES, REPORT_TYPE
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.relay_reports.keeping import keep_brought
from service.api.relay_reports.schemas import RelayEventEntry, ReportImport
from service.plant import PowerUnit

router = APIRouter(prefix="/motors/{name}", tags=["motors"])

REPORT_ROUTES: Final = frozenset({("POST", "/motors/{name}/reports")})
"""Routes that take a relay's report as text."""

OrderOfDates = Annotated[DateOrder, Query(description="Order of its dates: the relay's setting DATE_F.")]
UnitOfPower = Annotated[
    PowerUnit | None, Query(description="Unit of P and Q in a load profile; without it they are left out.")
]


@router.get("/relay-events", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_relay_events(
    context: Context, name: Name, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[RelayEventEntry]:
    """Return starts, stops and trips that the relay's sequences of events told, latest first."""
    return page(
        context.repository.relay_event_page(name, limit=limit, after=decode(cursor, int, str)),
        RelayEventEntry.model_validate,
    )


@router.post(
    "/reports",
    responses=problems(404, 409, 413, 415),
    dependencies=[require(Permission.RECORDINGS)],
)
def import_report(
    context: Context,
    name: Name,
    caller: By,
    report: Annotated[
        bytes,
        Body(
            media_type=REPORT_TYPE,
            min_length=1,
            max_length=MAX_REPORT_BYTES,
            description="A report (MSR, LDP, MOT, SER), as the relay sends it or as a terminal showed it.",
        ),
    ],
    date_order: OrderOfDates = DateOrder.MDY,
    power_unit: UnitOfPower = None,
) -> ReportImport:
    """Keep what a text report of a motor's relay tells: starts, load, statistics, events."""
    return keep_brought(
        context,
        name,
        report,
        date_order=date_order,
        power_unit=power_unit,
        by=caller,
        now_ns=time.time_ns(),
    )
