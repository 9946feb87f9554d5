"""Attacks on the second factor, by somebody who has a password, a session, a token, or the database."""

import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx
import pytest
from sqlalchemy import Engine, text

from service.access.logins import LoginRefusedError, begin_session, check_login
from service.configuration.access import AccessSettings
from service.process.sealing import Seal, SealError
from service.storage import Repository
from service.storage.records import Actor, Role
from tests.attacks.login_service import (
    API,
    LOGIN,
    PASSWORD,
    Clock,
    Serve,
    add_user,
    another,
)

REQUIRED = {"second_factor_roles": ["OPERATOR", "SECADM"]}
AGAIN = {"password": PASSWORD}
ACCOUNT, TOKENS, MOTORS = f"{API}/account", f"{API}/account/tokens", f"{API}/motors"
PROPOSE, CONFIRM = f"{ACCOUNT}/totp", f"{ACCOUNT}/totp/confirmation"
CODES, REMOVE = f"{ACCOUNT}/recovery-codes", f"{ACCOUNT}/second-factor/removal"


pytestmark = pytest.mark.usefixtures("clock")


def set_up(browser: httpx.Client, clock: Clock) -> tuple[str, list[str]]:
    """Set up an app for who is logged in; return its secret and the recovery codes."""
    secret = browser.post(PROPOSE, json=AGAIN).json()["secret"]
    answer = browser.post(CONFIRM, json={"code": clock.code(secret)})
    assert answer.status_code == 200, answer.text
    clock.next_step()
    return secret, answer.json()["recovery_codes"]


def elsewhere(browser: httpx.Client, wanted: dict[str, str]) -> httpx.Response:
    """Log in with another browser."""
    with another(browser) as other:
        return other.post(LOGIN, json=wanted)


def audited(repository: Repository) -> list[tuple[str, str, str]]:
    with repository.audit_trail() as trail:
        return [(entry.action, entry.subject, entry.actor) for entry in trail.entries()]


def one_time_code(browser: httpx.Client, name: str) -> str:
    """Have the second factor of a user reset by somebody who manages users; return the code."""
    answer = browser.post(f"{API}/users/{name}/second-factor/reset")
    assert answer.status_code == 200, answer.text
    return str(answer.json()["code"])


def test_a_stolen_password_alone_opens_nothing(serve: Serve, repository: Repository, clock: Clock) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    set_up(browser, clock)
    with another(browser) as thief:
        stolen = thief.post(LOGIN, json=anna)
        guessed = thief.post(LOGIN, json={**anna, "password": "wrong"})
        assert (stolen.status_code, guessed.status_code) == (401, 401)
        assert stolen.json() == guessed.json(), "it does not tell that the password is right"
        form = thief.post("/login", data=anna, headers={"Accept": "text/html"})
        assert (form.status_code, dict(thief.cookies)) == (401, {})
        assert thief.get(MOTORS).status_code == 401
    with pytest.raises(LoginRefusedError):  # as at the OPC UA server, which has no place for a code
        check_login(
            repository,
            AccessSettings(),
            "anna",
            PASSWORD,
            None,
            "opcua 192.0.2.1",
            now_ns=clock.now_ns,
        )


def test_nor_does_it_where_the_role_needs_a_factor_that_nobody_has_set_up(
    serve: Serve, repository: Repository
) -> None:
    browser, anna = serve(**REQUIRED), add_user(repository, "anna", Role.OPERATOR)
    assert browser.post(LOGIN, json=anna).status_code == 401
    assert browser.post(LOGIN, json={**anna, "code": "000000"}).status_code == 401
    vera = add_user(repository, "vera", Role.VIEWER)
    assert browser.post(LOGIN, json=vera).status_code == 200, "other roles need none"


