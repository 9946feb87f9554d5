"""Passwords that an attacker guesses first, at every place where somebody chooses one."""

import json
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest

from service.access.passwords import is_correct
from service.cli import main
from service.configuration.settings import Settings
from service.storage import Repository, connect
from service.storage.records import Role
from testing.service.accounts import TESTS
from testing.service.database import make_database
from tests.attacks.login_service import (
    API,
    LOGIN,
    PASSWORD,
    Serve,
    add_user,
)

NAME = "anna.maria-long"
FULL_NAME = "Annabel Featherstone"
GOOD = "quite another battery"

GUESSED_FIRST = [
    "1234567890",
    "aaaaaaaaaa",
    "password123",
    "qwertyuiop",
    NAME,
    NAME.title(),
    "maria-long",
    "featherstone",
    "statorwatch",
    "a" * 1000,
]

Choose = Callable[[httpx.Client, str], httpx.Response]


def _own(browser: httpx.Client, password: str) -> httpx.Response:
    return browser.put(f"{API}/account/password", json={"old": PASSWORD, "new": password})


def _own_on_page(browser: httpx.Client, password: str) -> httpx.Response:
    form = {"old": PASSWORD, "new": password, "again": password}
    return browser.post("/account/password", data=form)


OWN: dict[str, Choose] = {"own": _own, "own on the page": _own_on_page}
ANOTHERS: dict[str, Choose] = {
    "another's": lambda it, password: it.put(f"{API}/users/{NAME}/password", json={"password": password}),
    "another's on the page": lambda it, password: it.post(
        f"/people/{NAME}/password", data={"password": password}
    ),
}


@pytest.mark.parametrize("way", [*OWN, *ANOTHERS])
def test_nobody_changes_to_a_password_that_is_guessed_first(
    serve: Serve, repository: Repository, way: str
) -> None:
    browser, user = serve(failed_logins=1000), add_user(repository, NAME, Role.ENGINEER)
    repository.change_user(NAME, full_name=FULL_NAME, by=TESTS, now_ns=1)
    who = user if way in OWN else add_user(repository, "admin", Role.SECADM)
    choose = {**OWN, **ANOTHERS}[way]
    assert browser.post(LOGIN, json=who).status_code == 200
    for password in [*GUESSED_FIRST, PASSWORD]:
        answer = choose(browser, password)
        assert answer.status_code == 422, password
        assert ("the present one" if password == PASSWORD else "easy to guess") in answer.text
    assert is_correct(PASSWORD, repository.password_of(NAME))
    assert choose(browser, GOOD).status_code in (204, 303)
    assert is_correct(GOOD, repository.password_of(NAME))


NEW_USER: dict[str, Choose] = {
    "a new user's": lambda it, password: it.post(
        f"{API}/users", json={"name": NAME, "full_name": FULL_NAME, "roles": [], "password": password}
    ),
    "a new user's on the page": lambda it, password: it.post(
        "/people", data={"name": NAME, "full_name": FULL_NAME, "password": password}
    ),
}


@pytest.mark.parametrize("way", NEW_USER)
def test_no_user_begins_with_a_password_that_is_guessed_first(
    serve: Serve, repository: Repository, way: str
) -> None:
    browser = serve()
    assert browser.post(LOGIN, json=add_user(repository, "admin", Role.SECADM)).status_code == 200
    for password in GUESSED_FIRST:
        assert NEW_USER[way](browser, password).status_code == 422, password
    assert NEW_USER[way](browser, GOOD).status_code in (201, 303)


def test_neither_does_the_first_administrator(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    make_database(tmp_path)
    config, file = tmp_path / "mcc.toml", tmp_path / "password"
    config.write_text(f"data_directory = {json.dumps(str(tmp_path))}\n")
    file.touch(mode=0o600)

    def chosen(password: str, *words: str) -> int:
        file.write_text(f"{password}\n")
        return main(["user", *words, NAME, "--config", str(config), "--password-file", str(file)])

    add = ("add", "--role", "SECADM", "--full-name", FULL_NAME)
    for password in GUESSED_FIRST:
        assert chosen(password, *add) == 1, password
        assert "nothing was changed" in capsys.readouterr().err
    assert chosen(PASSWORD, *add) == 0
    for password in [*GUESSED_FIRST, PASSWORD]:
        assert chosen(password, "password") == 1, password
    assert chosen(GOOD, "password") == 0
    engine = connect(Settings(data_directory=tmp_path).database_url)
    assert is_correct(GOOD, Repository(engine).password_of(NAME))
    engine.dispose()


def test_a_disabled_user_gets_no_old_password_back(serve: Serve, repository: Repository) -> None:
    browser = serve()
    add_user(repository, NAME, Role.VIEWER)
    assert browser.post(LOGIN, json=add_user(repository, "admin", Role.SECADM)).status_code == 200
    assert browser.patch(f"{API}/users/{NAME}", json={"disabled": True}).status_code == 200
    answer = browser.put(f"{API}/users/{NAME}/password", json={"password": PASSWORD})
    assert answer.status_code == 422
    assert "found the present one" in answer.json()["detail"]
