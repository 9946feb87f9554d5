"""The stream of events that tells open pages of changes."""

import threading
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI

import service.web.live.changes
from service.access.bearer_secrets import digest_of, new_session
from service.api import ApiContext
from service.api.access.cookies import NAME
from service.api.server import connection_limits
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor, Role
from service.storage.states import LinkState
from service.web.app import create_site
from service.web.live.changes import Changes
from service.web.live.routes import live_of
from service.web.live.topics import Topic, topic_of
from testing.service.accounts import token_of
from testing.service.conditions import FAULT, tell
from testing.service.links import set_link_state
from testing.service.listening import LONGEST_S, listening
from testing.web.followers import until_followed

BY = Actor("ann", "here")


@pytest.fixture(autouse=True)
def no_refresh(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pages are told of changes alone, whatever the time is."""
    monkeypatch.setattr(service.web.live.changes, "REFRESH_S", 10**9)


@pytest.fixture
def site(context: ApiContext) -> FastAPI:
    return create_site(context)


@pytest.fixture
def url(site: FastAPI, context: ApiContext) -> Iterator[str]:
    with listening(site, connection_limits(context.settings)) as port:
        yield f"http://127.0.0.1:{port}"


def logged_in(url: str, repository: Repository, *roles: Role) -> httpx.Client:
    """A browser of somebody with these roles."""
    repository.add_user("kim", roles, password=None, by=BY, now_ns=time.time_ns())
    secret = new_session()
    repository.begin_session(
        digest_of(secret),
        "kim",
        "tests",
        most=100,
        oldest_ns=0,
        idle_since_ns=0,
        by=BY,
        now_ns=time.time_ns(),
    )
    cookies = {NAME: secret}
    return httpx.Client(base_url=url, cookies=cookies, trust_env=False, timeout=LONGEST_S)


@contextmanager
def following(client: httpx.Client, **query: str | list[str]) -> Iterator[Iterator[str]]:
    """The lines of a stream, from the first on that tells something."""
    with client.stream("GET", "/live", params=query) as answer:
        assert answer.status_code == 200, answer.read()
        assert answer.headers["content-type"].startswith("text/event-stream")
        lines = (line for line in answer.iter_lines() if line)
        assert next(lines) == "retry: 2000"
        yield lines


def until_known(lines: Iterator[str]) -> str:
    """Wait until the stream knows how things are; return the id of that."""
    known = next(lines)
    assert known.startswith("id: ")
    assert next(lines) == ": here"
    return known.removeprefix("id: ")


def next_event(lines: Iterator[str]) -> str:
    return next(line for line in lines if line.startswith("event"))


def as_things_are(repository: Repository, topics: Sequence[str]) -> str:
    """The id of an event that tells of all that was written so far."""
    changes = Changes(repository)
    try:
        wanted = [topic_of(topic) for topic in topics]
        stamps = changes.stamps(wanted)
        return ",".join(stamps[topic] for topic in wanted)
    finally:
        changes.close()


def until_told(lines: Iterator[str], event: str, last: str) -> set[str]:
    """Read on to that event of all that was written; return the events. Some may be told amid the writing."""
    events = set()
    while True:
        told = next_event(lines).removeprefix("event: ")
        events.add(told)
        if next(lines) == f"id: {last}" and told == event:
            return events


def test_a_change_is_told_to_those_whom_it_concerns(url: str, repository: Repository) -> None:
    topics = ["motor:PUMP-A1", "fleet", "relays"]
    with (
        logged_in(url, repository, Role.VIEWER) as client,
        following(client, topic=topics) as lines,
    ):
        until_known(lines)
        tell(repository, FAULT)
        assert until_told(lines, "fleet", as_things_are(repository, topics)) == {"fleet", "motor"}
        set_link_state(repository, "A2_SEL710", LinkState.DOWN, "gone", now_ns=time.time_ns())
        told = until_told(lines, "relays", as_things_are(repository, topics))
        assert told == {"fleet", "relays"}, "the motor has another relay"


def test_who_comes_back_is_told_what_was_missed(url: str, repository: Repository) -> None:
    with logged_in(url, repository, Role.VIEWER) as client:
        with following(client, topic="fleet") as lines:
            seen = until_known(lines)
        with following(client, topic="fleet", seen=seen) as lines:
            assert until_known(lines) == seen, "nothing was missed"
        tell(repository, FAULT)
        with following(client, topic="fleet", seen=seen) as lines:
            assert next_event(lines) == "event: fleet"
        client.headers["Last-Event-ID"] = seen
        with following(client, topic="fleet", seen="of before") as lines:
            assert next_event(lines) == "event: fleet"


def test_a_page_names_what_it_shows_so_that_nothing_is_missed(url: str, repository: Repository) -> None:
    with logged_in(url, repository, Role.VIEWER) as client:
        page = client.get("/", headers={"Accept": "text/html"}).text
        address = page.partition('sse-connect="')[2].partition('"')[0].replace("&amp;", "&")
        tell(repository, FAULT)
        with client.stream("GET", address) as answer:
            assert next_event(answer.iter_lines()) == "event: fleet"


def test_one_look_serves_all_and_nobody_is_asked_for_when_they_are_gone(
    url: str, site: FastAPI, repository: Repository
) -> None:
    with (
        logged_in(url, repository, Role.VIEWER) as client,
        following(client, topic="fleet") as first,
        following(client, topic="fleet") as second,
    ):
        until_known(first)
        until_known(second)
        until_followed(site, 2)
        tell(repository, FAULT)
        assert next(first) == next(second) == "event: fleet"
        assert next(first) == next(second)
    until_followed(site, 0)


def test_a_stream_ends_with_its_session(url: str, repository: Repository) -> None:
    with (
        logged_in(url, repository, Role.VIEWER) as client,
        following(client, topic=["fleet", "alarms"]) as lines,
    ):
        until_known(lines)
        repository.end_sessions_of("kim", by=BY, now_ns=time.time_ns())
        assert list(lines) == ["event: fleet", "data: session", "event: alarms", "data: session"]


def test_a_session_that_ends_before_anything_is_known_ends_its_stream(
    url: str, site: FastAPI, repository: Repository, monkeypatch: pytest.MonkeyPatch
) -> None:
    is_ended = threading.Event()
    stamps = live_of(site).changes.stamps

    def after_the_end(topics: Collection[Topic]) -> Mapping[Topic, str]:
        assert is_ended.wait(LONGEST_S)
        return stamps(topics)

    monkeypatch.setattr(live_of(site).changes, "stamps", after_the_end)
    with logged_in(url, repository, Role.VIEWER) as client, following(client, topic="fleet") as lines:
        repository.end_sessions_of("kim", by=BY, now_ns=time.time_ns())
        is_ended.set()
        assert list(lines) == ["event: fleet", "data: session"]


def test_a_stream_goes_on_when_others_log_out(url: str, repository: Repository) -> None:
    with logged_in(url, repository, Role.VIEWER) as client, following(client, topic="fleet") as lines:
        until_known(lines)
        repository.add_user("bob", [Role.VIEWER], password=None, by=BY, now_ns=time.time_ns())
        assert until_known(lines)
        tell(repository, FAULT)
        assert next(lines) == "event: fleet"


def test_who_has_no_session_is_asked_again_after_people_have_changed(
    url: str, repository: Repository
) -> None:
    headers = {"Authorization": f"Bearer {token_of(repository, Role.VIEWER)}"}
    with (
        httpx.Client(base_url=url, headers=headers, trust_env=False, timeout=LONGEST_S) as client,
        following(client, topic="fleet") as lines,
    ):
        until_known(lines)
        repository.add_user("bob", [Role.VIEWER], password=None, by=BY, now_ns=time.time_ns())
        assert list(lines) == ["event: fleet", "data: session"]


def test_what_a_page_asks_for_by_itself_is_no_use_of_the_session(url: str, repository: Repository) -> None:
    with logged_in(url, repository, Role.VIEWER) as client:
        digest, used_ns = digest_of(client.cookies[NAME]), time.time_ns() - 600_000_000_000
        repository.note_session_used(digest, now_ns=used_ns)
        client.get("/", headers={"HX-Request": "true", "X-Refresh": "1"}).raise_for_status()
        found = repository.session_of(digest)
        assert found is not None
        assert found.used_ns == used_ns
        client.get("/", headers={"HX-Request": "true"}).raise_for_status()
        found = repository.session_of(digest)
        assert found is not None
        assert found.used_ns > used_ns


@pytest.mark.parametrize("topic", ["weather", "motor", "motor:", "", "fleet:A"])
def test_an_unknown_topic_is_refused(url: str, repository: Repository, topic: str) -> None:
    with logged_in(url, repository, Role.VIEWER) as client:
        answer = client.get("/live", params={"topic": topic})
    assert answer.status_code == 422
    assert "expected one of fleet, alarms, relays" in answer.json()["detail"]


def test_too_many_topics_are_refused(url: str, repository: Repository) -> None:
    with logged_in(url, repository, Role.VIEWER) as client:
        assert client.get("/live", params={"topic": ["fleet"] * 6}).status_code == 422


def test_who_may_not_look_is_not_told(url: str, repository: Repository) -> None:
    with logged_in(url, repository, Role.SECADM) as client:
        assert client.get("/live", params={"topic": "fleet"}).status_code == 403


def test_streams_leave_connections_for_others(
    repository: Repository, store: RecordingStore, tmp_path: Path
) -> None:
    settings = Settings(data_directory=tmp_path, max_connections=4)
    site = create_site(ApiContext(settings, repository, store))
    with listening(site, connection_limits(settings)) as port:
        url = f"http://127.0.0.1:{port}"
        with (
            logged_in(url, repository, Role.VIEWER) as client,
            following(client, topic="fleet"),
            following(client, topic="fleet"),
        ):
            until_followed(site, 2)
            answer = client.get("/live", params={"topic": "fleet"})
            assert answer.status_code == 503
            assert "streams of open pages" in answer.json()["detail"]
            assert answer.headers["retry-after"]
            assert client.get("/healthz").status_code == 200


def test_the_service_stops_at_once_though_pages_are_open(context: ApiContext) -> None:
    site, repository = create_site(context), context.repository
    ended: list[list[str]] = []
    with listening(site, connection_limits(context.settings)) as port:
        client = logged_in(f"http://127.0.0.1:{port}", repository, Role.VIEWER)

        def follow() -> None:
            with client, following(client, topic="fleet") as lines:
                ended.append(list(lines))

        thread = threading.Thread(target=follow)
        thread.start()
        until_followed(site, 1)
        began = time.monotonic()
    thread.join(timeout=LONGEST_S)
    assert time.monotonic() - began < 2.5, "it waits 3 s for requests that do not end"
    assert len(ended) == 1, "the stream came to its end, and was not cut off"
