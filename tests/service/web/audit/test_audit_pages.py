"""The audit trail on a page: filtered, with values before and after, and verified."""

import httpx
import pytest
from sqlalchemy import Engine, text

from service.storage import Repository
from service.storage.records import Actor, Role
from testing.service.accounts import auditor, token_of
from testing.service.plants import NOW_NS
from tests.service.web.pages import HOSTILE, page, words

ADMIN = Actor("admin", HOSTILE, frozenset({Role.SECADM}))


@pytest.fixture(autouse=True)
def audits(client: httpx.Client, repository: Repository) -> None:
    client.headers.update(auditor(repository))


def fill(repository: Repository) -> None:
    repository.add_user("ada", [Role.VIEWER], password=None, full_name="Ada", by=ADMIN, now_ns=NOW_NS)
    repository.change_user("ada", full_name=HOSTILE, by=ADMIN, now_ns=NOW_NS + 10**9)


def test_entries_say_who_did_what_with_values_before_and_after(
    client: httpx.Client, repository: Repository
) -> None:
    fill(repository)
    document = page(client.get("/audit"))
    changed, added = (words(row, "td") for row in document.cssselect("tbody tr"))
    assert changed[0] == "2025-10-09 08:53 UTC"
    assert changed[1].startswith("admin")
    assert changed[2:] == ["user changed", "user ada", f"full name: Ada {HOSTILE}"]
    assert added[2] == "user added"
    assert words(document, "tbody th") == ["2", "1"]


def test_filters_live_in_the_address(client: httpx.Client, repository: Repository) -> None:
    fill(repository)

    def numbers(query: str) -> list[str]:
        return words(page(client.get(f"/audit?{query}")), "tbody th")

    assert numbers("action=user-added&actor=admin&subject=ada") == ["1"]
    assert numbers("from=2025-10-09&to=2025-10-10&actor=&action=&subject=") == ["2", "1"]
    assert numbers("to=2025-10-09") == []
    for wrong in ("from=yesterday", "action=nothing", "cursor=x", "actor=%00"):
        answer = client.get(f"/audit?{wrong}")
        assert answer.status_code == 422, wrong
        assert answer.headers["content-type"].startswith("text/html")


def test_the_trail_is_verified_and_a_change_is_found(
    client: httpx.Client, repository: Repository, engine: Engine
) -> None:
    fill(repository)
    document = page(client.get("/audit"))
    (head,) = words(document, "section code.break")
    right = page(client.get("/audit/verification", params={"number": "2", "hash": head}))
    assert words(right, "strong") == ["2 entries are as written"]
    assert "number 2 is the one that was kept elsewhere" in " ".join(right.text_content().split())
    assert client.get("/audit/verification?number=2").status_code == 422
    assert client.get("/audit/verification?number=two").status_code == 422
    with engine.begin() as connection:
        triggers = connection.execute(text("SELECT name FROM sqlite_master WHERE type = 'trigger'"))
        for (name,) in triggers.all():
            connection.execute(text(f'DROP TRIGGER "{name}"'))
        connection.execute(text("UPDATE audit_entries SET actor = 'eve' WHERE number = 1"))
    wrong = page(client.get("/audit/verification"))
    assert words(wrong, ".card.fault .state") == ["changed"]


def test_only_auditors_see_it(client: httpx.Client, repository: Repository) -> None:
    client.headers["Authorization"] = f"Bearer {token_of(repository, Role.SECADM, name='secadm')}"
    assert client.get("/audit").status_code == 403
    client.headers["Authorization"] = f"Bearer {token_of(repository, Role.SECAUD, name='secaud')}"
    document = page(client.get("/audit"))
    assert words(document, "nav a") == ["Settings", "Help", "Audit trail", "Account"]
