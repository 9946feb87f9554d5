"""Finds out who asks, before anything is read of a request but its header, and turns unknown callers away.

The ways to say who one is: a token (Authorization: Bearer), the headers of a proxy that the settings name,
the cookie of a session. While there are no users, whoever is on this machine may look and change nothing.
"""

import time
from http import HTTPStatus

import structlog
from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from structlog.typing import FilteringBoundLogger

from service.access.identities import Identity, Way, identity_of_session, identity_of_token
from service.access.permissions import PERMISSIONS_OF
from service.access.proxied import ProxiedUserError, identity_of_proxied
from service.access.reach import OF_PEOPLE
from service.access.refusals import NOBODY, Refusal
from service.api.access.callers import FIRST_USER, SCOPE_KEY, Caller, elsewhere, forbidden
from service.api.access.client_address import ClientAddress, client_address
from service.api.access.cookies import session_secret
from service.api.access.refusals import refuse
from service.api.access.requirements import Need, RouteNeeds
from service.api.access.site_rules import WHOLE_PLANT, is_elsewhere
from service.api.context import READING, SITES_KEY, ApiContext
from service.api.problems import ProblemError, database_response, problem_response
from service.storage.records import Actor, Role
from service.storage.repository.sites import AtSite

log: FilteringBoundLogger = structlog.get_logger(__name__)

BEARER = "bearer"

BY_ITSELF = "x-refresh"
"""A page sends this header where it asks by itself: nobody has to be there for that."""

NOT_LOCAL = (
    "there are no users yet, so that only this service's own machine may look: run `mcc user add NAME "
    "--role SECADM --role ENGINEER --config FILE` there"
)
SAY_WHO = "say who you are: log in (mcc login), or send a token (Authorization: Bearer ...)"
ENDED = "the session has ended, or never was: log in (mcc login)"
NO_TOKEN = "the token is unknown, revoked or expired"  # noqa: S105 - what is said of one
CHALLENGE = {"WWW-Authenticate": 'Bearer realm="statorwatch"'}


class RefusedError(ProblemError):
    """Nobody who is known asks; `refusal` says why."""

    def __init__(self, refusal: Refusal, detail: str, status: HTTPStatus = HTTPStatus.UNAUTHORIZED) -> None:
        super().__init__(status, detail)
        self.refusal = refusal


