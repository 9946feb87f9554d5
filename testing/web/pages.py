"""All pages of the site, by their routes, and an address of each on a plant that is there."""

import re
from collections.abc import Callable, Mapping

import httpx
from fastapi.routing import APIRoute

from service.access.permissions import Permission
from service.api.access.cookies import NAME
from service.api.access.requirements import requirement_of
from service.storage import Repository
from service.storage.records import Role
from service.web.addresses import path_segment
from service.web.app import ROOMS
from testing.service.accounts import EVERYTHING

STREAMS = ("/live",)
"""Answers that do not end."""

ACCEPT = {"Accept": "text/html,application/xhtml+xml,*/*;q=0.8"}


def routes(method: str = "GET") -> Mapping[str, Permission | None]:
    """Return the paths of the site's routes beside the API's, and what each needs of who asks."""
    return {
        route.path: requirement_of(route.dependencies)
        for room in ROOMS
        for route in room.router.routes
        if isinstance(route, APIRoute) and method in (route.methods or ())
    }


def page_routes() -> list[str]:
    """Return the paths of what may be pages: all that answers to GET and ends."""
    return [path for path in routes() if not path.startswith(STREAMS)]


def permission_for(method: str, path: str) -> Permission | None:
    """Return what an address needs of who asks. Raises LookupError where no route has it."""
    for template, permission in routes(method).items():
        if re.fullmatch(re.sub(r"\{\w+\}", "[^/]+", template), path.partition("?")[0]):
            return permission
    raise LookupError(f"no route for {method} {path}")


def roles_for(path: str) -> tuple[Role, ...]:
    """Return roles of one user that sees a page: the auditor's pages are for nobody who manages users."""
    return (Role.SECAUD,) if permission_for("GET", path) is Permission.AUDIT else EVERYTHING


def _motor(repository: Repository) -> str:
    """The motor with most to see: one that has a recording with a waveform, where there is one."""
    latest = [one for one in repository.recordings(limit=1000).items if one.name in ("RUNNING", "START")]
    return latest[0].motor if latest else repository.motors(limit=1).items[0].name


def _recording(repository: Repository) -> str:
    found = repository.recordings(limit=1000).items
    return next((one.id for one in found if one.name == "RUNNING"), found[0].id)


FILLED: Mapping[str, Callable[[Repository], str]] = {
    "/motors/{}": _motor,
    "/recordings/{}": _recording,
    "/relays/{}": lambda repository: repository.relays(limit=1).items[0].name,
    "/people/{}": lambda repository: repository.users(limit=1).items[0].name,
    "/alarms/{}": lambda repository: repository.open_alarms(limit=1).items[0].id,
}
"""Which thing stands in the address of a page about one, by the beginning of its path."""


def address_of(route: str, repository: Repository) -> str | None:
    """Return an address of a page; None where the plant has no such thing. Raises LookupError."""
    if "{" not in route:
        return route
    beginning = re.sub(r"\{\w+\}", "{}", route[: route.index("}") + 1])
    try:
        name = FILLED[beginning](repository)
    except IndexError:
        return None
    filled = route[: route.index("{")] + path_segment(name) + route[route.index("}") + 1 :]
    if "{" in filled:
        raise LookupError(f"say in FILLED what stands in {route}")
    return filled


def is_page(url: str, path: str, session: str) -> bool:
    """Tell whether an address answers with a whole page, and not with a part of one, a file or a redirect."""
    with httpx.Client(base_url=url, headers=ACCEPT, cookies={NAME: session}, trust_env=False) as client:
        answer = client.get(path)
    assert answer.status_code < 500, f"{path}: {answer.status_code} {answer.text[:300]}"
    kind = answer.headers.get("content-type", "")
    return answer.is_success and kind.startswith("text/html") and "<html" in answer.text[:500]
