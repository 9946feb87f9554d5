"""Scripts and styles: to be had by anybody, kept by browsers, and those of others as they published them."""

import hashlib
import json
from importlib.resources import files

import httpx
import pytest

from service.web.static_files import static_tree

STATIC = files("service.web") / "static"


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
