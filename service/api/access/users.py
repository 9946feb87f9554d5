"""Users, as those see them who manage them."""

import time
from functools import partial
from http import HTTPStatus

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool

from core.time_stamps import rfc3339
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.access.schemas import NewPassword, User, UserChange, UserName, UserRequest
from service.api.access.sessions import hash_of, keep_password
from service.api.context import ApiContext, Context
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.storage.errors import NotOwnPasswordError
from service.storage.records import User as StoredUser

router = APIRouter(prefix="/users", tags=["access"], dependencies=[])


@router.get("", responses=problems(), dependencies=[require(Permission.USERS)])
def list_users(context: Context, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None) -> Page[User]:
    """Return the users, by name."""
    return page(context.repository.users(limit=limit, after=decode(cursor, str)), partial(_document, context))


@router.post(
    "",
    status_code=HTTPStatus.CREATED,
    responses=problems(400, 409, 413)
    | {201: {"headers": {"Location": {"schema": {"type": "string"}, "description": "The user."}}}},
    dependencies=[require(Permission.USERS)],
)
async def add_user(
    context: Context, request: Request, response: Response, wanted: UserRequest, caller: By
) -> User:
    """Make a user. Somebody else's choice of a password is changed before anything is done with it."""
    kept = None
    if wanted.password is not None:
        kept = await hash_of(context, wanted.password, wanted.name, wanted.full_name, "body.password")
    user = await run_in_threadpool(
        partial(
            context.repository.add_user,
            wanted.name,
            wanted.roles,
            password=kept,
            sites=wanted.sites,
            full_name=wanted.full_name,
            by=caller,
            now_ns=time.time_ns(),
        )
    )
    response.headers["Location"] = request.url_for("get_user", name=user.name).path
    return User.model_validate(user)


@router.get("/{name}", responses=problems(404), dependencies=[require(Permission.USERS)])
def get_user(context: Context, name: UserName) -> User:
    """Return one user."""
    return _document(context, context.repository.user(name))


@router.patch("/{name}", responses=problems(400, 404, 409, 413), dependencies=[require(Permission.USERS)])
def change_user(context: Context, name: UserName, wanted: UserChange, caller: By) -> User:
    """Change a user's name, roles or sites, disable or enable them.

    Other roles or sites end their sessions, being disabled their tokens, too.
    """
    user = context.repository.change_user(
        name,
        roles=wanted.roles,
        sites=wanted.sites,
        at_all_sites=wanted.all_sites,
        disabled=wanted.disabled,
        full_name=wanted.full_name,
        by=caller,
        now_ns=time.time_ns(),
    )
    return _document(context, user)


@router.put(
    "/{name}/password",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.USERS)],
)
async def set_password(context: Context, name: UserName, wanted: NewPassword, caller: By) -> None:
    """Give another user a password, which they change first; their sessions and tokens end."""
    if name == caller.name:  # whose token asks would get a session by it, which may do more
        instead = "it is your own: PUT /api/v1/account/password (mcc password) asks for the old one"
        raise NotOwnPasswordError(name, instead)
    await keep_password(context, name, wanted.password, "body.password", by=caller)


@router.delete(
    "/{name}/sessions",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.USERS)],
)
def end_sessions(context: Context, name: UserName, caller: By) -> None:
    """End all sessions and all tokens of a user."""
    context.repository.end_sessions_of(name, by=caller, now_ns=time.time_ns())


@router.delete(
    "/{name}/lock",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.USERS)],
)
def unlock_user(context: Context, name: UserName, caller: By) -> None:
    """Forget the failed logins of a user, so that they may try again at once."""
    context.repository.unlock_user(name, by=caller, now_ns=time.time_ns())


@router.delete(
    "/{name}",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404, 409),
    dependencies=[require(Permission.USERS)],
)
def delete_user(context: Context, name: UserName, caller: By) -> None:
    """Delete a user with their sessions and tokens; what they did stays in the audit trail."""
    context.repository.delete_user(name, by=caller, now_ns=time.time_ns())


def _document(context: ApiContext, user: StoredUser) -> User:
    until_ns = context.repository.locked_until(user.name, now_ns=time.time_ns())
    document = User.model_validate(user)
    return document.model_copy(update={"locked_until_time": None if until_ns is None else rfc3339(until_ns)})
