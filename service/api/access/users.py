"""Users, as those see them who manage them."""

import time
from functools import partial
from http import HTTPStatus

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool

from service.access.passwords import hashed
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.access.schemas import NewPassword, User, UserChange, UserName, UserRequest
from service.api.access.sessions import keep_password, refuse_unusable
from service.api.context import ApiContext, Context
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
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
    """Make a user."""
    kept = None
    if wanted.password is not None:
        refuse_unusable(wanted.password, wanted.name, "body.password")
        async with context.passwords.admitted():
            kept = await run_in_threadpool(hashed, wanted.password)
    user = await run_in_threadpool(
        partial(
            context.repository.add_user,
            wanted.name,
            wanted.roles,
            password=kept,
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
    """Change a user's name or roles, disable or enable them; other roles end their sessions."""
    user = context.repository.change_user(
        name,
        roles=wanted.roles,
        disabled=wanted.disabled,
        full_name=wanted.full_name,
        by=caller,
        now_ns=time.time_ns(),
    )
    return _document(context, user)


@router.put(
    "/{name}/password",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(400, 404, 413),
    dependencies=[require(Permission.USERS)],
)
async def set_password(context: Context, name: UserName, wanted: NewPassword, caller: By) -> None:
    """Give a user another password; their sessions end."""
    refuse_unusable(wanted.password, name, "body.password")
    await keep_password(context, name, wanted.password, by=caller)


@router.delete(
    "/{name}/sessions",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.USERS)],
)
def end_sessions(context: Context, name: UserName, caller: By) -> None:
    """End all sessions of a user; their tokens stay."""
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
    if until_ns is None:
        return document
    return User.model_validate(
        {
            **{name: getattr(user, name) for name in StoredUser.__slots__},
            "locked_until_time": until_ns,
        }
    )
