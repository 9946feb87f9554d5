"""The pages of relays, and the form that ends a quarantine."""

from typing import Annotated, Literal

from fastapi import APIRouter, Query
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.document import Name
from service.api.relays import routes as relays
from service.storage.states import LinkState
from service.web.addresses import address
from service.web.live.routes import live_address
from service.web.pictures import markup
from service.web.relays.overview import LINK_LOOKS, RelayChoice, relay_details, relay_list
from service.web.view import Looking

router = APIRouter()

SPANS = (7, 30, 90)
"""The link is shown over so many days."""

Text = Annotated[str | None, Query(max_length=200)]
CursorText = Annotated[str | None, Query(max_length=1000)]


@router.get("/relays", dependencies=[require(Permission.VIEW)])
def show_relays(
    view: Looking,
    site: Text = None,
    link: LinkState | Literal[""] | None = None,
    text: Text = None,
    cursor: CursorText = None,
) -> Response:
    """Show all relays, by name."""
    choice = RelayChoice(
        site or None, LinkState(link) if link else None, (text or "").strip() or None, cursor or None
    )
    live = live_address(view.request, "relays")
    found = relay_list(view.context.repository, view.context.settings, choice)
    return view.page(
        "relays/list.html",
        live=live,
        title="Relays",
        found=found,
        limits=view.context.settings.alarms,
        link_states=list(LINK_LOOKS),
    )


@router.get("/relays/{name}", dependencies=[require(Permission.VIEW)])
def show_relay(
    view: Looking, name: Name, days: Annotated[int, Query(ge=1, le=366)] = 30, cursor: CursorText = None
) -> Response:
    """Show one relay."""
    live = live_address(view.request, "relays")
    details = relay_details(view.context, name, days=days, cursor=cursor, now_ns=view.now_ns)
    return view.page(
        "relays/relay.html",
        live=live,
        title=name,
        details=details,
        picture=markup(details.picture),
        limits=view.context.settings.alarms,
        spans=SPANS,
    )


@router.post("/relays/{name}/release", dependencies=[require(Permission.RELEASE)])
def release_relay(view: Looking, name: Name) -> Response:
    """Have a relay visited again that was set aside."""
    relays.release_ied(view.context, name, view.asking.actor)
    return view.done(address("/relays", name), "released")
