"""The page of the recorded starts of all motors."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import RedirectResponse, Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.web.addresses import address
from service.web.live.routes import live_address
from service.web.starts.starts import all_starts
from service.web.view import Looking

router = APIRouter()

Cursor = Annotated[str | None, Query(max_length=1000)]


@router.get("/starts", dependencies=[require(Permission.VIEW)])
def show_starts(
    view: Looking, cursor: Cursor = None, motor: Annotated[str | None, Query(max_length=200)] = None
) -> Response:
    """Show the latest starts of all motors; those of one motor have a page of their own."""
    if motor:
        view.context.require_motor(motor)
        return RedirectResponse(address("/motors", motor, "starts"), status_code=HTTPStatus.SEE_OTHER)
    live = live_address(view.request, "recordings")
    found = all_starts(view.context.repository, cursor or None)
    here = address("/starts", cursor=cursor)
    return view.page("starts/all.html", title="Starts", found=found, here=here, live=live)
