"""What a page route is given: who looks, what the service stands on, and how the answer is made."""

import time
from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated

from fastapi import Depends, Request
from starlette.responses import HTMLResponse, RedirectResponse

from service.access.identities import Way
from service.access.permissions import Permission
from service.api.access.callers import Asking, Caller
from service.api.context import ApiContext, Context
from service.web.addresses import with_query
from service.web.navigation import links_for
from service.web.notices import notice
from service.web.rendering import html_response, rendered


@dataclass(frozen=True, slots=True)
class View:
    """A request for a page. now_ns: its time; ages in the answer count from it."""

    request: Request
    context: ApiContext
    asking: Caller
    now_ns: int

    def may(self, permission: Permission) -> bool:
        """Tell whether who looks may do something, so that a page shows no button that would be refused."""
        return permission in self.asking.permissions

    @property
    def is_htmx(self) -> bool:
        """Tell whether a part of a page is asked for, not a whole one."""
        headers = self.request.headers
        return headers.get("hx-request") == "true" and headers.get("hx-boosted") != "true"

    def page(
        self,
        template: str,
        *,
        title: str,
        live: str | None = None,
        status: int = HTTPStatus.OK,
        **data: object,
    ) -> HTMLResponse:
        """Return a whole page. The template extends base.html.

        live: where the page is told of changes (`live_address`); None where it is not.
        """
        known = {
            "title": title,
            "live": live,
            "links": links_for(self.asking.permissions, self.request.url.path),
            "user": None if self.asking.way is Way.NONE else self.asking.actor.name,
            "notice": notice(self.request.query_params.get("done")),
            "search": "",
        }
        text = rendered(template, **{**self._always(), **known, **data})
        return html_response(text, self.request.headers, status=status)

    def fragment(self, template: str, **data: object) -> HTMLResponse:
        """Return a part of a page."""
        return html_response(rendered(template, **self._always(), **data), self.request.headers)

    def done(self, path: str, what: str | None = None, **query: object) -> RedirectResponse:
        """Return the way back to a page after a form was taken; `what` is one of service.web.notices."""
        return RedirectResponse(with_query(path, {**query, "done": what}), status_code=HTTPStatus.SEE_OTHER)

    def _always(self) -> dict[str, object]:
        return {"view": self, "may": self.may, "Permission": Permission, "now_ns": self.now_ns}


async def _view_of(request: Request, context: Context, asking: Asking) -> View:
    return View(request, context, asking, time.time_ns())


Looking = Annotated[View, Depends(_view_of)]
"""A page route takes `view: Looking`."""
