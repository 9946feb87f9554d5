"""The links at the top of each page."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Final

from service.access.permissions import Permission


@dataclass(frozen=True, slots=True)
class Link:
    """A page that people go to. is_here: whether they look at it, or at one below it."""

    path: str
    words: str
    is_here: bool = False


PAGES: Final[tuple[tuple[str, str, Permission], ...]] = (
    ("/", "Fleet", Permission.VIEW),
    ("/starts", "Starts", Permission.VIEW),
    ("/alarms", "Alarms", Permission.VIEW),
    ("/recordings", "Recordings", Permission.VIEW),
    ("/relays", "Relays", Permission.VIEW),
    ("/reports", "Reports", Permission.VIEW),
    ("/plant", "Plant", Permission.VIEW),
    ("/notifications", "Notifications", Permission.NOTIFY),
    ("/people", "People", Permission.USERS),
    ("/audit", "Audit trail", Permission.AUDIT),
    ("/account", "Account", Permission.ACCOUNT),
)
"""The path of each page, its name, and what one needs to see it."""


def links_for(permissions: Collection[Permission], path: str) -> tuple[Link, ...]:
    """Return the links to the pages that somebody with these permissions may see."""
    return tuple(
        Link(address, words, _is_below(path, address))
        for address, words, needed in PAGES
        if needed in permissions
    )


def home_of(permissions: Collection[Permission]) -> str:
    """Return the page that somebody with these permissions begins with."""
    return next((address for address, _, needed in PAGES if needed in permissions), "/account")


def _is_below(path: str, address: str) -> bool:
    if address == "/":
        return path == "/" or path.startswith("/motors")
    return path == address or path.startswith(f"{address}/")
