"""The links at the top of each page, and those below them where a subject has several pages."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Final

from service.access.permissions import Permission


@dataclass(frozen=True, slots=True)
class Place:
    """A page that people go to. below: addresses of pages that belong to it, beside those that begin so."""

    path: str
    words: str
    needed: Permission
    below: tuple[str, ...] = ()

    def has(self, path: str) -> bool:
        """Tell whether a page is this one, or belongs to it."""
        return any(path == one or path.startswith(f"{one.rstrip('/')}/") for one in self.below) or (
            path == self.path or (self.path != "/" and path.startswith(f"{self.path}/"))
        )


@dataclass(frozen=True, slots=True)
class Link:
    """A link to a page. is_here: whether they look at it, or at one that belongs to it."""

    path: str
    words: str
    is_here: bool = False


@dataclass(frozen=True, slots=True)
class Links:
    """The links of a page: to all subjects, and to the pages of the subject that is looked at."""

    subjects: tuple[Link, ...]
    pages: tuple[Link, ...] = ()

    @property
    def here(self) -> str:
        """Return what the subject that is looked at is called; empty where it is none of them."""
        return next((one.words for one in self.subjects if one.is_here), "")


SUBJECTS: Final = (
    Place("/", "Fleet", Permission.VIEW, ("/motors", "/wall")),
    Place("/alarms", "Alarms", Permission.VIEW),
    Place("/recordings", "Recordings", Permission.VIEW, ("/starts",)),
    Place("/relays", "Relays", Permission.VIEW),
    Place("/reports", "Reports", Permission.VIEW),
)
SETTINGS: Final = "Settings"
OF_SETTINGS: Final = (
    Place("/plant", "Plant", Permission.VIEW),
    Place("/notifications", "Notifications", Permission.NOTIFY),
    Place("/people", "People", Permission.USERS),
    Place("/audit", "Audit trail", Permission.AUDIT),
    Place("/account", "Account", Permission.ACCOUNT),
)
PAGES: Final = (*SUBJECTS, *OF_SETTINGS)
"""All pages that a link leads to from anywhere."""


def links_for(permissions: Collection[Permission], path: str) -> Links:
    """Return the links that somebody with these permissions may follow, on the page of a path.

    Settings lead to the first of their pages, which has links to the others.
    """
    subjects = _links(SUBJECTS, permissions, path)
    settings = _links(OF_SETTINGS, permissions, path)
    is_here = any(one.is_here for one in settings)
    if settings:
        subjects += (Link(settings[0].path, SETTINGS, is_here),)
    return Links(subjects, settings if is_here else ())


def home_of(permissions: Collection[Permission]) -> str:
    """Return the page that somebody with these permissions begins with."""
    return next((one.path for one in PAGES if one.needed in permissions), "/account")


def _links(places: Collection[Place], permissions: Collection[Permission], path: str) -> tuple[Link, ...]:
    return tuple(Link(one.path, one.words, one.has(path)) for one in places if one.needed in permissions)
