"""The whole site on a port of the loopback, with a session for every role."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from importlib.resources.abc import Traversable
from pathlib import Path

from fastapi import FastAPI
from playwright.sync_api import Browser

from core.machines.parameters import Motor
from service.access.bearer_secrets import digest_of, new_session
from service.api.access.cookies import NAME
from service.api.context import ApiContext
from service.api.server import connection_limits
from service.configuration.settings import Settings, sqlite_url
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.errors import UserExistsError
from service.storage.records import Actor, Role
from service.web.app import create_site
from service.web.help.pages import FOLDER
from testing.service.accounts import EVERYTHING, TESTS
from testing.service.listening import LONGEST_S, listening
from testing.web.watched_page import WatchedPage

DESKTOP = (1280, 800)
PHONE = (360, 740)

Screen = tuple[int, int]
"""Width and height [CSS px]."""

LONGEST_MS = 1000 * LONGEST_S
"""Nobody waits longer for a page to show something."""


@dataclass
class Site:
    """A running site. pages: those that were opened, to look at their problems at the end."""

    url: str
    context: ApiContext
    app: FastAPI
    browser: Browser
    pages: list[WatchedPage] = field(default_factory=list)

    @property
    def repository(self) -> Repository:
        return self.context.repository

    def open(
        self,
        *roles: Role,
        user: str | None = None,
        screen: Screen = DESKTOP,
        dark: bool = False,
        javascript: bool = True,
        reduced_motion: bool = True,
        time_zone: str = "Europe/Berlin",
    ) -> WatchedPage:
        """Return a page of a browser of its own, logged in as somebody with these roles; as nobody with none.

        user: the name of a user who is there already, in place of roles.
        """
        width, height = screen
        window = self.browser.new_context(
            viewport={"width": width, "height": height},
            is_mobile=False,
            has_touch=width < 600,
            color_scheme="dark" if dark else "light",
            java_script_enabled=javascript,
            reduced_motion="reduce" if reduced_motion else "no-preference",
            timezone_id=time_zone,
            locale="en-GB",
            accept_downloads=True,
        )
        if user is not None or roles:
            secret = self.log_in(*roles, user=user)
            window.add_cookies(
                [{"name": NAME, "value": secret, "url": self.url, "httpOnly": True, "sameSite": "Strict"}]
            )
        page = WatchedPage(window.new_page(), self.url)
        page.page.set_default_timeout(LONGEST_MS)
        self.pages.append(page)
        return page

    def log_in(self, *roles: Role, user: str | None = None) -> str:
        """Return the secret of a new session of a user, or of one with these roles, by default EVERYTHING."""
        return log_in(self.repository, *roles, user=user)

    def close_pages(self) -> list[str]:
        """Close all pages; return what went wrong in them."""
        problems = [f"{one.path}: {problem}" for one in self.pages for problem in one.problems]
        for one in self.pages:
            one.page.context.close()
        self.pages.clear()
        return problems


def log_in(repository: Repository, *roles: Role, user: str | None = None) -> str:
    """Return the secret of a new session of a user, or of one with these roles, by default EVERYTHING."""
    now_ns = time.time_ns()
    if user is None:
        roles = roles or EVERYTHING
        user = "-".join(sorted(role.lower() for role in set(roles)))
        with suppress(UserExistsError):
            repository.add_user(user, roles, password=None, by=TESTS, now_ns=now_ns)
    secret, by = new_session(), Actor(user, "127.0.0.1")
    repository.begin_session(
        digest_of(secret), user, "tests", most=100, oldest_ns=0, idle_since_ns=0, by=by, now_ns=now_ns
    )
    return secret


@contextmanager
def running_site(
    data: Path,
    browser: Browser,
    *,
    motors: Mapping[str, Motor] | None = None,
    host: str = "127.0.0.1",
    port: int = 0,
    help_folder: Traversable = FOLDER,
    **settings: object,
) -> Iterator[Site]:
    """The site of a data directory with a migrated database, in this process.

    motors: as the motors file has them, by name.  host: what pages are asked for at.  port: 0 for any.
    help_folder: where the help pages were made.
    """
    engine = connect(sqlite_url(data))
    context = ApiContext(
        Settings(data_directory=data, **settings),  # type: ignore[arg-type]  # names of its fields
        Repository(engine),
        FolderStore(data / "recordings"),
        motors=dict(motors or {}),
    )
    try:
        app = create_site(context, help_folder=help_folder)
        with listening(app, connection_limits(context.settings), port=port) as port:
            site = Site(f"http://{host}:{port}", context, app, browser)
            try:
                yield site
            finally:
                site.close_pages()
    finally:
        engine.dispose()
