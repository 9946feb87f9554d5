"""The form for a new token, and the page that shows its secret once."""

from pydantic import BaseModel, ConfigDict, Field
from starlette.responses import Response

from core.units import NANOSECONDS_PER_DAY
from service.access.permissions import Permission
from service.api.access.schemas import MOST_SITES, NewToken, TokenRequest
from service.api.times import rfc3339
from service.web.forms import document_of_form
from service.web.view import View


class TokenForm(BaseModel):
    """What a new token is for. scope: what it may do, all that its user may where nothing is chosen.

    sites: where it holds, at all of its user where nothing is chosen. days: how long it may be used; None
    without an end.
    """

    model_config = ConfigDict(extra="forbid")

    label: str = Field(default="", max_length=500)
    scope: list[Permission] = Field(default_factory=list, max_length=len(Permission))
    sites: list[str] = Field(default_factory=list, max_length=MOST_SITES)
    days: int | None = Field(default=None, ge=1, le=3650)


def token_request(form: TokenForm, now_ns: int) -> TokenRequest:
    """Return the request that the API takes. Raises RequestValidationError."""
    expires = None if form.days is None else rfc3339(now_ns + form.days * NANOSECONDS_PER_DAY)
    fields = {
        "label": form.label,
        "scope": form.scope or None,
        "expires_time": expires,
        "sites": form.sites or None,
    }
    return document_of_form(TokenRequest, fields)


def show_new_token(view: View, made: NewToken, back: str) -> Response:
    """Return the page with the secret of a new token; no browser keeps it."""
    answer = view.page("people/new_token.html", title="New token", made=made, back=back)
    answer.headers["Cache-Control"] = "no-store"
    return answer
