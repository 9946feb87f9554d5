"""The page of the fleet, which is the first one."""

import gzip
from typing import Annotated

from fastapi import APIRouter, FastAPI, Query, Request
from markupsafe import Markup
from starlette.responses import HTMLResponse

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import ApiContext
from service.api.problems import WrongFieldError
from service.web.fleet.filters import LONGEST, FleetFilter
from service.web.fleet.fleet import DAYS, Fleet, Fleets, FleetView, WrittenPart
from service.web.fleet.rows import FleetRow, counts, digest
from service.web.fleet.states import FleetState
from service.web.live.routes import live_address, live_of
from service.web.live.topics import topic_of
from service.web.rendering import COMPRESSION, about_html, html_response, rendered
from service.web.view import Looking

TOPIC = topic_of("fleet")

router = APIRouter()


def install_fleet(app: FastAPI, context: ApiContext) -> None:
    """Give an application its view of the fleet."""
    app.state.fleet = Fleets(context.repository, context.settings)


@router.get("/", include_in_schema=False, dependencies=[require(Permission.VIEW)])
def get_fleet(
    view: Looking,
    site: Annotated[str | None, Query(max_length=LONGEST)] = None,
    state: Annotated[str | None, Query(max_length=LONGEST)] = None,
    text: Annotated[str, Query(max_length=LONGEST)] = "",
) -> HTMLResponse:
    """Show all motors in service, those that need attention first."""
    wanted = FleetFilter(site or None, _state_of(state), " ".join(text.split()))
    request = view.request
    fleet = _fleets_of(request).at(view.asking.sites)
    stamp = live_of(request.app).changes.stamps([TOPIC])[TOPIC]

    def write(found: FleetView) -> WrittenPart:
        return _written(fleet, found, wanted, view.now_ns)

    part = fleet.part(stamp, wanted, write)
    if view.is_htmx:
        return _answer(part, request)
    return view.page(
        "fleet/page.html",
        title="Fleet",
        live=live_address(request, "fleet"),
        fleet=fleet.view(stamp),
        filter=wanted,
        part=part,
        FleetState=FleetState,
    )


def _written(fleet: Fleet, found: FleetView, wanted: FleetFilter, now_ns: int) -> WrittenPart:
    """Write the motors that a filter chooses."""

    def write(row: FleetRow) -> Markup:
        text = rendered("fleet/row.html", row=row, picture=found.pictures[row.name], now_ns=now_ns)
        return Markup(text)  # noqa: S704 - the template has escaped all that is in it

    number = counts(found.rows)
    known = {"fleet": found, "filter": wanted, "counts": number, "days": DAYS, "now_ns": now_ns}
    first = found.rows[0].digest if found.rows else ""
    key = digest(first, number, found.silent_relays, found.latest_ns, wanted)
    summary = rendered("fleet/summary.html", key=key, **known)
    rows = fleet.written_rows(wanted.chosen(found.rows), now_ns, write)
    motors = rendered("fleet/motors.html", rows=rows, **known)
    compressed = gzip.compress((summary + motors).encode(), COMPRESSION, mtime=0)
    # The templates have escaped all that is in them.
    return WrittenPart(Markup(summary), Markup(motors), compressed)  # noqa: S704


def _answer(part: WrittenPart, request: Request) -> HTMLResponse:
    """Return the motors alone, without compressing them anew for each who looks."""
    if "gzip" not in request.headers.get("accept-encoding", ""):
        return html_response(part.text, request.headers)
    return HTMLResponse(part.compressed, headers=about_html() | {"Content-Encoding": "gzip"})


def _state_of(text: str | None) -> FleetState | None:
    """Return the state that an address names. Raises ProblemError (422)."""
    if not text:
        return None
    try:
        return FleetState(text)
    except ValueError as error:
        expected = ", ".join(FleetState)
        raise WrongFieldError("query.state", f"expected one of {expected}, found {text[:50]!r}") from error


def _fleets_of(request: Request) -> Fleets:
    fleets = request.app.state.fleet
    if not isinstance(fleets, Fleets):
        raise TypeError("the application was not made by create_site")
    return fleets
