"""Logging in by way of the plant's OpenID provider, in a browser."""

import time
from functools import partial
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Form, Query, Request, Response
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, RedirectResponse

from core.units import NANOSECONDS_PER_SECOND
from service.access import logins
from service.access.oidc import Attempt, OpenIdProvider, ProviderError, SignedOn, SignOnRefusedError
from service.access.provider_logout import ProviderLogout, provider_logout
from service.access.refusals import NOBODY, Refusal
from service.api.access.client_address import client_address
from service.api.access.cookies import session_secret, set_session
from service.api.access.requirements import open_to_all
from service.api.context import ApiContext, Context
from service.api.limits.admission import Admission
from service.api.problems import ProblemError, problems
from service.storage.errors import NotFoundError, UserExistsError
from service.storage.records import Actor, User

PATH = "/login/oidc"
COOKIE = "statorwatch_sign_on"
ATTEMPT_S = 600
LONGEST_TOKEN = 6000
AFTERWARDS = "/"

DONE = f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>StatorWatch</title>
<meta http-equiv="refresh" content="0;url={AFTERWARDS}">
<p>You are logged in. <a href="{AFTERWARDS}">Go on</a>"""
"""A page and no redirect: a browser does not send the cookie along with one that another site began."""

PAGE_HEADERS = {"Content-Security-Policy": "default-src 'none'", "Cache-Control": "no-store"}


def sign_on_router(provider: OpenIdProvider) -> APIRouter:
    """Return the routes of a service with a provider."""
    router = APIRouter(tags=["access"])
    asking = Admission("sign-ons", 8, wait_s=5.0)

    @router.get(
        PATH,
        status_code=HTTPStatus.SEE_OTHER,
        response_class=RedirectResponse,
        responses=problems(),
        dependencies=[open_to_all()],
    )
    async def begin_sign_on(context: Context, request: Request) -> Response:
        """Send a browser to the plant's identity provider."""
        attempt = Attempt.new()
        async with asking.admitted():
            try:
                address = await run_in_threadpool(provider.address, attempt)
            except ProviderError as error:
                raise _unavailable(error) from error
        response = RedirectResponse(address, status_code=HTTPStatus.SEE_OTHER)
        origin = client_address(request.scope, context.settings.access.proxy)
        response.set_cookie(
            COOKIE,
            attempt.text(),
            max_age=ATTEMPT_S,
            path="/api/v1" + PATH,
            secure=origin.is_encrypted,
            httponly=True,
            samesite="lax",  # it comes back by a link of the provider
        )
        response.headers["Cache-Control"] = "no-store"
        return response

    @router.get(
        f"{PATH}/callback",
        response_class=HTMLResponse,
        responses=problems(400, 409),
        dependencies=[open_to_all()],
    )
    async def end_sign_on(
        context: Context,
        request: Request,
        state: Annotated[str, Query(max_length=200)] = "",
        code: Annotated[str, Query(max_length=4000)] = "",
        error: Annotated[str, Query(max_length=200)] = "",
        error_description: Annotated[str, Query(max_length=2000)] = "",
        iss: Annotated[str, Query(max_length=500)] = "",
        session_state: Annotated[str, Query(max_length=500)] = "",
        scope: Annotated[str, Query(max_length=2000)] = "",
    ) -> Response:
        """Take back what the provider says of who logged in, and begin a session."""
        del error_description, iss, session_state, scope  # what providers add
        attempt = Attempt.of(request.cookies.get(COOKIE, ""))
        if attempt is None or attempt.state != state:
            raise ProblemError(
                HTTPStatus.BAD_REQUEST, f"this login did not begin here, or too long ago: see /api/v1{PATH}"
            )
        if error or not code:
            said = error[:100].encode("ascii", "backslashreplace").decode() or "no code"
            raise ProblemError(HTTPStatus.UNAUTHORIZED, f"the identity provider let nobody in: {said}")
        origin = client_address(request.scope, context.settings.access.proxy)
        async with asking.admitted():
            try:
                found = await run_in_threadpool(provider.sign_on, code, attempt)
            except ProviderError as trouble:
                raise _unavailable(trouble) from trouble
            except SignOnRefusedError as refusal:
                raise ProblemError(HTTPStatus.UNAUTHORIZED, str(refusal)) from refusal
            old = session_secret(request.headers, encrypted=origin.is_encrypted)
            secret = await run_in_threadpool(partial(_begin, context, found, origin.address, old))
        response = HTMLResponse(DONE, headers=PAGE_HEADERS)
        seconds = context.settings.access.session_hours * 3600
        set_session(response, secret, seconds=seconds, encrypted=origin.is_encrypted)
        response.delete_cookie(COOKIE, path="/api/v1" + PATH, httponly=True, samesite="lax")
        return response

    @router.post(
        f"{PATH}/logout",
        responses=problems(400, 413),
        dependencies=[open_to_all()],
    )
    async def end_logins(
        context: Context,
        request: Request,
        response: Response,
        logout_token: Annotated[str, Form(max_length=LONGEST_TOKEN)],
    ) -> None:
        """Take what the provider says of logins that it has ended (OpenID Connect Back-Channel Logout).

        One that it names by `sid` ends; with `sub` alone all sessions and tokens of that user do.
        """
        response.headers["Cache-Control"] = "no-store"
        origin = client_address(request.scope, context.settings.access.proxy)
        async with asking.admitted():
            try:
                found = await run_in_threadpool(
                    partial(provider_logout, provider, logout_token, now_s=time.time())
                )
                await run_in_threadpool(_end, context, found, origin.address)
            except ProviderError as trouble:
                raise _unavailable(trouble) from trouble
            except SignOnRefusedError as refusal:
                by = Actor(NOBODY, origin.address)
                await run_in_threadpool(
                    context.refusals.note, context.repository, Refusal.TOKEN, by, f"POST /api/v1{PATH}/logout"
                )
                raise ProblemError(HTTPStatus.BAD_REQUEST, str(refusal)) from refusal

    return router


