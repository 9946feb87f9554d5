"""Attacks on passkeys, by somebody who has a password, an answer of a device, or a device of their own."""

import json
import random
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest

from core.units import NANOSECONDS_PER_SECOND
from service.access.passkeys import (
    CHALLENGE_S,
    MOST_PASSKEYS,
    PasskeyPlace,
    PasskeyRefusedError,
    add_passkey,
    login_options,
    registration_options,
    require_passkey,
)
from service.process.sealing import Seal
from service.storage import Repository
from service.storage.errors import PasskeyExistsError
from service.storage.records import Actor, Role
from testing.service.authenticator import PRESENT, Authenticator
from tests.attacks.login_service import (
    API,
    LOGIN,
    PASSWORD,
    Serve,
    add_user,
    another,
)

ADDRESS = "https://mcc.plant.example:8710"
HOST = "mcc.plant.example"
AGAIN = {"password": PASSWORD}
MOTORS, ACCOUNT = f"{API}/motors", f"{API}/account"
PASSKEYS, OPTIONS, ASK = f"{ACCOUNT}/passkeys", f"{ACCOUNT}/passkeys/options", f"{LOGIN}/passkey"


@pytest.fixture
def browser(serve: Serve) -> httpx.Client:
    return serve(address=ADDRESS)


def device(**changed: Any) -> Authenticator:
    return Authenticator(**{"origin": ADDRESS, "rp_id": HOST} | changed)


def add(browser: httpx.Client, key: Authenticator, label: str = "blue key") -> dict[str, Any]:
    """Add a passkey for who is logged in."""
    answer = browser.post(PASSKEYS, json={"label": label, "answer": key.create(options(browser))})
    assert answer.status_code == 201, answer.text
    return dict(answer.json())


def options(browser: httpx.Client) -> dict[str, Any]:
    """What a device is asked for a new passkey with."""
    return dict(browser.post(OPTIONS, json=AGAIN).json()["options"])


def asked(browser: httpx.Client, name: str = "anna") -> dict[str, Any]:
    """What a device is asked with for a login."""
    return dict(browser.get(ASK, params={"name": name}).json()["options"])


def anna_with(browser: httpx.Client, repository: Repository, key: Authenticator) -> dict[str, str]:
    """Make anna, who logs in and adds a passkey; return what she logs in with besides."""
    anna = add_user(repository, "anna", Role.OPERATOR)
    assert browser.post(LOGIN, json=anna).status_code == 200
    add(browser, key)
    return anna


def shown(browser: httpx.Client, wanted: dict[str, str], answer: str) -> int:
    """Log in with another browser and this answer of a device; return the status."""
    with another(browser) as other:
        status = other.post(LOGIN, json={**wanted, "passkey": answer}).status_code
        assert other.get(MOTORS).status_code == status, "a refused login opens nothing"
        return status


def reasons(repository: Repository) -> Iterator[str]:
    """Why logins failed, as the audit trail has it."""
    with repository.audit_trail() as trail:
        for entry in trail.entries():
            if entry.action == "login-failed":
                yield str(json.loads(entry.after or "{}")["reason"])


def test_a_stolen_password_opens_nothing_and_is_not_told_to_be_right(
    browser: httpx.Client, repository: Repository
) -> None:
    key = device()
    anna = anna_with(browser, repository, key)
    with another(browser) as thief:
        stolen = thief.post(LOGIN, json=anna)
        guessed = thief.post(LOGIN, json={**anna, "password": "wrong", "passkey": key.get(asked(thief))})
        assert (stolen.status_code, stolen.json()) == (401, guessed.json())
        known, unknown = (asked(thief, name) for name in ("anna", "nobody"))
        assert known.keys() == unknown.keys(), "nor is it told who has a passkey"
        assert known["allowCredentials"] == unknown["allowCredentials"] == []
    assert shown(browser, anna, key.get(asked(browser))) == 200


def test_an_answer_is_taken_once(browser: httpx.Client, repository: Repository) -> None:
    for counts in (True, False):  # devices that share their passkeys count nothing
        key = device(counts=counts)
        name = f"anna-{counts}".lower()
        wanted = add_user(repository, name, Role.OPERATOR)
        browser.post(LOGIN, json=wanted)
        add(browser, key)
        answer = key.get(asked(browser, name))
        assert [shown(browser, wanted, answer) for _ in range(2)] == [200, 401]
        assert list(reasons(repository))[-1].endswith("the challenge was answered before")


