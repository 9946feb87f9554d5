"""The pages of recorded starts."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import RedirectResponse, Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.document import Name
from service.web.addresses import address
from service.web.live.routes import live_address
from service.web.starts.starts import all_starts, starts_of_motor
from service.web.view import Looking

router = APIRouter()

Cursor = Annotated[str | None, Query(max_length=1000)]


@router.get("/motors/{name}/starts", dependencies=[require(Permission.VIEW)])
def show_starts_of_motor(view: Looking, name: Name, cursor: Cursor = None) -> Response:
    """Show a motor's starts, the latest ones over its reference."""
    live = live_address(view.request, f"motor:{name}")
    found = starts_of_motor(view.context.repository, name, cursor or None)
    here = address("/motors", name, "starts", cursor=cursor)
    return view.page(
        "starts/motor.html", title=f"{name}: starts", motor=name, found=found, here=here, live=live
    )


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
