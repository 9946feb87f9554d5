"""No request is larger than its route takes, and no list or text of a document is without a bound."""

import json
import re
import socket
from collections.abc import Iterator
from typing import Any
from urllib.parse import urlsplit

import httpx
import pytest

from service.api import ApiContext
from service.api.inspections.pictures import MAX_PICTURE_BYTES
from service.api.limits.body_limits import MAX_JSON_BYTES, MAX_REPORT_BYTES
from service.api.problems import MAX_ERRORS
from service.storage import Repository
from testing.service.accounts import auditor
from testing.service.plants import NOW_NS
from testing.service.small_record import CFG, DAT

NO_SUCH_ID = "00000000-0000-0000-0000-000000000000"
BASELINE = "/api/v1/motors/PUMP-A1/baseline"
DIAGNOSES = f"/api/v1/recordings/{NO_SUCH_ID}/diagnoses"
BEGINNING = b'--b\r\nContent-Disposition: form-data; name="files"; filename="E.CFF"\r\n\r\n'
METHODS = ("get", "put", "post", "patch", "delete")


def operations(document: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            if method in METHODS:
                yield method.upper(), path, operation


def schemas_in(part: object, document: dict[str, Any], way: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every schema below a part of the document, with the way to it; references are followed once."""
    seen: set[str] = set()

    def walk(part: object, way: str) -> Iterator[tuple[str, dict[str, Any]]]:
        if isinstance(part, list):
            for one in part:
                yield from walk(one, way)
        elif isinstance(part, dict):
            reference = part.get("$ref")
            if isinstance(reference, str):
                name = reference.rpartition("/")[2]
                if name not in seen:
                    seen.add(name)
                    yield from walk(document["components"]["schemas"][name], f"{way}/{name}")
                return
            yield way, part
            for key, value in part.items():
                yield from walk(value, f"{way}/{key}")

    yield from walk(part, way)


@pytest.fixture
def document(client: httpx.Client) -> dict[str, Any]:
    found = client.get("/api/v1/openapi.json").json()
    assert isinstance(found, dict)
    return found


def test_every_list_has_a_maximum(document: dict[str, Any]) -> None:
    unbounded = [
        way
        for method, path, operation in operations(document)
        for way, schema in schemas_in(operation, document, f"{method} {path}")
        if schema.get("type") == "array" and "maxItems" not in schema
    ]
    assert unbounded == []


def test_every_text_of_a_request_has_a_maximum(document: dict[str, Any]) -> None:
    def is_bounded(schema: dict[str, Any]) -> bool:
        known = {"maxLength", "enum", "const"} & schema.keys() or schema.get("format") == "uuid"
        return bool(known) or schema.get("contentMediaType") == "application/octet-stream"

    unbounded = [
        way
        for method, path, operation in operations(document)
        for part in ("parameters", "requestBody")
        for way, schema in schemas_in(operation.get(part, []), document, f"{method} {path} {part}")
        if schema.get("type") == "string" and not is_bounded(schema)
    ]
    assert unbounded == []


def test_every_route_refuses_a_body_beyond_its_limit(
    client: httpx.Client, context: ApiContext, document: dict[str, Any]
) -> None:
    larger = {}
    of_auditor = auditor(context.repository)
    for method, path, operation in operations(document):
        who = of_auditor if "/audit" in path else {}
        limit = operation.get("x-max-body-bytes", MAX_JSON_BYTES)
        if "requestBody" in operation:
            assert "x-max-body-bytes" in operation, path
            assert "413" in operation["responses"], path
        if limit != MAX_JSON_BYTES:
            larger[method, path] = limit
        url = re.sub(r"\{\w+\}", NO_SUCH_ID, path.replace("{name}", "PUMP-A1"))
        (kind,) = operation.get("requestBody", {}).get("content", {"application/json": None})
        in_chunks = iter([BEGINNING if "form" in kind else b"", b"x" * limit, b"x"])
        for body in (b"x" * (limit + 1), in_chunks):
            refused = client.request(
                method, url, content=body, headers={"Content-Type": f"{kind}; boundary=b", **who}
            )
            assert refused.status_code == 413, (method, path)
            assert refused.headers["content-type"] == "application/problem+json"
            assert str(limit) in refused.json()["detail"]
    assert larger == {
        ("POST", "/api/v1/recordings"): context.settings.max_upload_bytes,
        ("POST", "/api/v1/motors/{name}/reports"): MAX_REPORT_BYTES,
        ("POST", "/api/v1/motors/{name}/inspections/{inspection_id}/pictures"): MAX_PICTURE_BYTES,
    }


@pytest.mark.parametrize(
    ("method", "path"),
    [("GET", "/api/v1/openapi.json"), ("GET", "/nothing"), ("PATCH", "/healthz"), ("POST", "/api/v1/motors")],
)
def test_a_long_body_is_refused_where_there_is_no_route(client: httpx.Client, method: str, path: str) -> None:
    refused = client.request(method, path, content=iter([b"x" * MAX_JSON_BYTES, b"x"]))
    assert refused.status_code == 413
    assert refused.headers["connection"] == "close"


@pytest.mark.parametrize("what", ["waveform", "file"])
def test_a_long_body_does_not_break_an_answer_that_is_streamed(
    client: httpx.Client,
    context: ApiContext,
    repository: Repository,
    caplog: pytest.LogCaptureFixture,
    what: str,
) -> None:
    stored = context.store.store({"EVENT.CFG": CFG, "EVENT.DAT": DAT})
    recording_id = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS).recording.id
    path = f"/api/v1/recordings/{recording_id}/{what}"
    refused = client.request("GET", path, content=iter([b"x" * MAX_JSON_BYTES, b"x"]))
    assert refused.status_code == 413
    answer = client.request("GET", path, content=iter([b"x" * 100, b"x"]))
    assert answer.status_code == 200
    assert answer.content == client.get(path).content
    assert [record for record in caplog.records if record.levelname == "ERROR"] == []


def test_a_body_that_says_it_is_too_large_is_refused_before_it_comes(client: httpx.Client) -> None:
    address = urlsplit(str(client.base_url))
    with socket.create_connection((address.hostname or "", address.port or 0), timeout=10) as connection:
        request = f"PUT {BASELINE} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 66000000\r\n"
        request += f"Authorization: {client.headers['authorization']}\r\n\r\n"
        connection.sendall(request.encode())
        answer = b""
        while piece := connection.recv(4096):
            answer += piece
    head, _, body = answer.partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 413 ")
    assert json.loads(body)["status"] == 413


@pytest.mark.parametrize(
    ("method", "path", "body", "status"),
    [
        ("PUT", BASELINE, b'{"recording_ids":[' + b"{}," * 2000 + b"{}]}", 422),
        ("PUT", BASELINE, b"[" + b"{}," * 2000 + b"{}]", 422),
        ("PUT", BASELINE, b'{"recording_ids":' + b"[" * 4000 + b"]" * 4000 + b"}", 400),
        ("PUT", BASELINE, b'{"recording_ids":[' + b"9" * 400 + b"]}", 422),
        ("PUT", BASELINE, b'{"recording_ids":[' + b"9" * 6000 + b"]}", 400),
        ("PUT", BASELINE, b'{"recording_ids":["' + b"x" * 8000 + b'"]}', 422),
        ("POST", DIAGNOSES, b"{" + b",".join(b'"%d":1' % key for key in range(800)) + b"}", 422),
        ("POST", DIAGNOSES, b'{"' + b"x" * 8000 + b'":1}', 422),
        ("POST", DIAGNOSES, b'{"\\ud800":1}', 422),
        ("POST", DIAGNOSES, b'{"method":"' + b"x" * 8000 + b'"}', 422),
    ],
)
def test_a_hostile_document_has_a_short_answer(
    client: httpx.Client, method: str, path: str, body: bytes, status: int
) -> None:
    response = client.request(method, path, content=body, headers={"Content-Type": "application/json"})
    assert response.status_code == status
    assert response.headers["content-type"] == "application/problem+json"
    assert len(response.content) < 200 * MAX_ERRORS
    assert len(response.json().get("errors", [])) <= MAX_ERRORS


def test_validation_of_a_list_stops_at_the_first_fault(client: httpx.Client) -> None:
    body = {"recording_ids": ["x"] * 300}
    errors = client.put(BASELINE, json=body).json()["errors"]
    assert [error["location"] for error in errors] == ["body.recording_ids.0"]


def test_a_document_of_many_fields_is_not_described_field_by_field(client: httpx.Client) -> None:
    errors = client.post(DIAGNOSES, json=dict.fromkeys(map(str, range(21)), 1)).json()["errors"]
    assert [error["location"] for error in errors] == ["body"]
    assert "at most 20 fields, found 21" in errors[0]["message"]
    assert len(client.post(DIAGNOSES, json=dict.fromkeys(map(str, range(20)), 1)).json()["errors"]) == 20
