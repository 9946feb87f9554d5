"""Writes the tables of docs/reference/roles.md from the code."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

from fastapi.routing import iter_route_contexts

from service.access.permissions import MEANINGS, PERMISSIONS_OF, Permission
from service.api import ApiContext
from service.api.access.requirements import requirement_of
from service.api.access.site_rules import NO_SITE, rule_of
from service.configuration.settings import Settings
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.records import Role
from service.web.app import create_site
from tests.docs.pages import ROOT, between_markers

PAGE = ROOT / "docs" / "reference" / "roles.md"
HEAD = " | ".join(Role)
LINE = "|---" * (1 + len(Role))


PROBES = ("/healthz", "/readyz", "/metrics")


def is_page(path: str) -> bool:
    """Tell whether a route is one for people, not for programs."""
    return not path.startswith("/api/") and path not in PROBES


def permission_rows() -> Iterator[str]:
    """Yield the lines of the table of permissions."""
    yield f"| Permission | {HEAD} | Allows |"
    yield f"{LINE}|---|"
    for permission in Permission:
        yield f"| `{permission}` | {_marks(permission)} | {MEANINGS[permission]} |"


def route_rows(*, of_pages: bool) -> Iterator[str]:
    """Yield what needs each permission, by what it is about: the API's routes, or those of the pages."""
    needing: dict[tuple[Permission | None, str], list[str]] = {}
    for method, path, needed in sorted(_routes(of_pages=of_pages), key=lambda route: (route[1], route[0])):
        needing.setdefault((needed, str(rule_of(path, needed))), []).append(f"`{method} {path}`")
    for permission in (None, *Permission):
        for (needed, about), routes in sorted(needing.items(), key=lambda one: one[0][1]):
            if needed is permission:
                who = "anybody" if permission is None else f"`{permission}`"
                yield f"- {who}{'' if about == NO_SITE else f', {about}'}: {', '.join(routes)}"


def written(page: str) -> str:
    """Return the page with its tables made anew."""
    page = between_markers(page, "permissions", permission_rows())
    page = between_markers(page, "routes", route_rows(of_pages=False))
    return between_markers(page, "pages", route_rows(of_pages=True))


def main() -> None:
    PAGE.write_text(written(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


def _marks(permission: Permission) -> str:
    return " | ".join("yes" if permission in PERMISSIONS_OF[role] else "" for role in Role)


def _routes(*, of_pages: bool) -> Iterator[tuple[str, str, Permission | None]]:
    with tempfile.TemporaryDirectory() as name:
        directory = Path(name)
        repository = Repository(connect(f"sqlite:///{directory / 'unused.sqlite'}"))
        store = FolderStore(directory / "recordings")
        site = create_site(ApiContext(Settings(data_directory=directory), repository, store))
        for route in iter_route_contexts(site.routes):
            if is_page(str(route.path)) is not of_pages:
                continue
            for method in route.methods or ():
                yield method, str(route.path), requirement_of(route.dependencies)
