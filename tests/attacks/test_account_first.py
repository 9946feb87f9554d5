"""Attacks where second factors meet passwords that others know, tokens, and auditors kept apart."""

import time

import httpx

from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import TESTS, token_of
from tests.attacks.login_service import (
    API,
    LOGIN,
    PASSWORD,
    Clock,
    Serve,
    add_user,
    another,
)
from tests.attacks.test_second_factor import (
    ACCOUNT,
    MOTORS,
    REQUIRED,
    TOKENS,
    elsewhere,
    one_time_code,
    set_up,
)

OTHER, OWN = "quite another battery", "staple of my very own"
USERS = f"{API}/users"


def manager(serve: Serve, repository: Repository) -> httpx.Client:
    """Ada, who manages users."""
    browser = serve()
    assert browser.post(LOGIN, json=add_user(repository, "ada", Role.SECADM)).status_code == 200
    return browser


def test_who_has_another_ones_password_and_no_factor_sees_to_both_first(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    ada, browser = manager(serve, repository), serve(**REQUIRED)
    add_user(repository, "anna", Role.OPERATOR)
    assert ada.put(f"{USERS}/anna/password", json={"password": OTHER}).status_code == 204
    wanted = {"name": "anna", "password": OTHER, "code": one_time_code(ada, "anna")}
    page = browser.post("/login", data={**wanted, "next": "/alarms"})
    assert page.headers["location"] == "/account"
    account = browser.get(ACCOUNT).json()
    assert (account["second_factor"], account["password_set_by"]) == ("missing", "ada")
    assert account["permissions"] == ["account"]
    assert "ada set this password" in browser.get(MOTORS).json()["detail"]
    proposal = browser.post(f"{ACCOUNT}/totp", json={"password": OTHER}).json()["secret"]
    confirmed = browser.post(f"{ACCOUNT}/totp/confirmation", json={"code": clock.code(proposal)})
    assert confirmed.status_code == 200
    assert browser.get(MOTORS).status_code == 403, "the password is still the other one's"
    assert browser.post(TOKENS, json={"label": "a way round"}).status_code == 403
    assert browser.put(f"{ACCOUNT}/password", json={"old": OTHER, "new": OWN}).status_code == 204
    clock.next_step()
    assert browser.post(LOGIN, json={"name": "anna", "password": OWN}).status_code == 401
    answer = browser.post(LOGIN, json={"name": "anna", "password": OWN, "code": clock.code(proposal)})
    assert answer.json()["permissions"] != ["account"]
    assert browser.get(MOTORS).status_code == 200


def test_an_own_password_leaves_the_factor_to_be_set_up(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    ada, browser = manager(serve, repository), serve(**REQUIRED)
    anna = add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json={**anna, "code": one_time_code(ada, "anna")})
    refused = browser.get(MOTORS)
    assert refused.status_code == 403
    assert "mcc second-factor set-up" in refused.json()["detail"]
    set_up(browser, clock)
    assert browser.get(MOTORS).status_code == 200


def test_a_wrong_code_is_a_refused_login_like_a_wrong_password(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    set_up(browser, clock)
    for guess in ({**anna, "password": "wrong"}, {**anna, "code": "000000"}, anna):
        assert elsewhere(browser, guess).status_code == 401
    headers = {"Authorization": f"Bearer {token_of(repository)}"}
    with another(browser) as prometheus:
        figures = prometheus.get("/metrics", headers=headers).text
    assert 'mcc_refused_requests_total{reason="login"} 3.0' in figures
    noted = [one.subject for one in repository.refusals_since(0) if one.action == "login-failed"]
    assert noted == ["anna"] * 3, "the alarms tell of guessed codes too"


def test_a_reset_ends_tokens_too(serve: Serve, repository: Repository, clock: Clock) -> None:
    ada, browser = manager(serve, repository), serve()
    browser.post(LOGIN, json=add_user(repository, "anna", Role.OPERATOR))
    token = browser.post(TOKENS, json={"label": "on the lost telephone"}).json()["token"]
    set_up(browser, clock)
    with another(browser) as telephone:
        telephone.headers["Authorization"] = f"Bearer {token}"
        assert telephone.get(MOTORS).status_code == 200
        one_time_code(ada, "anna")
        assert telephone.get(MOTORS).status_code == 401


def test_who_manages_users_takes_no_factor_of_an_auditor(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    ada, browser = manager(serve, repository), serve()
    browser.post(LOGIN, json=add_user(repository, "paul", Role.SECAUD))
    set_up(browser, clock)
    for path in (f"{API}/users/paul/second-factor/reset", "/people/paul/second-factor/reset"):
        assert ada.post(path).status_code == 403
    assert browser.get(ACCOUNT).json()["second_factor"] == "set-up"
    for guess in (PASSWORD, OTHER):
        answer = ada.put(f"{USERS}/paul/password", json={"password": guess})
        assert answer.status_code == 403, "nor learns whether it is the present password"


def test_nobody_resets_their_own_factor_with_a_stolen_token(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    ada = manager(serve, repository)
    token = ada.post(TOKENS, json={"label": "stolen"}).json()["token"]
    set_up(ada, clock)
    with another(ada) as thief:
        thief.headers["Authorization"] = f"Bearer {token}"
        answer = thief.post(f"{USERS}/ada/second-factor/reset")
    assert answer.status_code == 409
    assert repository.user("ada").has_second_factor


def test_who_becomes_an_auditor_has_no_factor_that_others_set_up(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser = serve()
    browser.post(LOGIN, json=add_user(repository, "paula", Role.OPERATOR))
    set_up(browser, clock)
    repository.change_user("paula", roles=[Role.SECAUD], by=TESTS, now_ns=time.time_ns())
    assert not repository.user("paula").has_second_factor
    assert repository.recovery_codes_left("paula") == 0