def test_a_challenge_is_for_one_account_and_for_a_login(
    browser: httpx.Client, repository: Repository
) -> None:
    key = device()
    anna = anna_with(browser, repository, key)
    of_bert, of_registration = asked(browser, "bert"), options(browser)
    own = {"challenge": "AAAA"}
    for wanted in (of_bert, of_registration, own):
        assert shown(browser, anna, key.get(wanted)) == 401
    assert all("challenge was not made for this" in reason for reason in reasons(repository))


def test_a_challenge_that_is_too_old_is_refused(
    browser: httpx.Client, repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    key, now_ns = device(), time.time_ns()
    anna = anna_with(browser, repository, key)
    wanted = asked(browser)
    monkeypatch.setattr(time, "time_ns", lambda: now_ns + (CHALLENGE_S + 60) * NANOSECONDS_PER_SECOND)
    status = shown(browser, anna, key.get(wanted))
    fresh = shown(browser, anna, key.get(asked(browser)))
    monkeypatch.undo()
    assert (status, fresh) == (401, 200)


def test_the_passkey_of_another_user_is_refused(browser: httpx.Client, repository: Repository) -> None:
    key, of_bert = device(), device()
    anna = anna_with(browser, repository, key)
    browser.post(LOGIN, json=add_user(repository, "bert", Role.OPERATOR))
    add(browser, of_bert)
    assert shown(browser, anna, of_bert.get(asked(browser))) == 401
    assert "no passkey of this user" in list(reasons(repository))[-1]
    (name,) = key.keys
    of_bert.keys[name] = next(iter(of_bert.keys.values()))
    assert shown(browser, anna, of_bert.get(asked(browser), name)) == 401, "another key signs for anna's"


@pytest.mark.parametrize(
    "changed",
    [
        {"origin": "https://mcc.plant.example"},
        {"origin": "http://mcc.plant.example:8710"},
        {"origin": "https://mcc.plant.example.evil.example:8710"},
        {"rp_id": "evil.example"},
        {"rp_id": "plant.example"},
        {"flags": 0},
    ],
)
def test_an_answer_that_another_site_has_got_is_refused(
    browser: httpx.Client, repository: Repository, changed: dict[str, Any]
) -> None:
    key = device()
    anna = anna_with(browser, repository, key)
    elsewhere = device(keys=key.keys, **changed)
    assert shown(browser, anna, elsewhere.get(asked(browser))) == 401
    assert "does not hold" in list(reasons(repository))[-1]
    refused = browser.post(
        PASSKEYS, json={"label": "x", "answer": device(**changed).create(options(browser))}
    )
    assert refused.status_code == 422, "nor is a passkey added there"


def test_a_copy_of_a_device_is_refused_and_told(browser: httpx.Client, repository: Repository) -> None:
    key = device()
    anna = anna_with(browser, repository, key)
    copy = device(keys=dict(key.keys), signatures=key.signatures)
    assert shown(browser, anna, key.get(asked(browser))) == 200
    assert shown(browser, anna, key.get(asked(browser))) == 200
    assert shown(browser, anna, copy.get(asked(browser))) == 401, "its counter went back"
    assert "somebody may have a copy" in list(reasons(repository))[-1]
    silent = device(keys=key.keys, counts=False, signatures=0)
    assert shown(browser, anna, silent.get(asked(browser))) == 401
    assert shown(browser, anna, key.get(asked(browser))) == 200


def test_the_passkey_of_a_removed_user_opens_nothing(browser: httpx.Client, repository: Repository) -> None:
    key = device()
    anna = anna_with(browser, repository, key)
    admin = add_user(repository, "admin", Role.SECADM)
    with another(browser) as manager:
        manager.post(LOGIN, json=admin)
        assert manager.delete(f"{API}/users/anna").status_code == 204
        assert shown(browser, anna, key.get(asked(browser))) == 401
        add_user(repository, "anna", Role.OPERATOR)
        assert repository.passkeys("anna") == [], "nor who gets the name later"
        browser.post(LOGIN, json=anna)
        add(browser, key)
        assert manager.post(f"{API}/users/anna/second-factor/reset").status_code == 200
        assert browser.get(MOTORS).status_code == 401, "sessions end with a reset"
        assert repository.passkeys("anna") == []
        manager.patch(f"{API}/users/anna", json={"disabled": True})
        assert shown(browser, anna, key.get(asked(browser))) == 401


def test_a_removed_passkey_opens_nothing_and_ends_other_sessions(
    browser: httpx.Client, repository: Repository
) -> None:
    key, lost = device(), device()
    anna = anna_with(browser, repository, key)
    made = add(browser, lost, "lost phone")
    assert made["recovery_codes"] == [], "those of before go on"
    with another(browser) as thief:
        assert thief.post(LOGIN, json={**anna, "passkey": lost.get(asked(thief))}).status_code == 200
        path = f"{PASSKEYS}/{made['id']}/removal"
        assert browser.post(path, json={"password": "wrong"}).status_code == 401
        assert browser.post(path, json=AGAIN).status_code == 204
        assert thief.get(MOTORS).status_code == 401
        assert browser.get(MOTORS).status_code == 200
    assert shown(browser, anna, lost.get(asked(browser))) == 401
    assert shown(browser, anna, key.get(asked(browser))) == 200
    assert browser.post(path, json=AGAIN).status_code == 404


def test_nobody_removes_the_passkey_of_another(browser: httpx.Client, repository: Repository) -> None:
    key = device()
    anna = anna_with(browser, repository, key)
    (kept,) = browser.get(PASSKEYS).json()["items"]
    with another(browser) as bert:
        bert.post(LOGIN, json=add_user(repository, "bert", Role.OPERATOR))
        assert bert.get(PASSKEYS).json()["items"] == []
        assert bert.post(f"{PASSKEYS}/{kept['id']}/removal", json=AGAIN).status_code == 404
    assert shown(browser, anna, key.get(asked(browser))) == 200


def test_a_session_left_open_and_a_token_add_no_passkey(
    browser: httpx.Client, repository: Repository
) -> None:
    key = device()
    anna_with(browser, repository, key)
    assert browser.post(OPTIONS, json={"password": "wrong"}).status_code == 401
    stolen = options(browser)
    token = browser.post(f"{ACCOUNT}/tokens", json={"label": "historian"}).json()["token"]
    with another(browser) as thief:
        thief.headers["Authorization"] = f"Bearer {token}"
        assert thief.post(OPTIONS, json=AGAIN).status_code == 403
        wanted = {"label": "of a thief", "answer": device().create(stolen)}
        assert thief.post(PASSKEYS, json=wanted).status_code == 403
        del thief.headers["Authorization"]
        thief.post(LOGIN, json=add_user(repository, "bert", Role.OPERATOR))
        refused = thief.post(PASSKEYS, json=wanted)
        assert (refused.status_code, "was not made for this" in refused.text) == (422, True)
    assert len(repository.passkeys("anna")) == 1


def test_a_new_passkey_is_added_once_and_there_are_few(browser: httpx.Client, repository: Repository) -> None:
    anna_with(browser, repository, device())
    wanted = {"label": "another", "answer": device().create(options(browser))}
    assert [browser.post(PASSKEYS, json=wanted).status_code for _ in range(2)] == [201, 422]
    again = {**wanted, "answer": device().create(options(browser))}
    assert browser.post(PASSKEYS, json=again).status_code == 409, "its name is used"
    for number in range(2, MOST_PASSKEYS):
        add(browser, device(), f"key {number}")
    one_too_many = {"label": "too many", "answer": device().create(options(browser))}
    assert browser.post(PASSKEYS, json=one_too_many).status_code == 409


def test_a_passkey_is_the_second_factor_that_a_role_needs(serve: Serve, repository: Repository) -> None:
    lax = serve(address=ADDRESS)
    strict = serve(address=ADDRESS, second_factor_roles=["OPERATOR", "SECADM"])
    lax.post(LOGIN, json=add_user(repository, "admin", Role.SECADM))
    anna = add_user(repository, "anna", Role.OPERATOR)
    code = lax.post(f"{API}/users/anna/second-factor/reset").json()["code"]
    key = device()
    assert strict.post(LOGIN, json={**anna, "code": code}).json()["second_factor"] == "missing"
    assert strict.get(MOTORS).status_code == 403
    made = add(strict, key)
    assert len(made["recovery_codes"]) == 10
    assert strict.get(MOTORS).status_code == 200
    last = strict.post(f"{PASSKEYS}/{made['id']}/removal", json=AGAIN)
    assert (last.status_code, "your last one" in last.text) == (409, True)
    assert shown(strict, anna, key.get(asked(strict))) == 200
    with another(strict) as other:
        recovered = {**anna, "code": made["recovery_codes"][0]}
        assert [other.post(LOGIN, json=recovered).status_code for _ in range(2)] == [200, 401]


def test_the_last_passkey_takes_the_recovery_codes_along(
    browser: httpx.Client, repository: Repository
) -> None:
    anna = add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    made = add(browser, device())
    assert browser.post(f"{PASSKEYS}/{made['id']}/removal", json=AGAIN).status_code == 204
    assert browser.get(ACCOUNT).json()["second_factor"] == "none"
    assert repository.recovery_codes_left("anna") == 0
    with repository.audit_trail() as trail:
        told = [(entry.action, entry.subject) for entry in trail.entries()]
    assert told[-2:] == [("second-factor-added", "anna"), ("second-factor-removed", "anna")]


def test_who_is_there_is_enough_where_the_device_cannot_tell_who(
    browser: httpx.Client, repository: Repository
) -> None:
    key = device(flags=PRESENT)
    anna = anna_with(browser, repository, key)
    assert asked(browser)["userVerification"] == "preferred"
    assert shown(browser, anna, key.get(asked(browser))) == 200


@pytest.mark.parametrize(
    "address",
    [None, "http://mcc.plant.example", "https://192.0.2.1:8710", "http://127.0.0.1:8710", "https://[::1]"],
)
def test_where_browsers_know_no_passkeys_none_is_asked_for(
    serve: Serve, repository: Repository, address: str | None
) -> None:
    browser = serve(address=address)
    anna = add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    for refused in (browser.post(OPTIONS, json=AGAIN), browser.get(ASK, params={"name": "anna"})):
        assert refused.status_code == 409
        assert "notifications.address such as https://mcc.plant.example" in refused.json()["detail"]
    assert "data-passkey" not in browser.get("/login").text
    assert "passkeys need a name and TLS" in browser.get("/account").text


def test_nonsense_for_an_answer_is_refused_and_nothing_more(repository: Repository, tmp_path: Path) -> None:
    """Answers with values changed, cut off and exchanged, of a login and of a new passkey."""
    key, chance = device(), random.Random(7)
    seal, place, by = Seal(tmp_path / "secrets.key"), PasskeyPlace.of(ADDRESS), Actor("anna", "192.0.2.1")
    add_user(repository, "anna", Role.OPERATOR)
    taken = 0

    def offered(answer: str) -> None:
        add_passkey(
            repository, seal, place, "anna", str(taken), answer, session="s", by=by, now_ns=time.time_ns()
        )

    def made(one: Authenticator) -> str:
        return one.create(registration_options(repository, seal, place, "s", by=by, now_ns=time.time_ns()))

    def got() -> str:
        return key.get(login_options(seal, place, "anna", now_ns=time.time_ns()))

    offered(made(key))
    for _ in range(300):
        for answer, look in ((made(device()), offered), (got(), partial(_required, repository, seal, place))):
            try:
                look(spoiled(answer, chance))
                taken += 1
            except (PasskeyRefusedError, PasskeyExistsError):
                continue
    assert taken < 60, "few changes make no difference, such as of what is not signed"


def _required(repository: Repository, seal: Seal, place: PasskeyPlace, answer: str) -> None:
    require_passkey(repository, seal, place, "anna", answer, now_ns=time.time_ns())


def spoiled(text: str, chance: random.Random) -> str:
    """Return an answer of a device with something else in it."""
    answer = json.loads(text)
    part = chance.choice([answer, answer["response"]])
    name = chance.choice(sorted(part))
    others: list[object] = [None, 7, [], {}, "", "A", "é", "A" * 5000]
    if isinstance(part[name], str):
        old, at = part[name], chance.randrange(len(part[name]))
        others += 12 * [old[:at] + chance.choice("ABC_-9") + old[at + 1 :]] + 4 * [old[:at]]
    part[name] = chance.choice(others)
    return chance.choice(["", "[" * 5000, text[:50]]) if chance.random() < 0.05 else json.dumps(answer)
