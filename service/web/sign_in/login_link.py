"""The page behind a link that logs somebody in once: `mcc demo` prints one."""

import time
from functools import partial
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Query, Request
from fastapi.concurrency import run_in_threadpool
from starlette.responses import Response

from service.access import logins
from service.access.identities import identity_of_session, permissions_after_login
from service.access.login_links import PATH, user_of_link
from service.access.permissions import Permission
from service.api.access.client_address import client_address
from service.api.access.cookies import session_secret, set_session
from service.api.access.requirements import open_to_all
from service.api.context import ApiContext, Context
from service.api.problems import ProblemError
from service.storage import NotFoundError
from service.storage.records import Actor, User
from service.web.navigation import home_of
from service.web.rendering import html_response, rendered

router = APIRouter()

WAY = "login link"
USED = "this link was used already, or is too old; a link logs somebody in once, within 15 minutes"


@router.get(PATH, dependencies=[open_to_all()])
async def follow_link(
    context: Context, request: Request, secret: Annotated[str, Query(max_length=200)]
) -> Response:
    """Begin a session of the link's user, and lead to the first page.

    It is a page and no redirect: a browser does not send the new cookie along with a redirect that began at
    another site, such as a terminal in a browser.
    """
    if "prefetch" in request.headers.get("sec-purpose", ""):  # a browser looks ahead while somebody types
        return Response(status_code=HTTPStatus.NO_CONTENT)
    origin = client_address(request.scope, context.settings.access.proxy)
    user = await run_in_threadpool(partial(user_of_link, context.repository, secret, now_ns=time.time_ns()))
    if user is None:
        permissions = await run_in_threadpool(_permissions_here, context, request)
        return _leading_to(home_of(permissions), request)
    old = session_secret(request.headers, encrypted=origin.is_encrypted)
    session = await run_in_threadpool(_begin, context, user, origin.address, old)
    answer = _leading_to(home_of(permissions_after_login(context.settings.access, user)), request)
    seconds = context.settings.access.session_hours * 3600
    set_session(answer, session, seconds=seconds, encrypted=origin.is_encrypted)
    return answer


def _leading_to(home: str, request: Request) -> Response:
    text = rendered("sign_in/link.html", title="Logged in", home=home)
    answer = html_response(text, request.headers, cache="no-store")
    answer.headers["Referrer-Policy"] = "no-referrer"
    return answer


def _begin(context: ApiContext, user: User, address: str, old: str | None) -> str:
    """Return the secret of a new session. Raises ProblemError (410)."""
    by = Actor(user.name, address, user.roles)
    try:
        return logins.begin_session(
            context.repository,
            context.settings.access,
            by,
            WAY,
            second_factor=True,
            ends=old,
            now_ns=time.time_ns(),
        )
    except NotFoundError as error:
        raise ProblemError(HTTPStatus.GONE, USED) from error


def _permissions_here(context: ApiContext, request: Request) -> frozenset[Permission]:
    """Return what a browser may do that has a session already: somebody followed the link twice.

    Raises ProblemError (410) where it has none.
    """
    origin = client_address(request.scope, context.settings.access.proxy)
    secret = session_secret(request.headers, encrypted=origin.is_encrypted) or ""
    found = identity_of_session(context.repository, context.settings.access, secret, now_ns=time.time_ns())
    if found is None:
        raise ProblemError(HTTPStatus.GONE, USED)
    return found.permissions
