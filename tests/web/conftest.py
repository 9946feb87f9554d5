"""One browser for all tests of a process, and a site with a seeded plant for each module or test."""

import shutil
from collections.abc import Iterator, MutableMapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import pytest
import structlog
from playwright.sync_api import Browser, expect

from testing.not_installed import not_installed
from testing.web.chromium import INSTALL, chromium_path, running_browser
from testing.web.seeding import demo_plant, seed
from testing.web.site import LONGEST_MS, Site, running_site


@pytest.fixture(autouse=True)
def logs() -> Iterator[list[MutableMapping[str, Any]]]:
    """What the service logs, kept from the screen: tracebacks for people take seconds to draw."""
    with structlog.testing.capture_logs() as entries:
        yield entries


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """A browser for the session. Where none is installed the test is skipped, and fails where CI=true."""
    path = chromium_path()
    if path is None:
        not_installed(f"no chromium: {INSTALL}")
    expect.set_options(timeout=LONGEST_MS)
    with running_browser(path) as browser:
        yield browser


@pytest.fixture(scope="session")
def seeded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The data directory of a plant with something to see on every page, to copy."""
    data = tmp_path_factory.mktemp("seeded")
    seed(data)
    return data


@pytest.fixture(scope="module")
def shared_site(seeded: Path, tmp_path_factory: pytest.TempPathFactory, browser: Browser) -> Iterator[Site]:
    """A site of the seeded plant for tests that only look."""
    with _site_of(seeded, tmp_path_factory.mktemp("shared"), browser) as site:
        yield site


@pytest.fixture
def looked_at(shared_site: Site) -> Iterator[Site]:
    """That site; its pages are closed after the test, and nothing may have gone wrong in them."""
    yield shared_site
    problems = shared_site.close_pages()
    assert not problems, "\n".join(problems)


@pytest.fixture
def site(seeded: Path, tmp_path: Path, browser: Browser) -> Iterator[Site]:
    """A site of the seeded plant of the test's own; nothing may have gone wrong in its pages."""
    with _site_of(seeded, tmp_path / "data", browser) as site:
        yield site
        problems = site.close_pages()
        assert not problems, "\n".join(problems)


def _site_of(seeded: Path, data: Path, browser: Browser) -> AbstractContextManager[Site]:
    shutil.copytree(seeded, data, dirs_exist_ok=True)
    motors = {one.name: one.motor for one in demo_plant().motors}
    return running_site(data, browser, motors=motors)
