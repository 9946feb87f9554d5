"""`mcc user`, `token`, `login`: by way of a service, and in its database."""

import io
import json
import stat
from collections.abc import Iterator
from pathlib import Path

import httpx
import pyotp
import pytest

from service.api import ApiContext, create_app
from service.cli import main
from service.client.credentials import credentials_file
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.database import make_database
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]

PASSWORD = "correct horse battery"  # noqa: S105 - of nobody
OTHER = "another battery staple"


@pytest.fixture(autouse=True)
def own_credentials(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))


@pytest.fixture
def password_file(tmp_path: Path) -> str:
    path = tmp_path / "password"
    path.touch(mode=0o600)
    path.write_text(f"{PASSWORD}\n")
    return str(path)


@pytest.fixture
def config(tmp_path: Path) -> str:
    """Settings whose database has no user yet."""
    make_database(tmp_path)
    path = tmp_path / "mcc.toml"
    path.write_text(f"data_directory = {json.dumps(str(tmp_path))}\n")
    return str(path)


@pytest.fixture
def service(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    """A service at which commands are of a user with all roles."""
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        yield client


def printed(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    capsys.readouterr()
    assert main(words) == 0, capsys.readouterr().err
    return capsys.readouterr().out


def test_the_owner_of_the_files_makes_the_first_user(
    config: str, password_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("--config", config)
    assert "no users" in printed(capsys, "user", "list", *words)
    made = ("user", "add", "Anna", "--role", "SECADM", "--role", "ENGINEER", "--password-file", password_file)
    assert "user anna: ENGINEER SECADM; may log in" in printed(capsys, *made, *words)
    (anna,) = json.loads(printed(capsys, "user", "list", "--json", *words))["users"]
    assert (anna["name"], anna["has_password"]) == ("anna", True)
    assert main([*made, *words]) == 1
    assert "there is a user 'anna' already" in capsys.readouterr().err
    assert main(["user", "delete", "anna", *words]) == 1
    assert "the last one with the role SECADM" in capsys.readouterr().err
    for name in ("a b", "statorwatch"):
        assert main(["user", "add", name, "--no-password", *words]) == 1


def test_login_is_for_the_commands_that_follow(
    service: httpx.Client, password_file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    url = ("--url", str(service.base_url).rstrip("/"))
    made = ("user", "add", "anna", "--role", "VIEWER", "--password-file", password_file)
    assert "changes the password first" in printed(capsys, *made, *url)
    login = ("login", "--name", "anna", "--password-file")
    assert main([*login, password_file, *url]) == 0
    assert "tester set this password and knows it" in capsys.readouterr().err
    assert main(["motors", *url]) == 1
    assert "change it first (mcc password" in capsys.readouterr().err
    own = tmp_path / "own"
    own.touch(mode=0o600)
    own.write_text(OTHER)
    printed(capsys, "password", "--old-file", password_file, "--new-file", str(own), *url)
    assert "anna: VIEWER" in printed(capsys, *login, str(own), *url)
    assert stat.S_IMODE(credentials_file().stat().st_mode) == 0o600
    assert OTHER not in credentials_file().read_text()
    assert "may: account metrics view" in printed(capsys, "whoami", *url)
    assert json.loads(printed(capsys, "motors", "--json", *url))["motors"]
    assert main(["trigger", "PUMP-A1", *url]) == 1
    assert "anna may not do this" in capsys.readouterr().err
    assert "logged out" in printed(capsys, "logout", *url)
    assert main(["motors", *url]) == 1
    assert "say who you are" in capsys.readouterr().err
    assert printed(capsys, "logout", *url), "harmless where nobody is logged in"


def test_a_second_factor_is_set_up_used_and_reset(
    service: httpx.Client,
    password_file: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    url = ("--url", str(service.base_url).rstrip("/"))
    login = ("login", "--name", "anna", "--password-file", password_file)
    code_file = tmp_path / "code"
    code_file.touch(mode=0o600)
    printed(capsys, "user", "add", "anna", "--role", "VIEWER", "--password-file", password_file, *url)
    manager = credentials_file().read_text()
    printed(capsys, *login, *url)

    class App:
        """Reads the key that the command shows, and types the code that fits to it."""

        def readline(self, _size: int = -1) -> str:
            key = capsys.readouterr().err.partition("key for the authenticator app: ")[2].split()[0]
            return f"{pyotp.TOTP(key).now()}\n"

        def isatty(self) -> bool:
            return False

    monkeypatch.setattr("sys.stdin", App())
    set_up = main(["second-factor", "set-up", "--password-file", password_file, *url])
    assert set_up == 0, capsys.readouterr().err
    codes = capsys.readouterr().out.split()
    assert len(codes) == 10
    assert main([*login, *url]) == 1
    code_file.write_text(f"{codes[0]}\n")
    assert "anna:" in printed(capsys, *login, "--code-file", str(code_file), *url)
    renewed = printed(capsys, "second-factor", "codes", "--password-file", password_file, *url).split()
    assert set(renewed).isdisjoint(codes)
    assert "is removed" in printed(capsys, "second-factor", "remove", "--password-file", password_file, *url)
    credentials_file().write_text(manager)
    said = json.loads(printed(capsys, "user", "reset-second-factor", "anna", "--json", *url))
    assert len(said["code"]) == 19
    assert main([*login, *url]) == 0, "no role of hers needs it"


def test_the_first_administrator_gets_the_code_on_the_services_machine(
    config: str, password_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("--config", config)
    printed(capsys, "user", "add", "anna", "--role", "SECADM", "--password-file", password_file, *words)
    assert "code for one login: " in printed(capsys, "user", "reset-second-factor", "anna", *words)
    assert main(["user", "reset-second-factor", "nobody", *words]) == 1


def test_who_logs_in_reads_the_notice_first(
    repository: Repository,
    store: RecordingStore,
    tmp_path: Path,
    password_file: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    settings = Settings.model_validate(
        {"data_directory": tmp_path, "access": {"use_notice": "For staff only."}}
    )
    with serving(create_app(ApiContext(settings, repository, store))) as client:
        url = ("--url", str(client.base_url).rstrip("/"))
        printed(capsys, "user", "add", "anna", "--password-file", password_file, *url)
        assert main(["login", "--name", "anna", "--password-file", password_file, "--json", *url]) == 0
        captured = capsys.readouterr()
    assert json.loads(captured.out)["name"] == "anna"
    assert "For staff only." in captured.err


def test_a_login_with_a_wrong_password_keeps_nothing(
    service: httpx.Client,
    password_file: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    url = ("--url", str(service.base_url).rstrip("/"))
    printed(capsys, "user", "add", "anna", "--password-file", password_file, *url)
    before = credentials_file().read_text()
    monkeypatch.setattr("sys.stdin", io.StringIO("wrong\n"))
    assert main(["login", "--name", "anna", "--password-file", "-", *url]) == 1
    assert "the name or the password is wrong" in capsys.readouterr().err
    assert credentials_file().read_text() == before
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    assert main(["login", "--name", "anna", "--password-file", "-", *url]) == 1
    assert main(["login", "--name", "anna", *url]) == 1, "nobody is there to type"
    assert "expected a terminal" in capsys.readouterr().err


@pytest.mark.parametrize("way", ["service", "database"])
def test_users_are_changed_and_deleted(
    request: pytest.FixtureRequest, password_file: str, capsys: pytest.CaptureFixture[str], way: str
) -> None:
    if way == "service":
        where = ("--url", str(request.getfixturevalue("service").base_url).rstrip("/"))
    else:
        where = ("--config", request.getfixturevalue("config"))
    printed(capsys, "user", "add", "bert", "--role", "VIEWER", "--no-password", *where)
    assert "OPERATOR" in printed(capsys, "user", "change", "bert", "--role", "OPERATOR", *where)
    assert "disabled" in printed(capsys, "user", "change", "bert", "--disable", *where)
    assert "OPERATOR" in printed(capsys, "user", "change", "bert", "--enable", *where)
    assert "-" in printed(capsys, "user", "change", "bert", "--no-roles", *where)
    assert main(["user", "change", "bert", *where]) == 1
    printed(capsys, "user", "password", "bert", "--password-file", password_file, *where)
    printed(capsys, "user", "unlock", "bert", *where)
    printed(capsys, "user", "logout", "bert", *where)
    printed(capsys, "user", "delete", "bert", *where)
    assert main(["user", "delete", "bert", *where]) == 1
    assert "there is no user 'bert'" in capsys.readouterr().err


@pytest.mark.parametrize("way", ["service", "database"])
def test_users_may_be_limited_to_sites(
    request: pytest.FixtureRequest, capsys: pytest.CaptureFixture[str], way: str
) -> None:
    if way == "service":
        where = ("--url", str(request.getfixturevalue("service").base_url).rstrip("/"))
    else:
        where = ("--config", request.getfixturevalue("config"))

    def sites() -> object:
        users = json.loads(printed(capsys, "user", "list", "--json", *where))["users"]
        return next(user["sites"] for user in users if user["name"] == "carl")

    made = ("user", "add", "carl", "--role", "OPERATOR", "--no-password", "--site", "FACTORY_A")
    assert "at FACTORY_A" in printed(capsys, *made, *where)
    assert sites() == ["FACTORY_A"]
    printed(capsys, "user", "change", "carl", "--site", "FACTORY_C", "--site", "FACTORY_A", *where)
    assert sites() == ["FACTORY_A", "FACTORY_C"]
    assert main(["user", "change", "carl", "--site", "FACTORY_A", "--all-sites", *where]) == 1
    assert "--all-sites: expected it or --site, found both" in capsys.readouterr().err
    printed(capsys, "user", "change", "carl", "--all-sites", *where)
    assert sites() is None


def test_a_token_tells_the_sites_where_it_holds(
    service: httpx.Client, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    url = ("--url", str(service.base_url).rstrip("/"))
    file = tmp_path / "reader.token"
    scope = ("--scope", "view", "--scope", "account")
    printed(capsys, "token", "add", "reader", *scope, "--site", "FACTORY_A", "--output", str(file), *url)
    assert "at:" not in printed(capsys, "whoami", *url)
    monkeypatch.setenv("MCC_TOKEN_FILE", str(file))
    assert "at: FACTORY_A" in printed(capsys, "whoami", *url)


def test_the_owner_of_the_files_makes_tokens_of_programs_alone(
    config: str, service: httpx.Client, password_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    here, there = ("--config", config), ("--url", str(service.base_url).rstrip("/"))
    printed(capsys, "user", "add", "historian", "--role", "VIEWER", "--no-password", *here)
    words = ("token", "add", "t", "--user", "historian", "--scope", "view", "--days", "1", "--json")
    assert main([*words, *there]) == 1
    assert "expected --config or --local" in capsys.readouterr().err
    made = json.loads(printed(capsys, *words, *here))
    assert (made["user"], made["scope"], made["token"][:4]) == ("historian", ["view"], "mcc_")
    assert made["token"] not in printed(capsys, "token", "list", *here)
    assert main(["token", "add", "t", "--user", "historian", "--days", "91", *here]) == 1
    assert "access.token_days" in capsys.readouterr().err
    printed(capsys, "token", "revoke", made["id"], *here)
    assert main(["token", "revoke", made["id"], *here]) == 1
    printed(capsys, *words, *here)
    assert "have ended" in printed(capsys, "token", "revoke-all", "--user", "historian", *here)
    assert "historian" not in printed(capsys, "token", "list", *here)
    assert main(["token", "revoke-all", *here]) == 1, "whose is not told"
    printed(capsys, "user", "password", "historian", "--password-file", password_file, *here)
    assert main([*words, *here]) == 1
    assert "made by that user alone" in capsys.readouterr().err


def test_all_own_tokens_end(service: httpx.Client, capsys: pytest.CaptureFixture[str]) -> None:
    url = ("--url", str(service.base_url).rstrip("/"))
    assert "your tokens have ended" in printed(capsys, "token", "revoke-all", *url)
    assert main(["token", "list", *url]) == 1, "the one that asked was one of them"


def test_a_token_is_for_programs(
    service: httpx.Client, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    url = ("--url", str(service.base_url).rstrip("/"))
    file = tmp_path / "reader.token"
    words = ("token", "add", "reader", "--scope", "view", "--scope", "account", "--output", str(file))
    assert f"written to {file}" in printed(capsys, *words, *url)
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert main(["token", "add", "x", "--scope", "everything", *url]) == 2
    capsys.readouterr()
    monkeypatch.setenv("MCC_TOKEN_FILE", str(file))
    assert "may: account view" in printed(capsys, "whoami", *url)
    assert main(["user", "list", *url]) == 1
    monkeypatch.setenv("MCC_TOKEN", "mcc_wrong")
    assert main(["motors", *url]) == 1
    assert "unknown, revoked or expired" in capsys.readouterr().err
    monkeypatch.delenv("MCC_TOKEN")
    monkeypatch.setenv("MCC_TOKEN_FILE", str(tmp_path / "gone"))
    assert main(["motors", *url]) == 1
    assert "gone (MCC_TOKEN_FILE): cannot be read" in capsys.readouterr().err


def test_the_own_password_is_changed(
    service: httpx.Client, tmp_path: Path, password_file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    url = ("--url", str(service.base_url).rstrip("/"))
    new = tmp_path / "new"
    new.touch(mode=0o600)
    new.write_text(OTHER)
    printed(capsys, "user", "add", "anna", "--role", "VIEWER", "--password-file", password_file, *url)
    printed(capsys, "login", "--name", "anna", "--password-file", password_file, *url)
    assert "log in again" in printed(
        capsys, "password", "--old-file", password_file, "--new-file", str(new), *url
    )
    assert main(["login", "--name", "anna", "--password-file", password_file, *url]) == 1
    printed(capsys, "login", "--name", "anna", "--password-file", str(new), *url)


def test_credentials_that_others_can_read_are_not_used(
    service: httpx.Client, capsys: pytest.CaptureFixture[str]
) -> None:
    url = ("--url", str(service.base_url).rstrip("/"))
    printed(capsys, "motors", *url)
    credentials_file().chmod(0o644)
    assert main(["motors", *url]) == 1
    assert "chmod 600" in capsys.readouterr().err
    credentials_file().chmod(0o600)
    credentials_file().write_text("[1]")
    assert main(["motors", *url]) == 1
    assert "expected what mcc login writes" in capsys.readouterr().err


def test_a_secret_goes_to_its_own_service_alone(service: httpx.Client) -> None:
    from service.client.credentials import headers_for

    assert headers_for(str(service.base_url))
    assert headers_for("http://127.0.0.1:1") == {}
    assert headers_for(f"{service.base_url.scheme}s://127.0.0.1:{service.base_url.port}") == {}
    assert headers_for(f"http://evil.example:{service.base_url.port}") == {}
