"""Scripts, styles and pictures of the pages, from memory, open to all.

Their addresses have a digest of all of them, so that browsers keep them until an update brings others; within
the tree they find one another by relative addresses.
"""

import gzip
import hashlib
import mimetypes
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Final

from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send

PREFIX: Final = "/static/"
FOR_EVER: Final = "public, max-age=31536000, immutable"
COMPRESSED: Final = ("text/", "application/json", "image/svg+xml")
TYPES: Final = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
"""As the Web knows them, whatever the machine's own table of types says."""

ENCODINGS = "Accept-Encoding"
"""What answers differ by."""


@dataclass(frozen=True, slots=True)
class StaticFile:
    """A file, plain and compressed."""

    media_type: str
    plain: bytes
    compressed: bytes | None

    def answer(self, asked: Headers, about: Mapping[str, str]) -> Response:
        """Return the answer to a request with these headers, compressed where it takes that."""
        about = {**about, "Vary": ENCODINGS}
        if self.compressed is not None and "gzip" in asked.get("accept-encoding", ""):
            about = {**about, "Content-Encoding": "gzip"}
            return Response(self.compressed, headers=about, media_type=self.media_type)
        return Response(self.plain, headers=about, media_type=self.media_type)


@dataclass(frozen=True, slots=True)
class StaticTree:
    """All files by their ways below `static`, and the digest of them all."""

    digest: str
    files: Mapping[str, StaticFile]

    def address(self, way: str) -> str:
        """Return where a browser finds a file. Raises LookupError where there is none."""
        if way not in self.files:
            raise LookupError(f"expected a file of service/web/static, found {way!r}")
        return f"{PREFIX}{self.digest}/{way}"


@cache
def static_tree() -> StaticTree:
    """Read the files that came with the package."""
    ways = dict(entries(files("service.web") / "static"))
    found = {way: read(ways[way]) for way in sorted(ways)}
    digest = hashlib.sha256()
    for way, file in found.items():
        digest.update(f"{way}\0{len(file.plain)}\0".encode() + file.plain)
    return StaticTree(digest.hexdigest()[:12], found)


def entries(folder: Traversable, way: str = "") -> Iterator[tuple[str, Traversable]]:
    """Yield the files below a folder, each with its way from there."""
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from entries(entry, f"{way}{entry.name}/")
        elif not entry.name.startswith((".", "_")):
            yield f"{way}{entry.name}", entry


def read(entry: Traversable) -> StaticFile:
    """Read a file, and compress it where that makes it smaller."""
    plain = entry.read_bytes()
    suffix = entry.name[entry.name.rfind(".") :]
    media_type = TYPES.get(suffix) or mimetypes.guess_type(entry.name)[0] or "text/plain"
    compressed = gzip.compress(plain, mtime=0) if media_type.startswith(COMPRESSED) else None
    return StaticFile(media_type, plain, compressed)


class StaticFiles:
    """ASGI middleware that answers what is asked for below /static/."""

    def __init__(self, app: ASGIApp, *, tree: StaticTree) -> None:
        self._app = app
        self._tree = tree

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or not scope["path"].startswith(PREFIX):
            await self._app(scope, receive, send)
            return
        answer = self._answer(scope["method"], scope["path"], Headers(scope=scope))
        await answer(scope, receive, send)

    def _answer(self, method: str, path: str, headers: Headers) -> Response:
        if method not in ("GET", "HEAD"):
            return PlainTextResponse(f"{method} is not possible here", 405, {"Allow": "GET, HEAD"})
        digest, _, way = path.removeprefix(PREFIX).partition("/")
        file = self._tree.files.get(way) if digest == self._tree.digest else None
        if file is None:
            return PlainTextResponse("no such file: load the page again", 404)
        return file.answer(headers, {"Cache-Control": FOR_EVER})
