"""The page of the plant."""

from typing import Annotated

from fastapi import APIRouter, Query
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.web.plant.certificates import used_certificates
from service.web.plant.differing import files_and_relays
from service.web.plant.limits import limit_groups
from service.web.plant.motors import MotorChoice, motor_list
from service.web.view import Looking

router = APIRouter()

Text = Annotated[str | None, Query(max_length=200)]


@router.get("/plant", dependencies=[require(Permission.VIEW)])
def show_plant(
    view: Looking,
    site: Text = None,
    text: Text = None,
    cursor: Annotated[str | None, Query(max_length=1000)] = None,
) -> Response:
    """Show what the plant's files say against what its relays say, and the limits that are in force."""
    repository = view.context.repository
    choice = MotorChoice(site or None, (text or "").strip() or None, cursor or None)
    return view.page(
        "plant/plant.html",
        title="Plant",
        found=motor_list(repository, choice, now_ns=view.now_ns),
        compared=files_and_relays(repository),
        sites=repository.sites(limit=1000).items,
        groups=limit_groups(view.context.settings),
        certificates=used_certificates(view.context.settings),
        certificate_days=view.context.settings.alarms.certificate_days,
    )
