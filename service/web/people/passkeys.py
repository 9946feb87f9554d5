"""Forms of passkeys. A script of ours has the browser ask the device, and fills in what it answers."""

from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, Form, Request
from starlette.responses import Response

from service.access.passkeys import LONGEST_ANSWER
from service.access.permissions import Permission
from service.api.access import passkeys
from service.api.access.requirements import require
from service.api.access.schemas import OwnPassword, PasskeyAnswer
from service.api.context import ApiContext
from service.api.problems import ProblemError, WrongFieldError
from service.web.forms import document_of_form
from service.web.people.second_factor import show_codes
from service.web.view import Looking

router = APIRouter()

ACCOUNT: Final = [require(Permission.ACCOUNT)]
Secret = Annotated[str, Form(max_length=2000)]


@router.post("/account/passkeys", dependencies=ACCOUNT)
def add_passkey(
    view: Looking, label: Secret = "", answer: Annotated[str, Form(max_length=LONGEST_ANSWER)] = ""
) -> Response:
    """Keep a passkey, and show the recovery codes of who had none."""
    if not answer:
        raise WrongFieldError("body.answer", "expected what a device answers: allow this page its scripts")
    wanted = document_of_form(PasskeyAnswer, {"label": label, "answer": answer})
    made = passkeys.add_passkey(view.context, view.asking, wanted)
    if made.recovery_codes:
        return show_codes(view, made.recovery_codes, "/account")
    return view.done("/account", "passkey-added")


@router.post("/account/passkeys/{passkey_id}/removal", dependencies=ACCOUNT)
async def remove_passkey(
    view: Looking, request: Request, passkey_id: UUID, password: Secret = ""
) -> Response:
    """Remove an own passkey."""
    wanted = document_of_form(OwnPassword, {"password": password})
    await passkeys.remove_passkey(view.context, request, view.asking, passkey_id, wanted)
    return view.done("/account", "passkey-removed")


def origin_of_passkeys(context: ApiContext) -> tuple[str | None, str | None]:
    """Return at which origin browsers use passkeys of the service; else None, and why not."""
    try:
        return passkeys.place_of(context).origin, None
    except ProblemError as error:
        return None, error.detail
