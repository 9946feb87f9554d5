"""The page of the fleet, which is the first one."""

import gzip
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, FastAPI, Query, Request
from markupsafe import Markup
from starlette.responses import HTMLResponse, RedirectResponse, Response

from core.motor_condition.parts import Part
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import ApiContext
from service.api.problems import WrongFieldError
from service.web.addresses import address
from service.web.fleet.filters import BY_SITE, LONGEST, FleetFilter
from service.web.fleet.fleet import DAYS, Fleet, Fleets, FleetView, WrittenPart
from service.web.fleet.groups import SiteGroup, site_groups
from service.web.fleet.rows import FleetRow, counts, digest, parts_not_assessed
from service.web.fleet.search import MOST_FOUND, relays_with
from service.web.fleet.states import FleetState
from service.web.live.routes import live_address, live_of
from service.web.live.topics import topic_of
from service.web.rendering import COMPRESSION, about_html, html_response, rendered
from service.web.view import Looking, View

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
    not_assessed: Annotated[str, Query(max_length=LONGEST)] = "",
    group: Annotated[str, Query(max_length=LONGEST)] = "",
) -> HTMLResponse:
    """Show all motors in service, those that need attention first."""
    wanted = FleetFilter(
        site or None, _state_of(state), " ".join(text.split()), not_assessed, group == BY_SITE
    )
    request = view.request
    fleet, stamp = _fleet_now(view)

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
        parts=[part.words for part in Part],
    )


@router.get("/wall", include_in_schema=False, dependencies=[require(Permission.VIEW)])
def get_wall(view: Looking, site: Annotated[str | None, Query(max_length=LONGEST)] = None) -> HTMLResponse:
    """Show all motors as large tiles, for a screen on a wall that nobody touches."""
    live = live_address(view.request, "fleet")
    fleet, stamp = _fleet_now(view)
    wanted = FleetFilter(site or None)
    rows = wanted.chosen(fleet.view(stamp).rows)
    here = address("/wall", site=wanted.site)
    return view.page(
        "fleet/wall.html",
        title="Wall",
        live=live,
        rows=rows,
        counts=counts(rows),
        silent=parts_not_assessed(rows),
        site=wanted.site,
        here=here,
    )


@router.get("/search", include_in_schema=False, dependencies=[require(Permission.VIEW)])
def search(view: Looking, text: Annotated[str, Query(max_length=LONGEST)] = "") -> Response:
    """Show the motors and relays that have all words of a text; go to the one that is alone."""
    words = text.casefold().split()
    fleet, stamp = _fleet_now(view)
    motors = FleetFilter(text=text).chosen(fleet.view(stamp).rows) if words else []
    relays = relays_with(view.context.repository, words) if words else []
    named = [row for row in motors if row.name.casefold() == " ".join(words)] or motors
    if len(named) == 1 and (not relays or named is not motors):
        return RedirectResponse(address("/motors", named[0].name), status_code=HTTPStatus.SEE_OTHER)
    if not motors and len(relays) == 1:
        return RedirectResponse(address("/relays", relays[0].name), status_code=HTTPStatus.SEE_OTHER)
    return view.page(
        "fleet/search.html",
        title="Search",
        search=text,
        motors=motors[:MOST_FOUND],
        relays=relays,
        more=len(motors) - MOST_FOUND,
    )


def _fleet_now(view: View) -> tuple[Fleet, str]:
    """Return the fleet at the sites of who looks, and the stamp of what is to be seen now."""
    stamp = live_of(view.request.app).changes.stamps([TOPIC])[TOPIC]
    return _fleets_of(view.request).at(view.asking.sites), stamp


def _written(fleet: Fleet, found: FleetView, wanted: FleetFilter, now_ns: int) -> WrittenPart:
    """Write the motors that a filter chooses."""

    def write(row: FleetRow) -> Markup:
        text = rendered("fleet/row.html", row=row, picture=found.pictures[row.name], now_ns=now_ns)
        return Markup(text)  # noqa: S704 - the template has escaped all that is in it

    number = counts(found.rows)
    silent = parts_not_assessed(found.rows)
    known = {"fleet": found, "filter": wanted, "counts": number, "days": DAYS, "now_ns": now_ns}
    first = found.rows[0].digest if found.rows else ""
    key = digest(first, number, silent, found.silent_relays, found.latest_ns, wanted)
    summary = rendered("fleet/summary.html", key=key, silent=silent, **known)
    chosen = wanted.chosen(found.rows)
    rows = fleet.written_rows(chosen, now_ns, write)
    groups = site_groups(chosen, rows) if wanted.by_site else [SiteGroup("", "", "", rows)]
    motors = rendered("fleet/motors.html", groups=groups, shown=len(rows), **known)
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
