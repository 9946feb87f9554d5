"""What the service says it has: over REST, and in its store and database once it has ended."""

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from service.client.rest_client import ServiceClient
from tests.chaos.ledger import File

ENDED = ("diagnosed", "failed")
ASKED_AT_ONCE = 8
SETTLED = ("diagnosed", "rejected", "failed")


@dataclass(frozen=True, slots=True)
class Row:
    """A recording as GET /recordings tells it."""

    id: str
    relay: str
    name: str
    state: str
    reason: str
    is_fetched: bool


@dataclass(frozen=True, slots=True)
class Request:
    """A recording request as GET /event-reports tells it."""

    id: str
    relay: str
    state: str
    reason: str
    recording: str | None
    was_triggered: bool


@dataclass(frozen=True, slots=True)
class Folder:
    """A folder of the store, every file read and hashed; stored_ns: since when it is there, UTC [ns]."""

    path: Path
    files: Mapping[str, File]
    stored_ns: int


def rows(client: ServiceClient) -> list[Row]:
    """Raises ServiceError."""
    return [
        Row(
            id=str(each["id"]),
            relay=str(each["ied"]),
            name=str(each["name"]),
            state=str(each["state"]),
            reason=str(each["reason"] or ""),
            is_fetched=each["fetched_time"] is not None,
        )
        for each in client.items("/recordings", limit="1000")
    ]


def requests(client: ServiceClient) -> list[Request]:
    """Raises ServiceError."""
    return [
        Request(
            id=str(each["id"]),
            relay=str(each["ied"]),
            state=str(each["state"]),
            reason=str(each["reason"] or ""),
            recording=None if each["recording_id"] is None else str(each["recording_id"]),
            was_triggered=each["triggered_time"] is not None,
        )
        for each in client.items("/event-reports", limit="1000")
    ]


def files_of(client: ServiceClient, recording: str) -> dict[str, File]:
    """What GET /recordings/{id} says of its files. Raises ServiceError."""
    files = client.get(f"/recordings/{recording}")["files"]
    assert isinstance(files, list)
    return {str(file["name"]): File(int(file["size_bytes"]), str(file["sha256"])) for file in files}


def files_of_all(client: ServiceClient, recordings: Sequence[str]) -> dict[str, dict[str, File]]:
    """The same of many. Raises ServiceError."""
    with ThreadPoolExecutor(ASKED_AT_ONCE) as asking:
        found = asking.map(lambda recording: files_of(client, recording), recordings)
        return dict(zip(recordings, found, strict=True))


def ask_at_once(client: ServiceClient) -> None:
    """As many requests as there will be at once. Raises ServiceError."""
    with ThreadPoolExecutor(ASKED_AT_ONCE) as asking:
        list(asking.map(lambda _: links(client), range(4 * ASKED_AT_ONCE)))


def links(client: ServiceClient) -> dict[str, tuple[str, str]]:
    """State and reason of each relay's link. Raises ServiceError."""
    return {
        str(each["name"]): (str(each["link_state"]), str(each["link_reason"] or ""))
        for each in client.items("/ieds", limit="1000")
    }


def folders(store: Path) -> list[Folder]:
    """Everything in the store that is named by its content."""
    found = []
    for path in store.glob("??/*"):
        contents = {file.name: file.read_bytes() for file in path.iterdir()}
        files = {name: File(len(held), sha256(held).hexdigest()) for name, held in contents.items()}
        found.append(Folder(path, files, path.stat().st_ctime_ns))
    return found


def left_arriving(store: Path) -> list[str]:
    """What lies in the place for what is arriving: files, and where."""
    incoming = store / "incoming"
    return sorted(str(path.relative_to(incoming)) for path in incoming.rglob("*") if path.is_file())
