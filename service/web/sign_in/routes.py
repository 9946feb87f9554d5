"""The page to log in at, and the way out."""

from typing import Annotated

from fastapi import APIRouter, Form, Query, Request
from fastapi.concurrency import run_in_threadpool
from starlette.responses import RedirectResponse, Response

from service.access.identities import is_account_first, permissions_after_login
from service.access.logins import LoginLockedError
from service.access.passkeys import LONGEST_ANSWER
from service.access.permissions import Permission
from service.api.access import sessions
from service.api.access.requirements import open_to_all, require
from service.api.access.schemas import LoginRequest
from service.api.context import Context
from service.api.problems import ProblemError
from service.web.addresses import LONGEST, own_address
from service.web.forms import document_of_form
from service.web.navigation import home_of
from service.web.notices import notice
from service.web.people.passkeys import origin_of_passkeys
from service.web.rendering import html_response, rendered
from service.web.view import Looking

router = APIRouter()

CLEARED = {"Clear-Site-Data": '"cache"'}
"""After a logout the browser's way back shows nothing of the plant."""


@router.get("/login", dependencies=[open_to_all()])
def show_login(
    context: Context,
    request: Request,
    next_: Annotated[str | None, Query(alias="next", max_length=LONGEST)] = None,
    done: Annotated[str | None, Query(max_length=50)] = None,
) -> Response:
    """Show the form to log in with."""
    has_users = context.repository.has_users()
    data = _about(context, own_address(next_, ""), has_users=has_users)
    text = rendered("sign_in/login.html", **data, notice=notice(done), problem=None, name="")
    return html_response(text, request.headers, cache="no-store")


@router.post("/login", dependencies=[open_to_all()])
async def log_in(
    context: Context,
    request: Request,
    name: Annotated[str, Form(max_length=200)],
    password: Annotated[str, Form(max_length=1000)],
    code: Annotated[str, Form(max_length=40)] = "",
    passkey: Annotated[str, Form(max_length=LONGEST_ANSWER)] = "",
    next_: Annotated[str | None, Form(alias="next", max_length=LONGEST)] = None,
) -> Response:
    """Begin a session and go on to where somebody wanted to go."""
    answer = RedirectResponse("/", status_code=303)
    try:
        fields = {"name": name, "password": password, "code": code, "passkey": passkey}
        wanted = document_of_form(LoginRequest, fields)
        user = await sessions.begin_session(context, request, answer, wanted)
    except (ProblemError, LoginLockedError) as error:
        status = error.status if isinstance(error, ProblemError) else 429
        has_users = await run_in_threadpool(context.repository.has_users)
        data = _about(context, own_address(next_, ""), has_users=has_users)
        text = rendered("sign_in/login.html", **data, notice=None, problem=str(error), name=name)
        return html_response(text, request.headers, status=status, cache="no-store")
    access = context.settings.access
    home = home_of(permissions_after_login(access, user))
    answer.headers["Location"] = home if is_account_first(access, user) else own_address(next_, home)
    return answer


@router.post("/logout", dependencies=[require(Permission.ACCOUNT)])
def log_out(view: Looking) -> Response:
    """End the session."""
    answer = view.done("/login", "logged-out")
    sessions.log_out(view.context, view.request, answer, view.asking)
    answer.headers.update(CLEARED)
    return answer


def _about(context: Context, next_: str, *, has_users: bool) -> dict[str, object]:
    return {
        "title": "Log in",
        "next": next_,
        "has_users": has_users,
        "ways": sessions.get_login_ways(context),
        "passkey_origin": origin_of_passkeys(context)[0],
    }
