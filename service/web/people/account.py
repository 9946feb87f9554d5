"""The page of the own account: who one is here, the own password and tokens."""

from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, Form, Request
from starlette.responses import Response

from service.access.identities import Way
from service.access.passwords import PASSWORD_RULE
from service.access.permissions import MEANINGS, Permission
from service.access.second_factors import is_required
from service.api.access import sessions, tokens
from service.api.access.requirements import require
from service.api.access.schemas import PasswordChange
from service.api.problems import WrongFieldError
from service.storage import NotFoundError
from service.web.forms import document_of_form
from service.web.people.passkeys import origin_of_passkeys
from service.web.people.token_form import TokenForm, show_new_token, token_request
from service.web.people.users import MOST_SHOWN, lifetimes, scope_choices, site_names, token_lines
from service.web.view import Looking

router = APIRouter()

ACCOUNT: Final = [require(Permission.ACCOUNT)]
Secret = Annotated[str, Form(max_length=2000)]


@router.get("/account", dependencies=ACCOUNT)
def show_account(view: Looking) -> Response:
    """Show who looks, and what they may do."""
    repository, asking = view.context.repository, view.asking
    account = sessions.get_account(view.context, asking)
    try:
        user = repository.user(asking.actor.name)
    except NotFoundError:  # known to a proxy, or nobody yet
        user = None
    origin, no_passkeys = origin_of_passkeys(view.context)
    found = [] if user is None else repository.tokens(user=user.name, limit=MOST_SHOWN).items
    return view.page(
        "people/account.html",
        title="Account",
        account=account,
        known=user is not None,
        has_password=user is not None and user.has_password,
        is_factor_required=is_required(view.context.settings.access, asking.actor.roles),
        passkeys=repository.passkeys(asking.actor.name),
        passkey_origin=origin,
        no_passkeys=no_passkeys,
        is_nobody=asking.way is Way.NONE,
        meanings=[(one.value, MEANINGS[one]) for one in account.permissions],
        tokens=token_lines(view.context, found, now_ns=view.now_ns),
        scopes=scope_choices(asking.permissions),
        sites=[one for one in site_names(repository) if asking.sites is None or one in asking.sites],
        lifetimes=lifetimes(view.context.settings.access),
        rule=PASSWORD_RULE,
    )


@router.post("/account/password", dependencies=ACCOUNT)
async def change_password(
    view: Looking, request: Request, old: Secret = "", new: Secret = "", again: Secret = ""
) -> Response:
    """Change the own password; all own sessions end, this one too, and all own tokens."""
    if new != again:
        message = "expected the same password twice, found two"
        raise WrongFieldError("body.again", message)
    wanted = document_of_form(PasswordChange, {"old": old, "new": new})
    await sessions.change_password(view.context, request, view.asking, wanted)
    return view.done("/login", "password")


@router.post("/account/tokens", dependencies=ACCOUNT)
def add_own_token(view: Looking, form: Annotated[TokenForm, Form()]) -> Response:
    """Make an own token, and show its secret this once."""
    made = tokens.add_own_token(view.context, view.asking, token_request(form, view.now_ns))
    return show_new_token(view, made, "/account")


@router.post("/account/tokens-end", dependencies=ACCOUNT)
def revoke_own_tokens(view: Looking) -> Response:
    """End all of the own tokens."""
    tokens.revoke_own_tokens(view.context, view.asking.actor)
    return view.done("/account", "tokens-revoked")


@router.post("/account/tokens/{token_id}/revocation", dependencies=ACCOUNT)
def revoke_own_token(view: Looking, token_id: UUID) -> Response:
    """End one of the own tokens."""
    tokens.revoke_own_token(view.context, token_id, view.asking.actor)
    return view.done("/account", "token-revoked")
