"""The help pages over HTTP: anybody may read them, and nothing else is to be had there."""

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext
from service.web.app import create_site
from service.web.security_headers import POLICY
from tests.service.api.serving import serving

PAGE = "<!doctype html><title>Losses</title>" + "<p>as long as a page</p>" * 100


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A site of three files; a file beside it is not of it."""
    folder = tmp_path / "site"
    (folder / "reference").mkdir(parents=True)
    (folder / "index.html").write_text("<!doctype html><title>Contents</title>")
    (folder / "reference" / "losses.html").write_text(PAGE)
    (folder / "picture.png").write_bytes(b"\x89PNG")
    (tmp_path / "secret.txt").write_text("secret")
    return folder


@pytest.fixture
def reader(context: ApiContext, folder: Path) -> Iterator[httpx.Client]:
    """A browser of somebody who has not logged in."""
    with serving(create_site(context, help_folder=folder), as_somebody=False) as client:
        client.headers["Accept"] = "text/html,application/xhtml+xml,*/*;q=0.8"
        yield client


def test_anybody_reads_a_page_under_the_policy_of_all_pages(reader: httpx.Client) -> None:
    answer = reader.get("/help/reference/losses.html")
    assert answer.status_code == 200
    assert answer.text == PAGE
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    assert answer.headers["content-encoding"] == "gzip"
    assert answer.headers["content-security-policy"] == POLICY
    assert answer.headers["x-content-type-options"] == "nosniff"
    plain = reader.get("/help/reference/losses.html", headers={"Accept-Encoding": "identity"})
    assert "content-encoding" not in plain.headers
    assert plain.text == PAGE
    assert reader.get("/help/picture.png").headers["content-type"] == "image/png"


def test_it_begins_with_the_contents(reader: httpx.Client) -> None:
    assert reader.get("/help").headers["location"] == "/help/"
    assert "Contents" in reader.get("/help/").text


def test_a_page_that_is_as_before_is_not_sent_again(reader: httpx.Client) -> None:
    first = reader.get("/help/reference/losses.html")
    assert first.headers["cache-control"] == "public, no-cache"
    tag = first.headers["etag"]
    again = reader.get("/help/reference/losses.html", headers={"If-None-Match": f'"another", {tag}'})
    assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", tag)
    assert reader.get("/help/", headers={"If-None-Match": tag}).status_code == 200


def test_a_page_can_be_read_and_nothing_else(reader: httpx.Client) -> None:
    head = reader.head("/help/reference/losses.html")
    assert (head.status_code, head.content) == (200, b"")
    for method in ("POST", "PUT", "DELETE", "OPTIONS"):
        answer = reader.request(method, "/help/reference/losses.html")
        assert (answer.status_code, answer.headers["allow"]) == (405, "GET, HEAD")


@pytest.mark.parametrize(
    "path",
    [
        "/help/none.html",
        "/help/reference",
        "/help/reference/",
        "/help//index.html",
        "/help/%2e%2e/secret.txt",
        "/help/reference/%2e%2e/%2e%2e/secret.txt",
        "/help/..%2fsecret.txt",
        "/help/%00",
        "/help/" + "x" * 5000,
        "/helpers",
    ],
)
def test_nothing_else_is_there(reader: httpx.Client, path: str) -> None:
    answer = reader.get(path)
    assert answer.status_code == 404
    assert "secret" not in answer.text.replace("secret.txt", "")


def test_a_file_that_came_later_is_not_of_the_site(reader: httpx.Client, folder: Path) -> None:
    (folder / "later.html").symlink_to(folder.parent / "secret.txt")
    assert reader.get("/help/later.html").status_code == 404


def test_where_it_was_not_made_a_page_says_how(context: ApiContext, tmp_path: Path) -> None:
    with serving(create_site(context, help_folder=tmp_path / "none"), as_somebody=False) as client:
        page = client.get("/help/reference/losses.html", headers={"Accept": "text/html"})
        assert page.status_code == 501
        assert "make site" in page.text
        assert "<h1>Not Implemented</h1>" in page.text
        problem = client.get("/help/", headers={"Accept": "application/json"})
        assert problem.headers["content-type"] == "application/problem+json"
        assert "make site" in problem.json()["detail"]


def test_each_page_leads_to_the_help(client: httpx.Client) -> None:
    assert '<a href="/help/">Help</a>' in client.get("/").text
    assert 'href="/help/reference/fleet.html"' in client.get("/").text
