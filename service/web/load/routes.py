"""The page of how a motor was loaded."""

from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.document import Name
from service.api.load.routes import MOST_DAYS, USUAL_DAYS
from service.web.load.load import SPANS, load_page
from service.web.view import Looking

router = APIRouter()


@router.get("/motors/{name}/load", dependencies=[require(Permission.VIEW)])
def show_load(
    view: Looking, name: Name, days: Annotated[int, Query(ge=1, le=MOST_DAYS)] = USUAL_DAYS
) -> Response:
    """Show how a motor was loaded in the last days, and how hot that makes it."""
    view.context.require_motor(name)
    context = view.context
    here = context.motors.get(name)
    thermal = None if here is None else here.thermal
    energy = context.settings.energy
    found = load_page(context.repository, name, days=days, now_ns=view.now_ns, energy=energy, thermal=thermal)
    return view.page("load/page.html", title=f"{name}: load", motor=name, days=days, spans=SPANS, found=found)
