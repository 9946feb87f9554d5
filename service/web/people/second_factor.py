"""Pages of the second factor: the picture for an authenticator app, and codes that are shown once."""

from typing import Annotated, Final

import segno
from fastapi import APIRouter, Form, Request
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access import second_factor
from service.api.access.requirements import require
from service.api.access.schemas import FactorCode, OwnPassword, UserName
from service.web.addresses import address
from service.web.forms import document_of_form
from service.web.view import Looking, View

router = APIRouter()

ACCOUNT: Final = [require(Permission.ACCOUNT)]
Secret = Annotated[str, Form(max_length=2000)]

PICTURE_SCALE: Final = 5
"""Pixels of a dot."""


@router.post("/account/totp", dependencies=ACCOUNT)
async def propose_totp(view: Looking, request: Request, password: Secret = "") -> Response:
    """Show a new secret for an authenticator app, and ask for a code of it."""
    wanted = document_of_form(OwnPassword, {"password": password})
    made = await second_factor.propose_totp(view.context, request, view.asking, wanted)
    picture = segno.make(made.uri, micro=False).svg_data_uri(scale=PICTURE_SCALE, light="white")
    return _once(
        view.page("people/totp.html", title="Authenticator app", secret=made.secret, picture=picture)
    )


@router.post("/account/totp/confirmation", dependencies=ACCOUNT)
def confirm_totp(view: Looking, code: Secret = "") -> Response:
    """Have the app count whose code this is, and show the recovery codes."""
    wanted = document_of_form(FactorCode, {"code": code})
    made = second_factor.confirm_totp(view.context, view.asking, wanted)
    return show_codes(view, made.recovery_codes, "/account")


@router.post("/account/recovery-codes", dependencies=ACCOUNT)
async def make_recovery_codes(view: Looking, request: Request, password: Secret = "") -> Response:
    """Show other recovery codes."""
    wanted = document_of_form(OwnPassword, {"password": password})
    made = await second_factor.make_recovery_codes(view.context, request, view.asking, wanted)
    return show_codes(view, made.recovery_codes, "/account")


@router.post("/account/second-factor/removal", dependencies=ACCOUNT)
async def remove_second_factor(view: Looking, request: Request, password: Secret = "") -> Response:
    """Remove the own second factor."""
    wanted = document_of_form(OwnPassword, {"password": password})
    await second_factor.remove_second_factor(view.context, request, view.asking, wanted)
    return view.done("/account", "second-factor-removed")


@router.post("/people/{name}/second-factor/reset", dependencies=[require(Permission.USERS)])
def reset_second_factor(view: Looking, name: UserName) -> Response:
    """Remove a user's second factor, and show the code that lets them in once."""
    made = second_factor.reset_second_factor(view.context, name, view.asking.actor)
    return show_codes(view, [made.code], address("/people", name), user=name)


def show_codes(view: View, codes: list[str], back: str, *, user: str | None = None) -> Response:
    """Return the page with codes. user: to whom one is handed; None for one's own."""
    return _once(view.page("people/codes.html", title="Codes", codes=codes, back=back, handed_to=user))


def _once(answer: Response) -> Response:
    """Return a page with what is shown once; its address is not one to come back to."""
    answer.headers["HX-Push-Url"] = "false"
    return answer
