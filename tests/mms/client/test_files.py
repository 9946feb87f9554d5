"""Listing and fetching files, and what a server lets its clients see."""

import ctypes
import io
import threading
from pathlib import Path

import pytest

from mms import (
    AccessDenied,
    Client,
    ConnectionLost,
    FileAnswer,
    FileOperation,
    FileRequest,
    FileSizeMismatch,
    MmsError,
    NotFound,
    ProtocolError,
    Server,
    TemporarilyUnavailable,
    Timeout,
)
from mms.client import files as files_module
from mms.client.files import FileEntry
from mms.server.file_access import FileGuard
from testing.ports import LOOPBACK
from testing.relays.serving import RelayProcess, start_relay

CONTENT = bytes(range(256)) * 1000
NAME = "EVENTS/C4_00001.CEV"


def test_files_are_listed_with_size_and_time(client: Client, file_root: Path) -> None:
    entries = {entry.name: entry for entry in client.files("EVENTS")}
    assert set(entries) == {NAME, "EVENTS/EMPTY.CEV"}
    entry = entries[NAME]
    assert entry.size == len(CONTENT)
    assert abs(entry.modified_ns - (file_root / NAME).stat().st_mtime_ns) < 2e9
    assert {entry.name for entry in client.files()} == set(entries)


def test_an_unknown_directory_is_not_found(client: Client) -> None:
    with pytest.raises(NotFound):
        client.files("NOPE")


def test_a_long_listing_comes_in_parts_and_is_complete(client: Client, file_root: Path) -> None:
    names = {f"EVENTS/FR_{number:05d}.CFG" for number in range(2500)}
    for name in names:
        (file_root / name).touch()
    assert {entry.name for entry in client.files("EVENTS")} > names


