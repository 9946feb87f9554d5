"""Finds out who asks, before anything is read of a request but its header, and turns unknown callers away.

The ways to say who one is: a token (Authorization: Bearer), the headers of a proxy that the settings name,
the cookie of a session. While there are no users, whoever is on this machine may look and change nothing.
"""

import time
from http import HTTPStatus

import structlog
from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool
from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send
from structlog.typing import FilteringBoundLogger

from service.access.identities import Identity, Way, identity_of_session, identity_of_token
from service.access.permissions import PERMISSIONS_OF
from service.access.proxied import ProxiedUserError, identity_of_proxied
from service.api.access.callers import FIRST_USER, SCOPE_KEY, Caller
from service.api.access.client_address import ClientAddress, client_address
from service.api.access.cookies import session_secret
from service.api.access.refusals import refuse
from service.api.access.requirements import RouteNeeds
from service.api.context import ApiContext
from service.api.problems import ProblemError, database_response, problem_response
from service.storage.records import Actor, Role

log: FilteringBoundLogger = structlog.get_logger(__name__)

READING = ("GET", "HEAD")
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
            await self._app({**scope, SCOPE_KEY: caller}, receive, send)

    def _caller(self, scope: Scope) -> Caller:
        """Return who asks. Raises ProblemError, SQLAlchemyError."""
        headers = Headers(scope=scope)
        origin = client_address(scope, self._context.settings.access.proxy)
        identity = self._identity(headers, origin)
        if identity is None:
            identity = self._nobody(scope["method"], origin)
        actor = Actor(identity.name, origin.address, identity.roles)
        caller = Caller(actor, identity.permissions, identity.way, identity.session, identity.token)
        needed = self._needs.of(scope["method"], scope["path"])
        if needed is not None:
            caller.demand(needed)
        return caller

    def _identity(self, headers: Headers, origin: ClientAddress) -> Identity | None:
        """Return who a request says it comes from; None where it does not say. Raises ProblemError."""
        repository, settings = self._context.repository, self._context.settings.access
        now_ns = time.time_ns()
        authorization = headers.getlist("authorization")
        if authorization:
            scheme, _, secret = authorization[0].strip().partition(" ")
            if len(authorization) > 1 or scheme.lower() != BEARER:
                raise ProblemError(HTTPStatus.UNAUTHORIZED, SAY_WHO)
            return _known(identity_of_token(repository, secret.strip(), now_ns=now_ns), NO_TOKEN)
        if origin.is_named_proxy and settings.proxy is not None:
            try:
                proxied = identity_of_proxied(repository, settings.proxy, headers.getlist)
            except ProxiedUserError as error:
                raise ProblemError(HTTPStatus.UNAUTHORIZED, str(error)) from error
            if proxied is not None:
                return proxied
        secret = session_secret(headers) or ""
        if secret:
            is_use = headers.get(BY_ITSELF) is None
            found = identity_of_session(repository, settings, secret, now_ns=now_ns, is_use=is_use)
            return _known(found, ENDED)
        return None

    def _nobody(self, method: str, origin: ClientAddress) -> Identity:
        """Return what may be done by who does not say who they are. Raises ProblemError."""
        if self._has_users():
            raise ProblemError(HTTPStatus.UNAUTHORIZED, SAY_WHO)
        if not origin.is_local:
            raise ProblemError(HTTPStatus.UNAUTHORIZED, NOT_LOCAL)
        if method not in READING:
            raise ProblemError(HTTPStatus.FORBIDDEN, FIRST_USER)
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


def _known(identity: Identity | None, otherwise: str) -> Identity:
    if identity is None:
        raise ProblemError(HTTPStatus.UNAUTHORIZED, otherwise)
    return identity
