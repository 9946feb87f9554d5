"""Links that log a user in once."""

import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from core.units import NANOSECONDS_PER_SECOND
from service.access.login_links import LIFE_S, is_good, new_login_link, user_of_link
from service.storage import NotFoundError, Repository
from service.storage.records import Role
from testing.service.accounts import TESTS

NOW_NS = time.time_ns()
LATER_NS = NOW_NS + (LIFE_S - 1) * NANOSECONDS_PER_SECOND
TOO_LATE_NS = NOW_NS + LIFE_S * NANOSECONDS_PER_SECOND


@pytest.fixture
def link(repository: Repository) -> str:
    """The secret of a link of Anna's."""
    repository.add_user("anna", [Role.VIEWER], password=None, by=TESTS, now_ns=NOW_NS)
    repository.add_user("bert", [Role.SECADM], password=None, by=TESTS, now_ns=NOW_NS)
    return new_login_link(repository, "anna", by=TESTS, now_ns=NOW_NS)


def test_a_link_is_followed_once(repository: Repository, link: str) -> None:
    assert is_good(repository, link, now_ns=LATER_NS)
    with ThreadPoolExecutor(4) as browsers:
        found = list(browsers.map(lambda _: user_of_link(repository, link, now_ns=LATER_NS), range(4)))
    assert [user.name for user in found if user is not None] == ["anna"]
    assert not is_good(repository, link, now_ns=LATER_NS)


def test_a_link_ends_by_itself(repository: Repository, link: str) -> None:
    assert not is_good(repository, link, now_ns=TOO_LATE_NS)
    assert user_of_link(repository, link, now_ns=TOO_LATE_NS) is None
    assert user_of_link(repository, link, now_ns=NOW_NS) is None, "and that it was too late uses it up"


@pytest.mark.parametrize("guess", ["", "x", "x" * 10_000, "\ud800"])
def test_a_guess_lets_nobody_in(repository: Repository, link: str, guess: str) -> None:
    assert user_of_link(repository, guess, now_ns=NOW_NS) is None
    assert is_good(repository, link, now_ns=NOW_NS)


def test_links_end_with_the_sessions_of_their_user(repository: Repository, link: str) -> None:
    repository.end_sessions_of("anna", by=TESTS, now_ns=NOW_NS)
    assert user_of_link(repository, link, now_ns=NOW_NS) is None


def test_a_disabled_user_has_no_links(repository: Repository, link: str) -> None:
    repository.change_user("anna", disabled=True, by=TESTS, now_ns=NOW_NS)
    assert user_of_link(repository, link, now_ns=NOW_NS) is None
    with pytest.raises(NotFoundError):
        new_login_link(repository, "anna", by=TESTS, now_ns=NOW_NS)


def test_a_user_with_links_can_be_deleted(repository: Repository, link: str) -> None:
    repository.delete_user("anna", by=TESTS, now_ns=NOW_NS)
    assert not is_good(repository, link, now_ns=NOW_NS)


def test_the_audit_trail_tells_of_a_link_and_not_its_secret(repository: Repository, link: str) -> None:
    entries = repository.audit_entries(limit=10).items
    (entry,) = [entry for entry in entries if entry.action == "login-link-made"]
    assert (entry.actor, entry.subject) == (TESTS.name, "anna")
    assert link not in repr(entries)
