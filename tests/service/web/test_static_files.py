"""Scripts and styles: to be had by anybody, kept by browsers, and those of others as they published them."""

import hashlib
import json
import re
from collections.abc import Iterator
from importlib.resources import files
from importlib.resources.abc import Traversable

import httpx
import pytest

from service.web.static_files import static_tree

STATIC = files("service.web") / "static"
TEMPLATES = files("service.web") / "templates"


def test_anybody_gets_a_file_and_may_keep_it_for_ever(anybody: httpx.Client) -> None:
    answer = anybody.get(static_tree().address("css/base.css"))
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "text/css; charset=utf-8"
    assert "immutable" in answer.headers["cache-control"]
    assert answer.headers["content-encoding"] == "gzip"
    assert answer.text == (STATIC / "css" / "base.css").read_text()


@pytest.mark.parametrize(
    "path",
    [
        "/static/css/base.css",
        "/static/0123456789ab/css/base.css",
        f"/static/{static_tree().digest}/../app.py",
        f"/static/{static_tree().digest}/%2e%2e/app.py",
        f"/static/{static_tree().digest}/css",
        "/static/",
    ],
)
def test_nothing_else_is_there(anybody: httpx.Client, path: str) -> None:
    assert anybody.get(path).status_code == 404


def test_a_file_that_a_template_names_and_there_is_not_is_an_error() -> None:
    with pytest.raises(LookupError, match=r"css/none\.css"):
        static_tree().address("css/none.css")


def test_what_others_wrote_is_what_they_published() -> None:
    vendored = json.loads((STATIC / "vendor" / "vendored.json").read_text())
    listed = {way: digest for package in vendored for way, digest in package["files"].items()}
    found = {
        way.removeprefix("vendor/"): hashlib.sha256(file.plain).hexdigest()
        for way, file in static_tree().files.items()
        if way.startswith("vendor/") and way != "vendor/vendored.json"
    }
    assert found == listed
    for package in vendored:
        assert package["version"]
        assert package["licence"] in ("0BSD", "MIT")
        assert any(way.endswith("/LICENSE") for way in package["files"])


def test_no_file_of_ours_leads_to_another_host_or_evaluates_text() -> None:
    ours = {way: file for way, file in static_tree().files.items() if not way.startswith("vendor/")}
    assert ours
    for way, file in ours.items():
        text = file.plain.decode()
        addresses = set(re.findall(r"(?:https?:)?//[a-z0-9.-]+\.[a-z]{2,}[^\s\"')]*", text))
        assert addresses <= {"http://www.w3.org/2000/svg"}, way
        assert not re.search(
            r"\beval\(|new Function|innerHTML\s*=|insertAdjacentHTML|document\.write", text
        ), way


def test_no_template_has_a_script_a_style_or_a_handler_of_its_own() -> None:
    found = [way for way in _templates(TEMPLATES) if way.name.endswith(".html")]
    assert found
    for template in found:
        text = re.sub(r"{#.*?#}", "", template.read_text(), flags=re.DOTALL)
        assert not re.search(r"\shx-on\b|\shx-on:|\bjs:|javascript:", text), template
        assert not re.search(r"<style|\sstyle\s*=", text), template
        assert not re.search(r"\son[a-z]+\s*=", text), template
        assert not re.search(r"\|\s*safe\b|autoescape\s+false|Markup\(", text), template
        for tag in re.findall(r"<script\b[^>]*>", text):
            assert "src=" in tag or 'type="application/json"' in tag, (template, tag)


def _templates(folder: Traversable) -> Iterator[Traversable]:
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _templates(entry)
        else:
            yield entry