class Gate:
    """ASGI middleware. `needs`: what routes need. Each route asks its caller itself, too, after its body."""

    def __init__(self, app: ASGIApp, *, context: ApiContext, needs: RouteNeeds) -> None:
        self._app = app
        self._context = context
        self._needs = needs
        self._had_users = False

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or scope["path"] in self._needs.open_paths:
            await self._app(scope, receive, send)
            return
        try:
            caller = await run_in_threadpool(self._caller, scope)
        except ProblemError as problem:
            headers = CHALLENGE if problem.status == HTTPStatus.UNAUTHORIZED else None
            answer = problem_response(scope["path"], problem.status, problem.detail, headers=headers)
            await refuse(answer, scope, receive, send)
        except SQLAlchemyError as error:
            await refuse(database_response(scope["path"], error), scope, receive, send)
        else:
            answering = self._noting(caller, scope, send)
            if self._needs.of(scope["method"], scope["path"]).permission in OF_PEOPLE:
                answering = _unstored(answering)  # no cache keeps what tells of people
            await self._app({**scope, SCOPE_KEY: caller, SITES_KEY: caller.sites}, receive, answering)

    def _noting(self, caller: Caller, scope: Scope, send: Send) -> Send:
        """Return what sends the answer, and notes where a route has refused this caller by itself."""

        async def send_and_note(message: Message) -> None:
            if message["type"] == "http.response.start" and message["status"] == HTTPStatus.FORBIDDEN:
                await run_in_threadpool(self._note, Refusal.PERMISSION, caller.actor, scope)
            await send(message)

        return send_and_note

    def _note(self, refusal: Refusal, actor: Actor, scope: Scope) -> None:
        request = f"{scope['method']} {scope['path']}"
        self._context.refusals.note(self._context.repository, refusal, actor, request)

    def _caller(self, scope: Scope) -> Caller:
        """Return who asks. Raises ProblemError, SQLAlchemyError."""
        headers = Headers(scope=scope)
        origin = client_address(scope, self._context.settings.access.proxy)
        try:
            identity = self._identity(headers, origin) or self._nobody(scope["method"], origin)
        except RefusedError as refused:
            self._note(refused.refusal, Actor(NOBODY, origin.address), scope)
            raise
        actor = Actor(identity.name, origin.address, identity.roles)
        caller = Caller(
            actor,
            identity.permissions,
            identity.way,
            identity.sites,
            identity.session,
            identity.token,
            identity.password_set_by,
            identity.may_make_tokens,
        )
        need = self._needs.of(scope["method"], scope["path"])
        why = self._refused(caller, need)
        if why is not None:
            self._note(Refusal.PERMISSION, actor, scope)
            raise why
        return caller

    def _refused(self, caller: Caller, need: Need) -> ProblemError | None:
        """Return why a caller may not have this route; None where they may."""
        if need.permission is not None and need.permission not in caller.permissions:
            return forbidden(caller, need.permission)
        if caller.sites is None:
            return None
        if need.about == WHOLE_PLANT:
            return elsewhere(caller, "the whole plant")
        if isinstance(need.about, AtSite) and is_elsewhere(
            self._context.repository, need.about, need.parameters, caller.sites
        ):
            return elsewhere(caller, f"a {need.about} at another site")
        return None

    def _identity(self, headers: Headers, origin: ClientAddress) -> Identity | None:
        """Return who a request says it comes from; None where it does not say. Raises ProblemError."""
        repository, settings = self._context.repository, self._context.settings.access
        now_ns = time.time_ns()
        authorization = headers.getlist("authorization")
        if authorization:
            scheme, _, secret = authorization[0].strip().partition(" ")
            if len(authorization) > 1 or scheme.lower() != BEARER:
                raise RefusedError(Refusal.TOKEN, SAY_WHO)
            found = identity_of_token(repository, settings, secret.strip(), now_ns=now_ns)
            return _known(found, Refusal.TOKEN, NO_TOKEN)
        if origin.is_named_proxy and settings.proxy is not None:
            try:
                proxied = identity_of_proxied(repository, settings.proxy, headers.getlist)
            except ProxiedUserError as error:
                raise RefusedError(Refusal.LOGIN, str(error)) from error
            if proxied is not None:
                return proxied
        secret = session_secret(headers, encrypted=origin.is_encrypted) or ""
        if secret:
            is_use = headers.get(BY_ITSELF) is None
            found = identity_of_session(repository, settings, secret, now_ns=now_ns, is_use=is_use)
            return _known(found, Refusal.SESSION, ENDED)
        return None

    def _nobody(self, method: str, origin: ClientAddress) -> Identity:
        """Return what may be done by who does not say who they are. Raises ProblemError."""
        if self._has_users():
            raise RefusedError(Refusal.ANONYMOUS, SAY_WHO)
        if not origin.is_local:
            raise RefusedError(Refusal.ANONYMOUS, NOT_LOCAL)
        if method not in READING:
            raise RefusedError(Refusal.ANONYMOUS, FIRST_USER, HTTPStatus.FORBIDDEN)
        roles = frozenset({Role.VIEWER})
        return Identity("anonymous", roles, PERMISSIONS_OF[Role.VIEWER], Way.NONE)

    def _has_users(self) -> bool:
        """Tell whether there are users, or others who say who somebody is. The last user is never deleted."""
        settings = self._context.settings.access
        if settings.oidc is not None or settings.proxy is not None:
            return True
        if not self._had_users:
            self._had_users = self._context.repository.has_users()
        return self._had_users


def _unstored(send: Send) -> Send:
    """Return what sends an answer that nobody is to keep."""

    async def send_unstored(message: Message) -> None:
        if message["type"] == "http.response.start":
            MutableHeaders(scope=message)["Cache-Control"] = "no-store"
        await send(message)

    return send_unstored


def _known(identity: Identity | None, refusal: Refusal, otherwise: str) -> Identity:
    if identity is None:
        raise RefusedError(refusal, otherwise)
    return identity
