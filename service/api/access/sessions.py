"""Logging in and out, and the own account."""

import time
from functools import partial
from http import HTTPStatus

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool

from service.access import logins
from service.access.passwords import PASSWORD_RULE, hashed, is_usable
from service.access.permissions import Permission, permissions_of
from service.api.access.callers import FIRST_USER, Asking
from service.api.access.client_address import ClientAddress, client_address, counted_address
from service.api.access.cookies import clear_session, set_session
from service.api.access.requirements import open_to_all, require
from service.api.access.schemas import Account, LoginRequest, LoginWays, PasswordChange
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, WrongFieldError, problems
from service.storage import NotFoundError
from service.storage.records import Actor, User

router = APIRouter(tags=["access"])

OIDC_PATH = "/api/v1/login/oidc"


@router.get("/login", responses=problems(), dependencies=[open_to_all()])
def get_login_ways(context: Context) -> LoginWays:
    """Return how one logs in here."""
    return LoginWays(password=True, oidc=OIDC_PATH if context.settings.access.oidc else None)


@router.post("/login", responses=problems(400, 413, 429), dependencies=[open_to_all()])
async def log_in(context: Context, request: Request, response: Response, wanted: LoginRequest) -> Account:
    """Begin a session, with a name and a password; the answer's cookie is its secret."""
    user = await begin_session(context, request, response, wanted.name, wanted.password)
    return Account(
        name=user.name,
        full_name=user.full_name,
        roles=sorted(user.roles),
        permissions=sorted(permissions_of(user.roles)),
        way="session",
    )


async def begin_session(
    context: ApiContext, request: Request, response: Response, name: str, password: str
) -> User:
    """Begin a session of who knows a user's password: the response gets its cookie.

    Raises ProblemError (401, 403), LoginLockedError, BusyError.
    """
    origin = client_address(request.scope, context.settings.access.proxy)
    if not await run_in_threadpool(context.repository.has_users):
        raise ProblemError(HTTPStatus.FORBIDDEN, FIRST_USER)
    account = logins.account_of(name)
    await _check(context, account, password, origin)
    user = await run_in_threadpool(_user, context, account)
    by = Actor(user.name, origin.address, user.roles)
    secret = await run_in_threadpool(
        partial(
            logins.begin_session,
            context.repository,
            context.settings.access,
            by,
            "password",
            now_ns=time.time_ns(),
        )
    )
    seconds = context.settings.access.session_hours * 3600
    set_session(response, secret, seconds=seconds, encrypted=origin.is_encrypted)
    response.headers["Cache-Control"] = "no-store"
    return user


@router.post(
    "/logout",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(),
    dependencies=[require(Permission.ACCOUNT)],
)
def log_out(context: Context, request: Request, response: Response, asking: Asking) -> None:
    """End the session that the request has; harmless without one."""
    if asking.session is not None:
        context.repository.end_session(asking.session, by=asking.actor, now_ns=time.time_ns())
    origin = client_address(request.scope, context.settings.access.proxy)
    clear_session(response, encrypted=origin.is_encrypted)


@router.get("/account", responses=problems(), dependencies=[require(Permission.ACCOUNT)])
def get_account(context: Context, asking: Asking) -> Account:
    """Return who asks, and what they may do."""
    try:
        full_name = context.repository.user(asking.actor.name).full_name
    except NotFoundError:  # known to a proxy, or nobody yet
        full_name = None
    return Account(
        name=asking.actor.name,
        full_name=full_name,
        roles=sorted(asking.actor.roles),
        permissions=sorted(asking.permissions),
        way=asking.way.value,
    )


@router.put(
    "/account/password",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(400, 404, 413, 429),
    dependencies=[require(Permission.ACCOUNT)],
)
async def change_password(context: Context, request: Request, asking: Asking, wanted: PasswordChange) -> None:
    """Change the own password; all own sessions end, this one too."""
    name = asking.actor.name
    refuse_unusable(wanted.new, name, "body.new")
    origin = client_address(request.scope, context.settings.access.proxy)
    await _check(context, name, wanted.old, origin)
    await keep_password(context, name, wanted.new, by=asking.actor)


async def keep_password(context: ApiContext, name: str, password: str, *, by: Actor) -> None:
    """Give a user another password. Raises NotFoundError, BusyError."""
    async with context.passwords.admitted():
        kept = await run_in_threadpool(hashed, password)
    await run_in_threadpool(
        partial(context.repository.set_password, name, kept, by=by, now_ns=time.time_ns())
    )


def refuse_unusable(password: str, name: str, location: str) -> None:
    """Raise ProblemError (422) for a password that does not fit the rule."""
    if not is_usable(password, name):
        message = f"expected {PASSWORD_RULE}"
        raise WrongFieldError(location, message)


async def _check(context: ApiContext, account: str, password: str, origin: ClientAddress) -> None:
    """Look at a password. Raises ProblemError (401), LoginLockedError, BusyError."""
    settings, repository = context.settings.access, context.repository
    address, now_ns = counted_address(origin.address), time.time_ns()
    # Those who may not try are told at once; the others wait for their turn to use the memory of a hash.
    await run_in_threadpool(partial(logins.attempt, repository, settings, account, address, now_ns=now_ns))
    async with context.passwords.admitted():
        try:
            await run_in_threadpool(
                partial(logins.check_password, repository, account, password, address, now_ns=now_ns)
            )
        except logins.LoginRefusedError as error:
            raise ProblemError(HTTPStatus.UNAUTHORIZED, str(error)) from error


def _user(context: ApiContext, account: str) -> User:
    return context.repository.user(account)
