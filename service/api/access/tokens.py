"""Tokens for programs: everybody makes their own; who manages users sees and ends those of all."""

import time
from functools import partial
from http import HTTPStatus
from uuid import UUID

from fastapi import APIRouter

from service.access.bearer_secrets import digest_of, new_token
from service.access.identities import Way
from service.access.permissions import Permission
from service.access.reach import is_within
from service.access.tokens import TokenLifetimeError, as_it_counts, end_of
from service.api.access.callers import Asking, By, Caller
from service.api.access.requirements import require
from service.api.access.schemas import NewToken, Token, TokenRequest, UserName
from service.api.context import ApiContext, Context
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import ProblemError, WrongFieldError, problems
from service.storage.records import ApiToken

router = APIRouter(tags=["access"])


@router.get("/account/tokens", responses=problems(), dependencies=[require(Permission.ACCOUNT)])
def list_own_tokens(
    context: Context, caller: By, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[Token]:
    """Return the own tokens, without their secrets."""
    found = context.repository.tokens(user=caller.name, limit=limit, after=decode(cursor, str))
    return page(found, partial(_document, context))


@router.post(
    "/account/tokens",
    status_code=HTTPStatus.CREATED,
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.ACCOUNT)],
)
def add_own_token(context: Context, asking: Asking, wanted: TokenRequest) -> NewToken:
    """Make a token that may do no more than who asks, nor for longer. Its secret is shown this once."""
    _require_second_factor(asking)
    scope = wanted.scope
    beyond = sorted(permission.value for permission in (scope or set()) - asking.permissions)
    if beyond:
        message = f"expected permissions that you have yourself, found {', '.join(beyond)}"
        raise WrongFieldError("body.scope", message)
    if scope is None and asking.way is not Way.SESSION:  # a token or a proxy may give less than the roles
        scope = set(asking.permissions)
    sites = wanted.sites
    if sites is not None and not is_within(sites, asking.sites):
        raise WrongFieldError("body.sites", f"expected sites of yours, found {', '.join(sorted(sites))}")
    if sites is None and asking.way is not Way.SESSION:
        sites = None if asking.sites is None else set(asking.sites)
    now_ns = time.time_ns()
    try:
        expires_ns = end_of(wanted.expires_time, context.settings.access, parent=asking.token, now_ns=now_ns)
    except TokenLifetimeError as error:
        raise WrongFieldError("body.expires_time", str(error)) from error
    secret = new_token()
    kept = context.repository.add_token(
        asking.actor.name,
        wanted.label,
        digest_of(secret),
        scope=scope,
        sites=sites,
        expires_ns=expires_ns,
        parent=None if asking.token is None else asking.token.id,
        by=asking.actor,
        now_ns=now_ns,
    )
    return NewToken(**_document(context, kept).model_dump(), token=secret)


@router.delete(
    "/account/tokens",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.ACCOUNT)],
)
def revoke_own_tokens(context: Context, caller: By) -> None:
    """End all of the own tokens."""
    context.repository.revoke_tokens(caller.name, by=caller, now_ns=time.time_ns())


@router.delete(
    "/account/tokens/{token_id}",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.ACCOUNT)],
)
def revoke_own_token(context: Context, token_id: UUID, caller: By) -> None:
    """End one of the own tokens, and those that were made with it."""
    context.repository.revoke_token(str(token_id), user=caller.name, by=caller, now_ns=time.time_ns())


@router.get("/tokens", responses=problems(), dependencies=[require(Permission.USERS)])
def list_tokens(context: Context, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None) -> Page[Token]:
    """Return the tokens of all users, without their secrets."""
    found = context.repository.tokens(user=None, limit=limit, after=decode(cursor, str))
    return page(found, partial(_document, context))


@router.delete(
    "/users/{name}/tokens",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.USERS)],
)
def revoke_tokens(context: Context, name: UserName, caller: By) -> None:
    """End all tokens of a user; their sessions stay."""
    context.repository.revoke_tokens(name, by=caller, now_ns=time.time_ns())


@router.delete(
    "/tokens/{token_id}",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.USERS)],
)
def revoke_token(context: Context, token_id: UUID, caller: By) -> None:
    """End a token of whomever, and those that were made with it."""
    context.repository.revoke_token(str(token_id), user=None, by=caller, now_ns=time.time_ns())


def _require_second_factor(asking: Caller) -> None:
    """Raise ProblemError (403) for who needs a second factor and has not shown it."""
    if not asking.may_make_tokens:
        raise ProblemError(
            HTTPStatus.FORBIDDEN,
            "your account needs a second factor, and tokens are made by a login with it alone: log in "
            "(mcc login), and set up the second factor where there is none (/account)",
        )


def _document(context: ApiContext, token: ApiToken) -> Token:
    return Token.model_validate(as_it_counts(token, context.settings.access))