def _end(context: ApiContext, found: ProviderLogout, address: str) -> None:
    """End the logins that the provider has ended. Raises SignOnRefusedError for what was said before."""
    repository, now_ns = context.repository, time.time_ns()
    expires_ns = found.expires_s * NANOSECONDS_PER_SECOND
    if not repository.use_once(found.digest, expires_ns=expires_ns, now_ns=now_ns):
        raise SignOnRefusedError("the logout token was used before")
    by = Actor(found.issuer, address)
    repository.end_at_provider(found.subject, found.session, by=by, now_ns=now_ns)


def _begin(context: ApiContext, found: SignedOn, address: str, old: str | None) -> str:
    """Return the secret of a session of who signed on. Raises ProblemError."""
    if not found.roles:
        by = Actor(found.name, address)
        context.repository.refuse_subject(found.subject, by=by, now_ns=time.time_ns())
        raise ProblemError(
            HTTPStatus.FORBIDDEN, f"{found.name} has no group that gives a role (access.oidc.roles)"
        )
    provider = found.subject.partition(" ")[0]
    user = _user(context, found, Actor(found.name, address, found.roles))
    if user.disabled:
        raise ProblemError(HTTPStatus.FORBIDDEN, f"user {user.name} is disabled here")
    by = Actor(user.name, address, user.roles)
    try:
        return logins.begin_session(
            context.repository,
            context.settings.access,
            by,
            provider,
            second_factor=True,
            provider_session=found.session,
            ends=old,
            now_ns=time.time_ns(),
        )
    except NotFoundError as error:
        raise ProblemError(HTTPStatus.FORBIDDEN, f"user {user.name} is gone") from error


def _user(context: ApiContext, found: SignedOn, by: Actor) -> User:
    try:
        return context.repository.user_of_subject(
            found.subject,
            found.name,
            found.roles,
            sites=found.sites,
            full_name=found.full_name,
            by=by,
            now_ns=time.time_ns(),
        )
    except UserExistsError as error:
        raise ProblemError(
            HTTPStatus.CONFLICT,
            f"there is another user {found.name} here, who is not of the identity provider; a SECADM deletes "
            "or renames one of them",
        ) from error


def _unavailable(error: ProviderError) -> ProblemError:
    return ProblemError(
        HTTPStatus.SERVICE_UNAVAILABLE, f"{error}; local users log in as ever (POST /api/v1/login, mcc login)"
    )
