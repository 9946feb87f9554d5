"""Logging in and out, and the own account."""

import time
from functools import partial
from http import HTTPStatus
from typing import Literal, Protocol, TypedDict, TypeVar

from fastapi import APIRouter, Request, Response
from fastapi.concurrency import run_in_threadpool

from service.access import logins
from service.access.identities import permissions_after_login
from service.access.passkeys import NoPasskeysError, PasskeyPlace, PasskeyRefusedError, require_passkey
from service.access.passwords import UnusablePasswordError, new_hash
from service.access.permissions import Permission
from service.access.refusals import NOBODY, Refusal
from service.access.second_factors import is_missing, is_passed
from service.api.access.callers import FIRST_USER, Asking, Caller
from service.api.access.client_address import ClientAddress, client_address
from service.api.access.cookies import clear_session, session_secret, set_session
from service.api.access.requirements import open_to_all, require
from service.api.access.schemas import Account, LoginRequest, LoginWays, PasswordChange
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError, WrongFieldError, problems
from service.process.sealing import Seal
from service.storage import NotFoundError
from service.storage.records import Actor, User

router = APIRouter(tags=["access"])

LOGIN = "POST /api/v1/login"
OIDC_PATH = "/api/v1/login/oidc"

Found_co = TypeVar("Found_co", covariant=True)


class _SecondFactor(TypedDict):
    second_factor: Literal["none", "missing", "set-up"]
    recovery_codes_left: int


@router.get("/login", responses=problems(), dependencies=[open_to_all()])
def get_login_ways(context: Context) -> LoginWays:
    """Return how one logs in here."""
    access = context.settings.access
    return LoginWays(password=True, oidc=OIDC_PATH if access.oidc else None, notice=access.use_notice)


@router.post("/login", responses=problems(400, 413, 429), dependencies=[open_to_all()])
async def log_in(context: Context, request: Request, response: Response, wanted: LoginRequest) -> Account:
    """Begin a session, with a name and a password; the answer's cookie is its secret."""
    user = await begin_session(context, request, response, wanted)
    return Account(
        name=user.name,
        full_name=user.full_name,
        roles=sorted(user.roles),
        sites=None if user.sites is None else sorted(user.sites),
        permissions=sorted(permissions_after_login(context.settings.access, user)),
        way="session",
        password_set_by=user.password_set_by,
        **await run_in_threadpool(_second_factor_of, context, user),
    )


async def begin_session(
    context: ApiContext, request: Request, response: Response, wanted: LoginRequest
) -> User:
    """Begin a session of who shows all that is asked of a user: the response gets its cookie.

    Raises ProblemError (401, 403), LoginLockedError, BusyError.
    """
    origin = client_address(request.scope, context.settings.access.proxy)
    if not await run_in_threadpool(context.repository.has_users):
        raise ProblemError(HTTPStatus.FORBIDDEN, FIRST_USER)
    account = logins.account_of(wanted.name)
    look = partial(
        logins.check_login,
        context.repository,
        context.settings.access,
        account,
        wanted.password,
        _second_look(context, wanted),
        origin.address,
    )
    second_factor = await _check(context, account, origin, look)
    user = await run_in_threadpool(_user, context, account)
    by = Actor(user.name, origin.address, user.roles)
    secret = await run_in_threadpool(
        partial(
            logins.begin_session,
            context.repository,
            context.settings.access,
            by,
            "password",
            second_factor=second_factor,
            ends=session_secret(request.headers, encrypted=origin.is_encrypted),
            now_ns=time.time_ns(),
        )
    )
    seconds = context.settings.access.session_hours * 3600
    set_session(response, secret, seconds=seconds, encrypted=origin.is_encrypted)
    response.headers["Cache-Control"] = "no-store"
    return user


def _second_look(context: ApiContext, wanted: LoginRequest) -> logins.SecondLook | None:
    """Return what looks at what is shown besides the password; None where nothing is."""
    repository = context.repository
    if wanted.passkey is not None:
        answer = wanted.passkey

        def look_at_passkey(by: Actor, *, now_ns: int) -> str | None:
            try:
                place = PasskeyPlace.of(context.settings.notifications.address)
                require_passkey(repository, seal_of(context), place, by.name, answer, now_ns=now_ns)
            except (NoPasskeysError, PasskeyRefusedError) as error:
                return str(error)
            return None

        return look_at_passkey
    if wanted.code is not None:
        code = wanted.code

        def look_at_code(by: Actor, *, now_ns: int) -> str | None:
            passed = is_passed(repository, seal_of(context), by.name, code, by=by, now_ns=now_ns)
            return None if passed else "wrong or used code"

        return look_at_code
    return None


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
        user = context.repository.user(asking.actor.name)
    except NotFoundError:  # known to a proxy, or nobody yet
        user = None
    return Account(
        name=asking.actor.name,
        full_name=None if user is None else user.full_name,
        roles=sorted(asking.actor.roles),
        sites=None if asking.sites is None else sorted(asking.sites),
        permissions=sorted(asking.permissions),
        way=asking.way.value,
        password_set_by=asking.password_set_by,
        **_second_factor_of(context, user),
    )


