"""Names and texts that would begin a header, a document or a path of their own stay what they are: text."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from urllib.parse import unquote

import httpx
import pytest

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.plant import Plant
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.states import AlarmKind
from testing.service.database import make_database
from testing.service.diagnosed import add_diagnosed
from testing.service.job_runner import register_runner
from testing.service.plants import NOW_NS, healthy, two_motor_plant
from tests.service.api.serving import serving

INJECTED = "x-injected"
HOSTILE = (
    "PUMP\r\nX-Injected: 1",
    'PUMP"; filename="evil.exe',
    "PUMP\r\n\r\n<script>alert(1)",
    "Насос №1 \N{ROCKET}",
    "%0d%0aX-Injected:%201",
    "PUMP\u2028\u0085\x1b[31m",
    "..",
    "?a=b#c;d&e",
)


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """A service whose sites, relays and motors have these names, each motor with a recording and an alarm."""
    data: Path = tmp_path_factory.mktemp("hostile")
    engine = connect(make_database(data))
    repository, store = Repository(engine), FolderStore(data / "recordings")
    register_runner(repository)
    plant = two_motor_plant()
    site, relay, pump = plant.sites[0], plant.relays[0], plant.motors[0]
    hostile = Plant(
        sites=tuple(replace(site, name=name, description=name) for name in HOSTILE),
        relays=tuple(replace(relay, name=name, site=name, manufacturer=name, type=name) for name in HOSTILE),
        motors=tuple(
            replace(pump, motor=replace(pump.motor, name=name), description=name, site=name, relay=name)
            for name in HOSTILE
        ),
    )
    repository.sync_plant(hostile, noted_ns=NOW_NS)
    for name in HOSTILE:
        add_diagnosed(repository, store, healthy(), NOW_NS, motor=name)
        repository.raise_alarm(name, AlarmKind.FILE_REFUSED, name, name, now_ns=NOW_NS)
    with serving(create_app(ApiContext(Settings(data_directory=data), repository, store))) as client:
        yield client
    engine.dispose()


each_name = pytest.mark.parametrize("motor", HOSTILE, ids=range(len(HOSTILE)))


def quoted(name: str) -> str:
    """Every octet of a name as the segment of a path, so that no client takes any for more."""
    return "".join(f"%{octet:02X}" for octet in name.encode())


def checked(answer: httpx.Response) -> httpx.Response:
    """The answer, which is no failure of the service and has no header or cookie that a name made."""
    assert answer.status_code < 500, answer.text
    assert INJECTED not in answer.headers
    assert "set-cookie" not in answer.headers
    assert all(name.isascii() and value.isascii() for name, value in answer.headers.items())
    return answer


def routes(client: httpx.Client) -> list[str]:
    """Paths of the routes that read something by no more than a name."""
    paths = client.get("/api/v1/openapi.json").json()["paths"]
    return [
        path for path, methods in paths.items() if "get" in methods and "{" not in path.replace("{name}", "")
    ]


def look_at(client: httpx.Client, path: str) -> None:
    answer = checked(client.get(path))
    assert answer.headers["content-type"].partition(";")[0] != "text/html"


@each_name
def test_a_route_of_a_thing_takes_a_hostile_name(client: httpx.Client, motor: str) -> None:
    for path in routes(client):
        if "{name}" in path:
            look_at(client, path.replace("{name}", quoted(motor)))


def test_a_list_has_hostile_names(client: httpx.Client) -> None:
    for path in routes(client):
        if "{name}" not in path:
            look_at(client, path)


@each_name
@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("notes", {"text": "a note"}),
        ("reference", {"reason": "tested"}),
        ("event-reports", None),
    ],
)
def test_the_place_of_what_was_made_is_a_path(
    client: httpx.Client, motor: str, path: str, body: dict[str, str] | None
) -> None:
    answer = checked(client.post(f"/api/v1/motors/{quoted(motor)}/{path}", json=body))
    assert answer.is_success, answer.text
    location = answer.headers["location"]
    assert location.startswith("/api/v1/")
    assert not set(location) & set(' \r\n"<>?#')
    found = client.get(location)
    assert found.status_code == 200, (location, found.text)
    assert unquote(location).rpartition("/")[2] == found.json()["id"]


@each_name
def test_an_archive_is_named_in_characters_that_every_header_takes(client: httpx.Client, motor: str) -> None:
    (recording,) = client.get("/api/v1/recordings", params={"motor": motor}).json()["items"]
    assert recording["motor"] == motor
    answer = checked(client.get(f"/api/v1/recordings/{recording['id']}/file"))
    disposition = answer.headers["content-disposition"]
    assert disposition.count('"') == 2
    assert disposition.count(";") == 1


@pytest.mark.parametrize("header", ["Idempotency-Key", "User-Agent", "Accept", "Cookie", "X-Forwarded-For"])
def test_a_header_is_never_sent_back(client: httpx.Client, header: str) -> None:
    answer = client.post(
        "/api/v1/motors/no-such-motor/event-reports",
        headers={header.encode(): b"hostile-\xe9-<script>"},
    )
    assert answer.status_code < 500
    assert all("hostile" not in value for value in answer.headers.values())
    assert "<script>" not in answer.text
