from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from threading import Event, Semaphore

import httpx
from sqlalchemy import create_engine

from service.api import ApiContext, create_app
from service.storage import Repository
from testing.service.plants import NOW_NS
from tests.service.api.serving import serving

THREADS = 40
"""As many answer requests at a time (anyio)."""


def test_alive_and_ready(context: ApiContext) -> None:
    app = create_app(replace(context, readiness={"collector": lambda: None}))
    with serving(app) as client:
        assert client.get("/healthz").json()["status"] == "ok"
        assert client.get("/readyz").json() == {
            "status": "ready",
            "parts": {"database": "ready", "collector": "ready"},
        }


def test_a_probe_that_wants_no_content_gets_none(context: ApiContext) -> None:
    with serving(create_app(context), as_somebody=False) as client:
        response = client.head("/healthz")
    assert (response.status_code, response.content) == (200, b"")


def test_what_is_not_ready_is_named(context: ApiContext) -> None:
    unreachable = Repository(create_engine("sqlite:////nowhere/at/all.sqlite"))
    readiness = {"collector": lambda: "ended with exit code 1", "jobs": lambda: None}
    app = create_app(replace(context, repository=unreachable, readiness=readiness))
    with serving(app, as_somebody=False) as client:
        assert client.get("/healthz").status_code == 200
        response = client.get("/readyz")
    assert response.status_code == 503
    assert response.headers["content-type"] == "application/problem+json"
    parts = response.json()["parts"]
    assert (parts["collector"], parts["jobs"]) == ("ended with exit code 1", "ready")
    assert "does not answer" in parts["database"]


def test_health_is_told_while_all_threads_are_busy(context: ApiContext) -> None:
    busy, go_on = Semaphore(0), Event()

    def wait() -> None:
        busy.release()
        go_on.wait(60)

    app = create_app(replace(context, readiness={"slow": wait}))
    with serving(app) as client, ThreadPoolExecutor(THREADS) as others:
        url = f"{client.base_url}/readyz"
        answers = [others.submit(httpx.get, url, trust_env=False, timeout=60) for _ in range(THREADS)]
        try:
            for _ in range(THREADS):
                assert busy.acquire(timeout=20)
            assert client.get("/healthz", timeout=20).status_code == 200
        finally:
            go_on.set()
        assert {answer.result().status_code for answer in answers} == {200}


def test_metrics(client: httpx.Client, repository: Repository) -> None:
    repository.request_recording("PUMP-A1", now_ns=NOW_NS)
    response = client.get("/metrics")
    assert response.headers["content-type"].startswith("text/plain")
    assert 'mcc_event_reports{state="requested"} 1.0' in response.text
    assert 'mcc_links{state="unknown"} 2.0' in response.text