def _second_factor_of(context: ApiContext, user: User | None) -> _SecondFactor:
    if user is None:
        return {"second_factor": "none", "recovery_codes_left": 0}
    missing = is_missing(context.settings.access, user)
    return {
        "second_factor": "missing" if missing else "set-up" if user.has_second_factor else "none",
        "recovery_codes_left": context.repository.recovery_codes_left(user.name),
    }


@router.put(
    "/account/password",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(400, 404, 413, 429),
    dependencies=[require(Permission.ACCOUNT)],
)
async def change_password(context: Context, request: Request, asking: Asking, wanted: PasswordChange) -> None:
    """Change the own password; all own sessions end, this one too, and all own tokens."""
    name = asking.actor.name
    await check_own_password(context, request, asking, wanted.old)
    await keep_password(context, name, wanted.new, "body.new", by=asking.actor)


async def keep_password(context: ApiContext, name: str, password: str, location: str, *, by: Actor) -> None:
    """Give a user another password, from this place of a request.

    Raises NotFoundError, AuditorAccountError, NotOwnPasswordError, BusyError, ProblemError (422).
    """
    user = await run_in_threadpool(_user, context, name)
    present = await run_in_threadpool(partial(context.repository.password_to_change, name, by=by))
    kept = await hash_of(context, password, name, user.full_name, location, present=present)
    await run_in_threadpool(
        partial(context.repository.set_password, name, kept, by=by, now_ns=time.time_ns())
    )


async def hash_of(
    context: ApiContext,
    password: str,
    name: str,
    full_name: str | None,
    location: str,
    *,
    present: str | None = None,
) -> str:
    """Return a hash of a new password. Raises ProblemError (422) for one that does not fit, BusyError."""
    async with context.passwords.admitted():
        try:
            return await run_in_threadpool(
                partial(new_hash, password, name, full_name=full_name, present=present)
            )
        except UnusablePasswordError as error:
            raise WrongFieldError(location, str(error)) from error


async def check_own_password(context: ApiContext, request: Request, asking: Caller, password: str) -> None:
    """Look at the password of who asks, again. Raises ProblemError (401), LoginLockedError, BusyError."""
    origin, name = client_address(request.scope, context.settings.access.proxy), asking.actor.name
    look = partial(logins.check_password, context.repository, name, password, origin.address)
    await _check(context, name, origin, look)


class Look(Protocol[Found_co]):
    """Looks at what somebody shows. Raises LoginRefusedError."""

    def __call__(self, *, now_ns: int) -> Found_co: ...


async def _check(context: ApiContext, account: str, origin: ClientAddress, look: Look[Found_co]) -> Found_co:
    """Look at what somebody shows, if they may try.

    Raises ProblemError (401), LoginLockedError, BusyError.
    """
    settings, repository = context.settings.access, context.repository
    address, now_ns = origin.address, time.time_ns()
    # Those who may not try are told at once; the others wait for their turn to use the memory of a hash.
    try:
        await run_in_threadpool(
            partial(logins.attempt, repository, settings, account, address, now_ns=now_ns)
        )
    except logins.LoginLockedError:
        await run_in_threadpool(
            context.refusals.note, repository, Refusal.LOCKED, Actor(NOBODY, address), LOGIN
        )
        raise
    async with context.passwords.admitted():
        try:
            return await run_in_threadpool(partial(look, now_ns=now_ns))
        except logins.LoginRefusedError as error:
            context.refusals.note(repository, Refusal.LOGIN, Actor(NOBODY, address), LOGIN)
            raise ProblemError(HTTPStatus.UNAUTHORIZED, str(error)) from error


def seal_of(context: ApiContext) -> Seal:
    """Return what opens sealed secrets. Raises SealError."""
    return Seal(context.settings.secrets_key_file)


def _user(context: ApiContext, account: str) -> User:
    return context.repository.user(account)
