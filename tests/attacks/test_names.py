"""Attacks on who did it: somebody writes another's name where their own account has to stand."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest

from core.time_stamps import rfc3339
from service.access.passwords import hashed
from service.api import ApiContext
from service.cli import main
from service.client.credentials import bearer, remember
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor, Role
from service.web.app import create_site
from testing.service.accounts import token_of
from testing.service.diagnosed import add_diagnosed
from testing.service.plants import NOW_NS, healthy
from tests.service.api.serving import serving
from tests.service.reports.reading import text_of

MOTOR = "/api/v1/motors/PUMP-A1"
SMITH = "Chief Engineer Smith"
WHEN = rfc3339(NOW_NS)
SAID = {"on_behalf_of": SMITH, "time": WHEN}
WHO = f"eve, on behalf of {SMITH}"
PASSWORD = "correct horse battery"  # noqa: S105 - of nobody


@pytest.fixture(autouse=True)
def wide(monkeypatch: pytest.MonkeyPatch) -> None:
    """A terminal in which no name is broken into lines."""
    monkeypatch.setenv("COLUMNS", "240")


@pytest.fixture
def eve(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    """Engineer Eve, who would like to be somebody else."""
    context = ApiContext(Settings(data_directory=tmp_path), repository, store)
    with serving(create_site(context), as_somebody=False) as client:
        token = token_of(repository, Role.ENGINEER, name="eve")
        client.headers.update(bearer(token))
        remember(str(client.base_url), token=token)
        yield client


TABS = ("", "/stator", "/logbook", "/nameplate")
"""All that show what people have said of a motor."""


def words_of_page(client: httpx.Client) -> str:
    pages = [client.get(f"/motors/PUMP-A1{tab}", headers={"Accept": "text/html"}) for tab in TABS]
    assert {page.status_code for page in pages} == {200}
    return "".join(page.text for page in pages)


def words_of_report(client: httpx.Client) -> str:
    answer = client.get("/api/v1/reports/motors/PUMP-A1")
    assert answer.status_code == 200
    return " ".join(text_of(answer.content).split())


def printed(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    capsys.readouterr()
    assert main(words) == 0, capsys.readouterr().err
    return " ".join(capsys.readouterr().out.split())


def last_entry(repository: Repository) -> tuple[str, str, dict[str, object]]:
    """Actor, action and values of what was done last."""
    with repository.audit_trail() as trail:
        (entry,) = trail.entries(first=trail.head.number)
    return entry.actor, entry.action, json.loads(entry.after or "{}")


def note(client: httpx.Client) -> dict[str, object]:
    answer = client.post(f"{MOTOR}/notes", json={"text": "all is well", **SAID})
    assert answer.status_code == 201, answer.text
    found: dict[str, object] = answer.json()
    return found


def withdrawal(client: httpx.Client) -> dict[str, object]:
    kept = client.post(f"{MOTOR}/notes", json={"text": "it smells", "time": WHEN}).json()
    said = {"reason": "wrong motor", "on_behalf_of": SMITH}
    answer = client.post(f"{MOTOR}/notes/{kept['id']}/withdrawal", json=said)
    assert answer.status_code == 200, answer.text
    found: dict[str, object] = answer.json()
    return {
        **found,
        "by": found["withdrawn_by"],
        "on_behalf_of": found["withdrawn_on_behalf_of"],
    }


def restart(client: httpx.Client) -> dict[str, object]:
    answer = client.post(f"{MOTOR}/reference", json={"reason": "tested", **SAID})
    assert answer.status_code == 201, answer.text
    found: dict[str, object] = answer.json()
    return found


DEEDS: dict[str, Callable[[httpx.Client], dict[str, object]]] = {
    "a note": note,
    "a withdrawal": withdrawal,
    "a restart of the reference": restart,
}


@pytest.mark.parametrize("deed", DEEDS)
def test_the_name_of_another_stands_beside_the_account_that_acted(
    eve: httpx.Client, repository: Repository, capsys: pytest.CaptureFixture[str], deed: str
) -> None:
    kept = DEEDS[deed](eve)
    assert (kept["by"], kept["on_behalf_of"]) == ("eve", SMITH)
    assert WHO in words_of_page(eve)
    assert WHO in words_of_report(eve)
    assert WHO in printed(capsys, "notes", "PUMP-A1", "--url", str(eve.base_url).rstrip("/"))
    actor, _, values = last_entry(repository)
    assert (actor, values["on_behalf_of"]) == ("eve", SMITH)


@pytest.mark.parametrize("path", ["notes", "reference", "notes/ID/withdrawal", "baseline"])
def test_the_account_is_nothing_to_be_written(eve: httpx.Client, path: str) -> None:
    """As it was: `by` had the name that pages, reports and answers showed."""
    kept = eve.post(f"{MOTOR}/notes", json={"text": "a note"}).json()
    method = "PUT" if path == "baseline" else "POST"
    wanted = {"text": "all is well", "reason": "tested", "by": SMITH, "recording_ids": []}
    refused = eve.request(method, f"{MOTOR}/{path.replace('ID', kept['id'])}", json=wanted)
    assert refused.status_code == 422
    assert "expected on_behalf_of for a name" in refused.text
    assert SMITH not in words_of_page(eve)


def test_a_baseline_is_chosen_and_dropped_by_an_account(
    eve: httpx.Client, repository: Repository, store: RecordingStore, capsys: pytest.CaptureFixture[str]
) -> None:
    ids = [
        add_diagnosed(repository, store, healthy(), NOW_NS + number, name=f"E{number}") for number in range(3)
    ]
    for one in ids:
        repository.leave_out(one, "tells nothing", "test")
    said = {"reason": "surge test passed", "on_behalf_of": SMITH}
    baseline = eve.put(f"{MOTOR}/baseline", json={"recording_ids": ids, **said}).json()
    assert (baseline["by"], baseline["on_behalf_of"]) == ("eve", SMITH)
    url = ("--url", str(eve.base_url).rstrip("/"))
    assert f"surge test passed ({WHO})" in printed(capsys, "baseline", "show", "PUMP-A1", *url)
    eve.delete(f"{MOTOR}/baseline", params=said)
    for one in eve.get(f"{MOTOR}/notes").json()["items"]:
        assert (one["by"], one["on_behalf_of"]) == ("eve", SMITH)


def test_a_command_says_who_is_logged_in_and_not_who_is_at_the_machine(
    eve: httpx.Client, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("LOGNAME", "smith")  # what the name at the machine is taken from
    url = ("--url", str(eve.base_url).rstrip("/"))
    kept = json.loads(printed(capsys, "note", "PUMP-A1", "hums", "--json", *url))
    assert (kept["by"], kept["on_behalf_of"]) == ("eve", None)


def test_the_name_of_an_account_looks_like_no_other_name(eve: httpx.Client) -> None:
    """Whatever somebody writes comes behind the account, which has neither spaces nor commas."""
    eve.post(f"{MOTOR}/notes", json={"text": "a note", "on_behalf_of": "smith, on behalf of anna"})
    assert "eve, on behalf of smith, on behalf of anna" in words_of_page(eve)


def test_an_alarm_is_acknowledged_by_an_account_whatever_its_comment_says(
    eve: httpx.Client, repository: Repository
) -> None:
    from service.storage.states import AlarmKind

    alarm = repository.raise_alarm("A1_SEL710", AlarmKind.FILE_REFUSED, "X.CFG", "outside", now_ns=NOW_NS)
    where = f"/api/v1/alarms/{alarm.id}"
    eve.post(f"{where}/acknowledgements", json={"comment": f"seen, {SMITH}", "by": SMITH})
    (latest, _) = eve.get(f"{where}/changes").json()["items"]
    assert (latest["event"], latest["by"]) == ("acknowledged", "eve")


def test_no_user_is_called_as_the_service_is(repository: Repository, eve: httpx.Client) -> None:
    with_users = bearer(token_of(repository, Role.SECADM, name="ada"))
    for name in ("statorwatch", "anonymous", "service", SMITH):
        wanted = {"name": name, "roles": ["OPERATOR"], "password": PASSWORD}
        assert eve.post("/api/v1/users", json=wanted, headers=with_users).status_code == 422
    repository.add_user("smith", [Role.OPERATOR], password=hashed(PASSWORD), by=Actor("ada", ""), now_ns=1)
    assert repository.user("smith").password_set_by == "ada"  # noqa: S105 - a name