def test_a_listing_that_never_ends_is_a_protocol_error(
    client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    again = ([FileEntry("A", 1, 0)], True)
    monkeypatch.setattr(files_module, "_listing", lambda *_: again)
    with pytest.raises(ProtocolError, match="never ends"):
        client.files()


@pytest.mark.parametrize("expected_size", [None, len(CONTENT)])
def test_a_file_is_streamed_whole(client: Client, expected_size: int | None) -> None:
    sink = io.BytesIO()
    assert client.download(NAME, sink, expected_size=expected_size) == len(CONTENT)
    assert sink.getvalue() == CONTENT


def test_an_empty_file_is_no_error(client: Client) -> None:
    assert client.download("EVENTS/EMPTY.CEV", io.BytesIO(), expected_size=0) == 0


@pytest.mark.parametrize("name", ["EVENTS/NOPE.CEV", "NOPE", "EVENTS", "EVENTS/", "", "/etc/passwd"])
def test_a_missing_file_or_a_directory_is_not_found(client: Client, name: str) -> None:
    with pytest.raises(NotFound):
        client.download(name, io.BytesIO())


@pytest.mark.parametrize(("expected_size", "word"), [(len(CONTENT) + 1, "256000 bytes"), (1000, "or more")])
def test_another_size_than_listed_is_an_error(client: Client, expected_size: int, word: str) -> None:
    with pytest.raises(FileSizeMismatch, match=word) as mismatch:
        client.download(NAME, io.BytesIO(), expected_size=expected_size)
    assert mismatch.value.expected == expected_size
    assert mismatch.value.received > 0


def test_a_directory_sent_as_a_file_is_an_error(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """What relays without our guard do: GET of a directory succeeds, and has a size of its own."""
    monkeypatch.setattr(FileGuard, "answer", lambda *_: FileAnswer.SERVE)
    with pytest.raises(FileSizeMismatch):
        client.download("EVENTS", io.BytesIO(), expected_size=len(CONTENT))


def test_a_failing_sink_fails_the_download_and_frees_the_file(client: Client) -> None:
    class Full:
        def write(self, _chunk: bytes, /) -> int:
            raise OSError("disk full")

    for _ in range(12):  # a server has five handles a client
        with pytest.raises(OSError, match="disk full"):
            client.download(NAME, Full())
    assert client.download(NAME, io.BytesIO()) == len(CONTENT)


def test_an_impossible_name_never_reaches_the_wire(client: Client) -> None:
    for name in ("a\0b", "x" * 256):
        with pytest.raises(ValueError, match="not a file name"):
            client.download(name, io.BytesIO())


def test_names_are_the_relays_octets(client: Client, file_root: Path) -> None:
    (file_root / "EVENTS" / "größe 1.txt").write_bytes(b"1")
    (name,) = [entry.name for entry in client.files("EVENTS") if entry.name.endswith(".txt")]
    assert name.encode("latin-1").decode() == "EVENTS/größe 1.txt"
    assert client.download(name, io.BytesIO()) == 1


class _Interrupting(io.BytesIO):
    """Calls a function once, when the first part has come."""

    def __init__(self, interrupt: threading.Event) -> None:
        super().__init__()
        self.started = interrupt

    def write(self, chunk: bytes, /) -> int:  # type: ignore[override]
        self.started.set()
        return super().write(chunk)


def _big(file_root: Path) -> str:
    (file_root / "EVENTS" / "BIG.DAT").write_bytes(bytes(30_000_000))
    return "EVENTS/BIG.DAT"


def test_a_relay_killed_during_a_download_is_a_lost_connection(
    relay_process: RelayProcess, file_root: Path
) -> None:
    name = _big(file_root)

    class Killing(io.BytesIO):
        def write(self, chunk: bytes, /) -> int:  # type: ignore[override]
            relay_process.kill()
            return super().write(chunk)

    with Client.connect(LOOPBACK, relay_process.port) as client, pytest.raises(ConnectionLost):
        client.download(name, Killing())


def test_a_relay_frozen_during_a_download_times_out(relay_process: RelayProcess, file_root: Path) -> None:
    name = _big(file_root)
    frozen: list[bool] = []

    class Freezing(io.BytesIO):
        def write(self, chunk: bytes, /) -> int:  # type: ignore[override]
            if not frozen:
                relay_process.freeze()
                frozen.append(True)
            return super().write(chunk)

    with (
        Client.connect(LOOPBACK, relay_process.port, request_timeout_s=0.5) as client,
        pytest.raises(Timeout),
    ):
        client.download(name, Freezing())


def test_closing_ends_a_download(relay: Server, file_root: Path) -> None:
    name = _big(file_root)
    started = threading.Event()
    client = Client.connect(LOOPBACK, relay.port)
    outcome: list[MmsError] = []

    def fetch() -> None:
        try:
            client.download(name, _Interrupting(started))
        except MmsError as error:
            outcome.append(error)

    fetcher = threading.Thread(target=fetch)
    fetcher.start()
    assert started.wait(10)
    client.close()
    fetcher.join(10)
    assert [type(error) for error in outcome] == [ConnectionLost]


# the server's guard


def test_links_that_leave_the_root_are_refused(client: Client, file_root: Path, tmp_path: Path) -> None:
    (tmp_path / "secret").write_bytes(b"secret")
    (file_root / "out.txt").symlink_to(tmp_path / "secret")
    (file_root / "outside").symlink_to(tmp_path)
    (file_root / "in.txt").symlink_to(file_root / NAME)
    (file_root / "circle").symlink_to(file_root / "circle")
    with pytest.raises(AccessDenied):
        client.download("out.txt", io.BytesIO())
    with pytest.raises(AccessDenied):
        client.download("outside/secret", io.BytesIO())
    with pytest.raises(AccessDenied):
        client.files("outside")
    with pytest.raises(NotFound):
        client.download("circle", io.BytesIO())
    assert client.download("in.txt", io.BytesIO()) == len(CONTENT)


@pytest.mark.parametrize("name", ["../secret", "EVENTS/../../secret", "..\\secret", "EVENTS\\..\\..\\secret"])
def test_names_that_climb_are_refused(client: Client, tmp_path: Path, name: str) -> None:
    (tmp_path / "secret").write_bytes(b"secret")
    with pytest.raises((AccessDenied, NotFound)):
        client.download(name, io.BytesIO())


def test_clients_cannot_delete_or_rename(relay: Server, client: Client, file_root: Path) -> None:
    lib = client._connection.lib
    lib.IedConnection_deleteFile.argtypes = [ctypes.c_void_p, ctypes.POINTER(ctypes.c_int), ctypes.c_char_p]
    lib.IedConnection_deleteFile.restype = None
    with pytest.raises(AccessDenied):
        client._connection.client_request("delete", lib.IedConnection_deleteFile, NAME.encode())
    assert (file_root / NAME).exists()


def test_content_is_made_on_demand_refused_or_put_off(file_root: Path) -> None:
    seen: list[FileRequest] = []

    def answer(request: FileRequest) -> FileAnswer:
        seen.append(request)
        if request.name == "REPORTS/HISTORY.TXT":
            request.path.parent.mkdir(exist_ok=True)
            request.path.write_text("fresh\n")
        if request.name == "EVENTS/LATER.CEV":
            return FileAnswer.BUSY
        return FileAnswer.DENIED if request.name == NAME else FileAnswer.SERVE

    with (
        start_relay(file_root=file_root, on_file_request=answer) as relay,
        Client.connect(LOOPBACK, relay.port) as client,
    ):
        assert client.download("REPORTS/HISTORY.TXT", io.BytesIO()) == 6
        with pytest.raises(TemporarilyUnavailable):
            client.download("EVENTS/LATER.CEV", io.BytesIO())
        with pytest.raises(AccessDenied):
            client.download(NAME, io.BytesIO())
        client.files("EVENTS")
    assert [request.operation for request in seen] == [FileOperation.OPEN] * 3 + [FileOperation.LIST]
    assert seen[0].path == file_root.resolve() / "REPORTS" / "HISTORY.TXT"


def test_a_hook_that_raises_refuses_and_is_logged(file_root: Path, caplog: pytest.LogCaptureFixture) -> None:
    def fail(_request: FileRequest) -> FileAnswer:
        raise LookupError("hook fault")

    with (
        start_relay(file_root=file_root, on_file_request=fail) as relay,
        Client.connect(LOOPBACK, relay.port) as client,
        pytest.raises(AccessDenied),
    ):
        client.download(NAME, io.BytesIO())
    assert "hook fault" in caplog.text


def test_a_server_without_a_file_root_serves_no_files() -> None:
    with start_relay() as relay, Client.connect(LOOPBACK, relay.port) as client, pytest.raises(MmsError):
        client.files()
