"""Pinned packages against known advisories."""

import json
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import pytest

import release.__main__ as command
from release.__main__ import FILE, PINNED, accepted, main
from release.advisories import OLDEST, AdvisoryError, affected, fetch, read
from release.pins import Pin, read_pins
from tests.docs.pages import ROOT

NOW = datetime(2026, 11, 29, 12, tzinfo=UTC)


def advisory(number: int, *events: Mapping[str, str], versions: Sequence[str] = ()) -> dict[str, object]:
    """An advisory about jinja2, as OSV answers."""
    return {
        "id": f"GHSA-{number}",
        "aliases": [f"CVE-{number}"],
        "summary": "a sandbox breakout",
        "affected": [
            {
                "package": {"name": "Jinja2", "ecosystem": "PyPI"},
                "ranges": [{"type": "ECOSYSTEM", "events": list(events)}],
                "versions": list(versions),
            },
            {"package": {"name": "another", "ecosystem": "PyPI"}, "versions": ["3.1.6"]},
        ],
    }


BROKEN = advisory(1, {"introduced": "0"}, {"fixed": "3.1.6"})
TWICE = advisory(
    2, {"introduced": "2.0"}, {"fixed": "2.5"}, {"introduced": "3.1"}, {"last_affected": "3.1.4"}
)
LISTED = advisory(3, versions=["3.1.9"])
WITHDRAWN = {**advisory(4, {"introduced": "0"}), "withdrawn": "2026-01-01T00:00:00Z"}


def database(request: httpx.Request) -> httpx.Response:
    """OSV, which answers in pages."""
    asked = json.loads(request.content)
    assert asked["package"]["ecosystem"] == "PyPI"
    if asked["package"]["name"] != "jinja2":
        return httpx.Response(200, json={})
    if "page_token" not in asked:
        return httpx.Response(200, json={"vulns": [BROKEN, WITHDRAWN], "next_page_token": "2"})
    return httpx.Response(200, json={"vulns": [TWICE, LISTED]})


def fetched(*pins: Pin) -> dict[str, object]:
    with httpx.Client(transport=httpx.MockTransport(database)) as client:
        return fetch(pins, client, NOW)


@pytest.mark.parametrize(
    ("version", "concerned_by"),
    [
        ("1.0", ["GHSA-1"]),
        ("2.4", ["GHSA-1", "GHSA-2"]),
        ("2.5", ["GHSA-1"]),
        ("3.1.4", ["GHSA-1", "GHSA-2"]),
        ("3.1.5", ["GHSA-1"]),
        ("3.1.6", []),
        ("3.1.9", ["GHSA-3"]),
        ("3.1.10", []),
    ],
)
def test_a_pin_is_found_in_the_versions_that_are_affected(version: str, concerned_by: Sequence[str]) -> None:
    pins = [Pin("jinja2", version, ()), Pin("numpy", "2.3.1", ())]
    found = affected(pins, json.loads(json.dumps(fetched(*pins))), {})
    assert [one.advisory for one in found] == concerned_by


def test_a_line_tells_what_to_do() -> None:
    pins = [Pin("jinja2", "3.1.5", ())]
    (found,) = affected(pins, fetched(*pins), {})
    assert str(found) == "jinja2 3.1.5: GHSA-1, fixed in 3.1.6: a sandbox breakout"


def test_an_advisory_that_was_looked_at_is_passed_over() -> None:
    pins = [Pin("jinja2", "3.1.5", ())]
    assert affected(pins, fetched(*pins), {"CVE-1": "templates are ours"}) == []


def test_a_package_that_nothing_is_known_of_is_no_package_without_advisories() -> None:
    with pytest.raises(AdvisoryError, match=r"nothing is known of numpy; make it anew .*make advisories"):
        affected([Pin("numpy", "2.3.1", ())], fetched(Pin("jinja2", "3.1.5", ())), {})


def test_a_database_that_does_not_answer_makes_no_file() -> None:
    def refused(request: httpx.Request) -> httpx.Response:
        return httpx.Response(503)

    with (
        httpx.Client(transport=httpx.MockTransport(refused)) as client,
        pytest.raises(AdvisoryError, match="expected advisories about jinja2, found: HTTPStatusError"),
    ):
        fetch([Pin("jinja2", "3.1.5", ())], client, NOW)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (None, "found no file; make it anew where there is a network: make advisories"),
        ("{", "make advisories"),
        ("{}", "make advisories"),
        (json.dumps(fetched()), "expected advisories of the last 30 days, found those of 2026-11-29"),
    ],
)
def test_what_says_nothing_of_today_says_what_to_do(tmp_path: Path, text: str | None, told: str) -> None:
    path = tmp_path / "advisories.json"
    if text is not None:
        path.write_text(text)
    with pytest.raises(AdvisoryError, match=told):
        read(path, NOW + OLDEST + timedelta(seconds=1))


def test_a_file_of_the_last_days_is_read(tmp_path: Path) -> None:
    path = tmp_path / "advisories.json"
    path.write_text(json.dumps(fetched()))
    assert read(path, NOW + OLDEST)["packages"] == {}


@pytest.mark.skipif(not FILE.exists(), reason="no advisories were fetched into this tree: make advisories")
def test_no_pinned_package_has_a_known_advisory() -> None:
    pins = [pin for name in PINNED for pin in read_pins(ROOT / name)]
    assert affected(pins, read(FILE, datetime.now(UTC)), accepted()) == []


@pytest.mark.parametrize("affects", [None, "before", "now"])
def test_the_audit_of_a_release_ends_with_1_where_a_pin_is_affected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], affects: str | None
) -> None:
    """The repository's own pins, against a file as `make advisories` writes it."""
    pins = {pin.name: pin.version for name in PINNED for pin in read_pins(ROOT / name)}
    packages: dict[str, list[object]] = {name: [] for name in pins}
    if affects is not None:
        end = [{"fixed": pins["jinja2"]}] if affects == "before" else [{"last_affected": pins["jinja2"]}]
        concerned = {"ranges": [[{"introduced": "0"}, *end]], "versions": []}
        one = {"id": "GHSA-5", "aliases": [], "summary": "a sandbox breakout", "affected": [concerned]}
        packages["jinja2"] = [one]
    file = tmp_path / "advisories.json"
    file.write_text(json.dumps({"made": datetime.now(UTC).isoformat(), "packages": packages}))
    monkeypatch.setattr(command, "FILE", file)
    assert main("audit") == (1 if affects == "now" else 0)
    told = capsys.readouterr()
    assert ("GHSA-5" in told.err) is (affects == "now")
    assert f"{len(pins)} packages" in told.out
