"""The documentation, as MkDocs has made pages of it, under /help: open to all, as scripts and styles are.

Plants have no Internet, so the pages come with the package. A file is read when it is first asked for.
"""

import hashlib
from dataclasses import dataclass
from functools import cached_property
from http import HTTPStatus
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Final

from starlette.datastructures import Headers
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send

from service.api.problems import problem_response
from service.web.static_files import ENCODINGS, StaticFile, entries, read

PREFIX: Final = "/help"
FIRST: Final = "index.html"
FOLDER: Final = files("service.web.help") / "site"
"""Not in the source tree: `make site` makes it there, and the build of the wheel in the wheel."""

NOT_BUILT: Final = (
    "this installation has no help pages: each wheel has them, and in a source tree `make site` makes them"
)


@dataclass(frozen=True)
class HelpFile:
    """A file of the site that is there."""

    entry: Traversable

    @cached_property
    def content(self) -> StaticFile:
        """The file, plain and compressed."""
        return read(self.entry)

    @cached_property
    def tag(self) -> str:
        """What tells this content from any other."""
        return f'W/"{hashlib.sha256(self.content.plain).hexdigest()[:16]}"'


class HelpPages:
    """ASGI middleware that answers what is asked for below /help; folder: that of the built site."""

    def __init__(self, app: ASGIApp, *, folder: Traversable = FOLDER) -> None:
        self._app = app
        self._files = {way: HelpFile(entry) for way, entry in entries(folder)} if folder.is_dir() else {}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or not f"{scope['path']}/".startswith(f"{PREFIX}/"):
            await self._app(scope, receive, send)
            return
        answer = self._answer(scope["method"], scope["path"], Headers(scope=scope))
        await answer(scope, receive, send)

    def _answer(self, method: str, path: str, headers: Headers) -> Response:
        if method not in ("GET", "HEAD"):
            detail = f"{method} is not possible here"
            return problem_response(
                path, HTTPStatus.METHOD_NOT_ALLOWED, detail, headers={"Allow": "GET, HEAD"}
            )
        if not self._files:
            return problem_response(path, HTTPStatus.NOT_IMPLEMENTED, NOT_BUILT)
        if path == PREFIX:
            return RedirectResponse(f"{PREFIX}/", status_code=HTTPStatus.PERMANENT_REDIRECT)
        file = self._files.get(path.removeprefix(f"{PREFIX}/") or FIRST)
        if file is None:
            return problem_response(path, HTTPStatus.NOT_FOUND, f"nothing is at {path}")
        about = {"Cache-Control": "public, no-cache", "ETag": file.tag}
        if file.tag in [tag.strip() for tag in headers.get("if-none-match", "").split(",")]:
            return Response(status_code=HTTPStatus.NOT_MODIFIED, headers={**about, "Vary": ENCODINGS})
        return file.content.answer(headers, about)