def test_a_code_that_somebody_looked_at_is_of_no_use(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    secret, _ = set_up(browser, clock)
    with another(browser) as thief:
        confirming = {**anna, "code": clock.code(secret, -1)}
        assert thief.post(LOGIN, json=confirming).status_code == 401, "it confirmed the app"
        used = {**anna, "code": clock.code(secret)}
        assert browser.post(LOGIN, json=used).status_code == 200
        assert thief.post(LOGIN, json=used).status_code == 401
        clock.next_step()
        assert thief.post(LOGIN, json=used).status_code == 401, "the step before is near enough"
    assert browser.post(LOGIN, json={**anna, "code": clock.code(secret)}).status_code == 200


def test_of_two_who_show_one_code_at_once_one_gets_in(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    secret, (recovery_code, *_) = set_up(browser, clock)

    def status(code: str) -> int:
        with another(browser) as one:
            return one.post(LOGIN, json={**anna, "code": code}).status_code

    with ThreadPoolExecutor(2) as threads:
        for code in (clock.code(secret), recovery_code):
            assert sorted(threads.map(status, [code] * 2)) == [200, 401]


def test_a_code_is_not_guessed(serve: Serve, repository: Repository, clock: Clock) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    set_up(browser, clock)
    with another(browser) as thief:
        guesses = [anna, {**anna, "code": "000000"}, anna, {**anna, "code": "0000-0000-0000-0000"}, anna]
        assert [thief.post(LOGIN, json=guess).status_code for guess in guesses] == [401] * 5
        assert thief.post(LOGIN, json=guesses[1]).status_code == 429, "the right password does not forget"
    reasons = [entry for entry in audited(repository) if entry[0] == "login-failed"]
    assert reasons == [("login-failed", "anna", "anna")] * 5


def test_a_recovery_code_counts_once(serve: Serve, repository: Repository, clock: Clock) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    _, codes = set_up(browser, clock)
    assert len(set(codes)) == 10
    typed = codes[0].upper().replace("-", " ")
    assert browser.post(LOGIN, json={**anna, "code": typed}).status_code == 200
    assert browser.get(ACCOUNT).json()["recovery_codes_left"] == 9
    assert ("recovery-code-used", "anna", "anna") in audited(repository)
    assert elsewhere(browser, {**anna, "code": codes[0]}).status_code == 401
    renewed = browser.post(CODES, json=AGAIN).json()["recovery_codes"]
    assert elsewhere(browser, {**anna, "code": codes[1]}).status_code == 401
    assert elsewhere(browser, {**anna, "code": renewed[1]}).status_code == 200


def test_codes_of_another_user_are_refused(serve: Serve, repository: Repository, clock: Clock) -> None:
    browser = serve()
    anna, bert = (add_user(repository, name, Role.OPERATOR) for name in ("anna", "bert"))
    browser.post(LOGIN, json=anna)
    secret, (code, *_) = set_up(browser, clock)
    browser.post(LOGIN, json=bert)
    set_up(browser, clock)
    for of_anna in (clock.code(secret), code):
        assert elsewhere(browser, {**bert, "code": of_anna}).status_code == 401


def test_whoever_has_the_database_has_no_codes(
    serve: Serve, repository: Repository, engine: Engine, clock: Clock, tmp_path: Path
) -> None:
    browser = serve()
    anna, bert = (add_user(repository, name, Role.OPERATOR) for name in ("anna", "bert"))
    browser.post(LOGIN, json=bert)
    bert_secret, codes = set_up(browser, clock)
    browser.post(LOGIN, json=anna)
    secret, _ = set_up(browser, clock)
    with engine.begin() as connection:
        tables = ("users", "recovery_codes", "user_sessions", "audit_entries")
        kept = str([connection.execute(text(f"SELECT * FROM {table}")).all() for table in tables])  # noqa: S608
        for hidden in (secret, bert_secret, *codes, *(code.replace("-", "") for code in codes)):
            assert hidden not in kept
        # Bert writes his own app's secret into anna's row.
        connection.execute(
            text("UPDATE users SET totp = (SELECT totp FROM users WHERE name = 'bert') WHERE name = 'anna'")
        )
    swapped = elsewhere(browser, {**anna, "code": clock.code(bert_secret)})
    assert swapped.status_code == 503
    assert "secrets_key_file" in swapped.json()["detail"]
    key = tmp_path / "secrets.key"
    assert key.stat().st_mode & 0o777 == 0o600
    assert key.read_text().strip() not in kept


def test_a_key_that_others_may_read_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "secrets.key"
    sealed = Seal(path).closed("a secret", "here")
    assert Seal(path).opened(sealed, "here") == "a secret"
    assert Seal(path).closed("a secret", "here") != sealed
    with pytest.raises(SealError, match="does not open"):
        Seal(path).opened(sealed, "there")
    with pytest.raises(SealError, match="does not open"):
        Seal(tmp_path / "another.key").opened(sealed, "here")
    path.chmod(0o644)
    with pytest.raises(SealError, match="mode 600"):
        Seal(path)
    path.chmod(0o600)
    path.write_text("no key")
    with pytest.raises(SealError, match="256 bits"):
        Seal(path)


@pytest.mark.parametrize("path", [PROPOSE, CODES, REMOVE])
def test_a_session_left_open_changes_no_second_factor(
    serve: Serve, repository: Repository, clock: Clock, path: str
) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    set_up(browser, clock)
    before = audited(repository)
    assert browser.post(path, json={"password": "wrong"}).status_code == 401
    assert browser.post(path, json={}).status_code == 422
    assert [entry for entry in audited(repository)[len(before) :] if entry[0] != "login-failed"] == []
    assert repository.user("anna").has_second_factor


def test_neither_does_a_token_with_the_password(serve: Serve, repository: Repository, clock: Clock) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    set_up(browser, clock)
    token = browser.post(TOKENS, json={"label": "stolen"}).json()["token"]
    with another(browser) as thief:
        thief.headers["Authorization"] = f"Bearer {token}"
        for path in (PROPOSE, CODES, REMOVE):
            assert thief.post(path, json=AGAIN).status_code == 403
        assert thief.post(CONFIRM, json={"code": "000000"}).status_code == 403
        refused = thief.post(TOKENS, json={"label": "another"})
        assert refused.status_code == 403, "tokens are made by a login with the second factor alone"
        assert "second factor" in refused.json()["detail"]


def test_sessions_begun_with_the_password_alone_end_with_the_set_up(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    with another(browser) as thief:
        assert thief.post(LOGIN, json=anna).status_code == 200
        browser.post(LOGIN, json=anna)
        set_up(browser, clock)
        assert browser.get(MOTORS).status_code == 200, "who set it up goes on"
        assert thief.get(MOTORS).status_code == 401


def test_a_session_of_before_the_setting_is_over(serve: Serve, repository: Repository) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    assert browser.get(MOTORS).status_code == 200
    assert serve(**REQUIRED).get(MOTORS, headers=_cookie(browser)).status_code == 401


def test_until_the_factor_is_set_up_a_login_may_do_nothing_else(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    lax, browser = serve(), serve(**REQUIRED)
    lax.post(LOGIN, json=add_user(repository, "admin", Role.SECADM))
    anna = add_user(repository, "anna", Role.OPERATOR)
    code = one_time_code(lax, "anna")
    answer = browser.post(LOGIN, json={**anna, "code": code})
    assert answer.status_code == 200
    assert (answer.json()["second_factor"], answer.json()["permissions"]) == ("missing", ["account"])
    assert browser.get(MOTORS).status_code == 403
    assert browser.post(TOKENS, json={"label": "a way round"}).status_code == 403
    assert browser.post("/account/tokens", data={"label": "a way round"}).status_code == 403
    assert elsewhere(browser, {**anna, "code": code}).status_code == 401
    secret, _ = set_up(browser, clock)
    assert browser.get(MOTORS).status_code == 200
    assert browser.post(TOKENS, json={"label": "historian"}).status_code == 201
    assert browser.post(REMOVE, json=AGAIN).status_code == 409, "the role needs it"
    assert elsewhere(browser, {**anna, "code": clock.code(secret)}).status_code == 200


def test_who_logs_in_at_an_identity_provider_needs_no_code_here(serve: Serve, repository: Repository) -> None:
    browser, by = serve(**REQUIRED), Actor("olga", "192.0.2.1")
    repository.user_of_subject(
        "https://id.plant.example 7", "olga", [Role.OPERATOR], full_name=None, by=by, now_ns=1
    )
    secret = begin_session(
        repository,
        AccessSettings(),
        by,
        "https://id.plant.example",
        second_factor=True,
        ends=None,
        now_ns=time.time_ns(),
    )
    browser.cookies.set("statorwatch_session", secret)
    assert browser.get(ACCOUNT).json()["second_factor"] == "none"
    assert browser.get(MOTORS).status_code == 200
    assert browser.post(TOKENS, json={"label": "historian"}).status_code == 201


def test_a_reset_is_for_who_manages_users_and_kept(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser = serve()
    anna = add_user(repository, "anna", Role.OPERATOR)
    admin = add_user(repository, "admin", Role.SECADM)
    browser.post(LOGIN, json=anna)
    secret, (code, *_) = set_up(browser, clock)
    assert browser.post(f"{API}/users/anna/second-factor/reset").status_code == 403
    with another(browser) as manager:
        manager.post(LOGIN, json=admin)
        one_time_code(manager, "anna")
        assert manager.post(f"{API}/users/nobody/second-factor/reset").status_code == 404
        assert manager.get(f"{API}/users/anna").json()["has_second_factor"] is False
    assert audited(repository)[-1] == ("second-factor-reset", "anna", "admin")
    assert browser.get(MOTORS).status_code == 401, "the sessions have ended"
    strict = serve(**REQUIRED)
    for old in (clock.code(secret), code):
        assert strict.post(LOGIN, json={**anna, "code": old}).status_code == 401


def test_what_becomes_of_a_second_factor_is_audited(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    set_up(browser, clock)
    browser.post(CODES, json=AGAIN)
    assert browser.post(REMOVE, json=AGAIN).status_code == 204
    actions = [action for action, subject, actor in audited(repository) if subject == actor == "anna"]
    assert actions[-4:] == [
        "second-factor-begun",
        "second-factor-added",
        "recovery-codes-made",
        "second-factor-removed",
    ]
    assert elsewhere(browser, anna).status_code == 200
    assert browser.post(CODES, json=AGAIN).status_code == 409


def test_a_second_factor_is_confirmed_by_its_own_code_alone(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser, anna = serve(), add_user(repository, "anna", Role.OPERATOR)
    browser.post(LOGIN, json=anna)
    assert browser.post(CONFIRM, json={"code": "000000"}).status_code == 409, "none is being set up"
    first = browser.post(PROPOSE, json=AGAIN).json()["secret"]
    second = browser.post(PROPOSE, json=AGAIN).json()["secret"]
    for wrong in (clock.code(first), clock.code(second, 5), clock.code(second, -5), ""):
        assert browser.post(CONFIRM, json={"code": wrong}).status_code == 422
    assert not repository.user("anna").has_second_factor
    assert browser.post(CONFIRM, json={"code": clock.code(second)}).status_code == 200


def test_the_pages_show_secrets_once_and_no_cache_keeps_them(
    serve: Serve, repository: Repository, clock: Clock
) -> None:
    browser = serve(**REQUIRED)
    lax = serve()
    lax.post(LOGIN, json=add_user(repository, "admin", Role.SECADM))
    anna = add_user(repository, "anna", Role.OPERATOR)
    page = lax.post("/people/anna/second-factor/reset")
    code = page.text.partition("<li><code>")[2].partition("<")[0]
    answer = browser.post("/login", data={**anna, "code": code})
    assert answer.headers["location"] == "/account"
    assert "Your role needs a second factor" in browser.get("/account").text
    proposal = browser.post("/account/totp", data=AGAIN)
    assert "data:image/svg+xml" in proposal.text
    secret = proposal.text.partition('id="secret" tabindex="0">')[2].partition("<")[0]
    codes = browser.post("/account/totp/confirmation", data={"code": clock.code(secret)})
    assert codes.text.count("<li><code>") == 10
    for once in (page, proposal, codes):
        assert once.headers["cache-control"] == "no-store"
    account = browser.get("/account").text
    assert "Recovery codes left: 10" in account
    assert secret not in account
    clock.next_step()
    form = {**anna, "code": clock.code(secret), "next": "/alarms"}
    with another(browser) as later:
        assert later.post("/login", data=form).headers["location"] == "/alarms"


def _cookie(browser: httpx.Client) -> dict[str, str]:
    return {"Cookie": "; ".join(f"{name}={value}" for name, value in browser.cookies.items())}
