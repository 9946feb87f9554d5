"""Tokens for programs: the own ones, and those of all users for who manages them."""

import time
from http import HTTPStatus
from uuid import UUID

from fastapi import APIRouter

from service.access.bearer_secrets import digest_of, new_token
from service.access.permissions import Permission
from service.api.access.callers import Asking, By
from service.api.access.requirements import require
from service.api.access.schemas import NewToken, Token, TokenRequest, UserName
from service.api.context import ApiContext, Context
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import WrongFieldError, problems
from service.storage.records import Actor, ApiToken

router = APIRouter(tags=["access"])


@router.get("/account/tokens", responses=problems(), dependencies=[require(Permission.ACCOUNT)])
def list_own_tokens(
    context: Context, caller: By, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[Token]:
    """Return the own tokens, without their secrets."""
    found = context.repository.tokens(user=caller.name, limit=limit, after=decode(cursor, str))
    return page(found, _document)


@router.post(
    "/account/tokens",
    status_code=HTTPStatus.CREATED,
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.ACCOUNT)],
)
def add_own_token(context: Context, asking: Asking, wanted: TokenRequest) -> NewToken:
    """Make a token that may do no more than who asks for it. Its secret is shown this once."""
    scope = wanted.scope
    beyond = sorted(permission.value for permission in (scope or set()) - asking.permissions)
    if beyond:
        message = f"expected permissions that you have yourself, found {', '.join(beyond)}"
        raise WrongFieldError("body.scope", message)
    if scope is None and asking.way == "token":  # a narrow token makes no wide one
        scope = set(asking.permissions)
    return _add(context, asking.actor.name, wanted.model_copy(update={"scope": scope}), asking.actor)


@router.delete(
    "/account/tokens/{token_id}",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.ACCOUNT)],
)
def revoke_own_token(context: Context, token_id: UUID, caller: By) -> None:
    """End one of the own tokens."""
    context.repository.revoke_token(str(token_id), user=caller.name, by=caller, now_ns=time.time_ns())


@router.get("/tokens", responses=problems(), dependencies=[require(Permission.USERS)])
def list_tokens(context: Context, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None) -> Page[Token]:
    """Return the tokens of all users, without their secrets."""
    return page(context.repository.tokens(user=None, limit=limit, after=decode(cursor, str)), _document)


@router.post(
    "/users/{name}/tokens",
    status_code=HTTPStatus.CREATED,
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.USERS)],
)
def add_token(context: Context, name: UserName, wanted: TokenRequest, caller: By) -> NewToken:
    """Make a token of a user, such as one that stands for a program. Its secret is shown this once."""
    return _add(context, name, wanted, caller)


@router.delete(
    "/tokens/{token_id}",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.USERS)],
)
def revoke_token(context: Context, token_id: UUID, caller: By) -> None:
    """End a token of whomever."""
    context.repository.revoke_token(str(token_id), user=None, by=caller, now_ns=time.time_ns())


def _add(context: ApiContext, user: str, wanted: TokenRequest, by: Actor) -> NewToken:
    now_ns = time.time_ns()
    if wanted.expires_time is not None and wanted.expires_time <= now_ns:
        message = "expected a time that is still to come"
        raise WrongFieldError("body.expires_time", message)
    secret = new_token()
    kept = context.repository.add_token(
        user,
        wanted.label,
        digest_of(secret),
        scope=wanted.scope,
        expires_ns=wanted.expires_time,
        by=by,
        now_ns=now_ns,
    )
    return NewToken(**_document(kept).model_dump(), token=secret)


def _document(token: ApiToken) -> Token:
    return Token.model_validate(token)
