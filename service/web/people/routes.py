"""The pages on which users are managed, and their forms. The forms call what the API's routes call."""

from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, Form, Query, Request
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access import tokens, users
from service.api.access.requirements import require
from service.api.access.schemas import MOST_SITES, NewPassword, UserChange, UserName, UserRequest
from service.storage.records import Role
from service.web.addresses import address
from service.web.forms import document_of_form
from service.web.people.users import (
    MOST_SHOWN,
    lines_of,
    people,
    roles,
    site_names,
    token_lines,
)
from service.web.view import Looking, View

router = APIRouter()

USERS: Final = [require(Permission.USERS)]

CursorText = Annotated[str | None, Query(max_length=1000)]
Roles = Annotated[list[Role] | None, Form(max_length=len(Role))]
Sites = Annotated[list[str] | None, Form(max_length=MOST_SITES)]
FullName = Annotated[str, Form(max_length=200)]
Secret = Annotated[str, Form(max_length=2000)]


@router.get("/people", dependencies=USERS)
def show_people(view: Looking, cursor: CursorText = None, tokens_cursor: CursorText = None) -> Response:
    """Show the users and the tokens of all."""
    found = people(view.context, cursor=cursor, tokens_cursor=tokens_cursor, now_ns=view.now_ns)
    known = site_names(view.context.repository)
    return view.page("people/list.html", title="People", found=found, sites=known)


@router.post("/people", dependencies=USERS)
async def add_user(
    view: Looking,
    request: Request,
    name: Annotated[str, Form(max_length=200)] = "",
    full_name: FullName = "",
    roles: Roles = None,
    sites: Sites = None,
    password: Secret = "",
) -> Response:
    """Make a user."""
    fields = {"name": name, "full_name": full_name.strip(), "password": password}
    wanted = document_of_form(UserRequest, {**fields, "roles": roles or [], "sites": sites or None})
    user = await users.add_user(view.context, request, Response(), wanted, view.asking.actor)
    return view.done(address("/people", user.name), "user-added")


@router.get("/people/{name}", dependencies=USERS)
def show_user(view: Looking, name: UserName) -> Response:
    """Show one user."""
    repository = view.context.repository
    user = repository.user(name)
    (line,) = lines_of(view.context, [user], now_ns=view.now_ns)
    found = repository.tokens(user=name, limit=MOST_SHOWN).items
    return view.page(
        "people/user.html",
        title=name,
        line=line,
        tokens=token_lines(view.context, found, now_ns=view.now_ns),
        roles=roles(),
        sites=sorted({*site_names(repository), *(user.sites or ())}),
        is_self=name == view.asking.actor.name,
    )


@router.post("/people/{name}", dependencies=USERS)
def change_user(
    view: Looking,
    name: UserName,
    full_name: FullName = "",
    roles: Roles = None,
    sites: Sites = None,
    all_sites: Annotated[bool, Form()] = False,
    disabled: Annotated[bool, Form()] = False,
) -> Response:
    """Change a user's name, roles or sites, disable or enable them."""
    fields = {
        "full_name": full_name.strip(),
        "roles": roles or [],
        "sites": sites or None,
        "all_sites": all_sites,
        "disabled": disabled,
    }
    users.change_user(view.context, name, document_of_form(UserChange, fields), view.asking.actor)
    return _done(view, name, "user-changed")


@router.post("/people/{name}/password", dependencies=USERS)
async def set_password(view: Looking, name: UserName, password: Secret = "") -> Response:
    """Give another user a password, which they change first."""
    wanted = document_of_form(NewPassword, {"password": password})
    await users.set_password(view.context, name, wanted, view.asking.actor)
    return _done(view, name, "password-set")


@router.post("/people/{name}/sessions-end", dependencies=USERS)
def end_sessions(view: Looking, name: UserName) -> Response:
    """End all sessions and all tokens of a user."""
    users.end_sessions(view.context, name, view.asking.actor)
    return _done(view, name, "sessions-ended")


@router.post("/people/{name}/unlocking", dependencies=USERS)
def unlock_user(view: Looking, name: UserName) -> Response:
    """Forget the failed logins of a user."""
    users.unlock_user(view.context, name, view.asking.actor)
    return _done(view, name, "user-unlocked")


@router.post("/people/{name}/deletion", dependencies=USERS)
def delete_user(view: Looking, name: UserName) -> Response:
    """Delete a user with their sessions and tokens."""
    users.delete_user(view.context, name, view.asking.actor)
    return view.done("/people", "user-deleted")


@router.post("/people/{name}/tokens-end", dependencies=USERS)
def revoke_tokens(view: Looking, name: UserName) -> Response:
    """End all tokens of a user."""
    tokens.revoke_tokens(view.context, name, view.asking.actor)
    return _done(view, name, "tokens-revoked")


@router.post("/people/{name}/tokens/{token_id}/revocation", dependencies=USERS)
def revoke_token(view: Looking, name: UserName, token_id: UUID) -> Response:
    """End a token of a user."""
    tokens.revoke_token(view.context, token_id, view.asking.actor)
    return _done(view, name, "token-revoked")


def _done(view: View, name: str, what: str) -> Response:
    return view.done(address("/people", name), what)
