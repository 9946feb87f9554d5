"""Errors at pages: in words, as a page or as a part of one; the API keeps its documents."""

import httpx

from service.web.security_headers import POLICY


def test_an_unknown_address_gets_a_page(client: httpx.Client) -> None:
    answer = client.get("/nothing-here")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    assert "there is no page at /nothing-here" in answer.text
    assert 'href="/"' in answer.text


def test_a_script_in_an_address_does_not_get_into_the_page(client: httpx.Client) -> None:
    answer = client.get("/%3Cscript%3Ealert(1)%3C/script%3E")
    assert answer.status_code == 404
    assert "<script>alert" not in answer.text


def test_part_of_a_page_gets_part_of_a_page(client: httpx.Client) -> None:
    answer = client.get("/nothing-here", headers={"HX-Request": "true"})
    assert answer.headers["hx-retarget"] == "#messages"
    assert answer.headers["hx-reselect"] == ".message", "also where another part was asked for"
    assert "<html" not in answer.text
    assert 'role="alert"' in answer.text


def test_a_session_that_has_ended_is_told_in_place(anybody: httpx.Client) -> None:
    anybody.cookies.set("statorwatch_session", "of-yesterday")
    answer = anybody.post("/logout", headers={"HX-Request": "true"})
    assert answer.status_code == 401
    assert "Log in (in a new tab)" in answer.text


def test_the_api_keeps_its_documents(client: httpx.Client) -> None:
    answer = client.get("/api/v1/nothing")
    assert answer.headers["content-type"] == "application/problem+json"
    assert (
        client.get("/nothing", headers={"Accept": "*/*"}).headers["content-type"]
        == "application/problem+json"
    )


def test_every_answer_has_the_policy(client: httpx.Client) -> None:
    for path in ("/login", "/nothing-here", "/api/v1/motors", "/healthz"):
        answer = client.get(path)
        assert answer.headers["content-security-policy"] == POLICY
        assert answer.headers["x-content-type-options"] == "nosniff"
    assert "unsafe" not in POLICY
    assert "script-src 'self'" in POLICY
