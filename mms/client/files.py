"""Listing and download of a relay's files (IEC 61850-7-2 clause 23, ISO 9506-2 file services)."""

import ctypes
import logging
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Final, Protocol

from mms import errors
from mms.binding.callbacks import guarded
from mms.binding.prototypes import FileDirectoryHandler, FileReadAsyncHandler, FileReadHandler
from mms.client.connection import Connection
from mms.client.throughput import ThroughputLimit
from mms.client.tick_loop import TickedConnection
from mms.values import NANOSECONDS_PER_MILLISECOND

log: Final = logging.getLogger("mms")

_LONGEST_NAME: Final = 255
_CONNECTION_LOST: Final = 2
"""The library's MMS_ERROR_CONNECTION_LOST."""
_NO_ANSWER: Final = 3
"""The library's MMS_ERROR_SERVICE_TIMEOUT."""
_MARGIN_S: Final = 2.0
"""So much later than the library a part is given up, should the library not do so."""


class Sink(Protocol):
    """Receiver of a downloaded file's bytes, in order: a binary file or a hash, say."""

    def write(self, chunk: bytes, /) -> object:
        """Take the next bytes.

        Parameters
        ----------
        chunk : bytes
            The bytes.

        Returns
        -------
        object
            Ignored.
        """


@dataclass(frozen=True, slots=True)
class FileEntry:
    """One file of a relay's listing.

    Parameters
    ----------
    name : str
        Name as the relay gives it.
    size : int
        Size [byte].
    modified_ns : int
        Time of the last change [ns, UTC].
    """

    name: str
    size: int
    modified_ns: int


def list_files(connection: Connection, directory: str) -> tuple[FileEntry, ...]:
    """List every file of a directory.

    Relays send long listings in parts; all of them are requested.

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    directory : str
        Name of the directory, "" for the root.

    Returns
    -------
    tuple of FileEntry
        The files.

    Raises
    ------
    Timeout
        The whole takes longer than the limits of the connection allow, though each part comes in time.
    ProtocolError
        The listing never ends, or cannot be continued.
    """
    operation = f"list files of {directory or 'the root'!r}"
    entries: dict[str, FileEntry] = {}
    last: str | None = None
    longest_s = connection.limits.listing_s
    began_s = time.monotonic()
    while True:
        part, more = _listing(connection, operation, directory, last)
        known = len(entries)
        entries.update((entry.name, entry) for entry in part)
        if not more:
            return tuple(entries.values())
        if len(entries) == known or len(entries) > connection.limits.listed_files:
            reason = f"the listing never ends ({len(entries)} names so far)"
            raise errors.ProtocolError(connection.host, operation, 0, reason)
        if time.monotonic() - began_s > longest_s:
            received = f"received {len(entries)} names and more to come"
            reason = f"expected the whole listing in {longest_s:g} s, {received}"
            raise errors.Timeout(connection.host, operation, 0, reason)
        last = part[-1].name
        if len(last) > _LONGEST_NAME:
            reason = f"the listing cannot be continued after a name of {len(last)} characters"
            raise errors.ProtocolError(connection.host, operation, 0, reason)


def _listing(
    connection: Connection, operation: str, directory: str, after: str | None
) -> tuple[list[FileEntry], bool]:
    """Fetch one part of a listing; return its entries and whether more follows."""
    entries: list[FileEntry] = []

    def receive(_parameter: int | None, name: bytes, size: int, changed_ms: int) -> None:
        entries.append(FileEntry(name.decode("latin-1"), size, changed_ms * NANOSECONDS_PER_MILLISECOND))

    more = connection.request(
        operation,
        connection.lib.MmsConnection_getFileDirectory,
        file_name(directory) or None,
        None if after is None else file_name(after),
        FileDirectoryHandler(guarded(receive, None)),
        None,
        make_error=errors.file_error,
    )
    return entries, bool(more)


def file_name(name: str) -> bytes:
    """Encode a file name for C.

    Parameters
    ----------
    name : str
        Name whose characters are the relay's octets read as Latin-1.

    Returns
    -------
    bytes
        The relay's octets.

    Raises
    ------
    ValueError
        The name has a NUL or is longer than 255 octets.
    """
    octets = name.encode("latin-1")
    if b"\0" in octets or len(octets) > _LONGEST_NAME:
        raise ValueError(f"not a file name: {name!r}")
    return octets


def download(connection: Connection, name: str, sink: Sink, expected_size: int | None) -> int:
    """Stream one file to a sink in chunks of about 65 kB.

    Parameters
    ----------
    connection : Connection
        The association with the relay.
    name : str
        Name of the file as the relay lists it.
    sink : Sink
        Receives the bytes in order.
    expected_size : int or None
        Size as it was listed [byte]. None takes the size announced at opening, which some relays also
        announce for a directory: give the size wherever there is a listing.

    Returns
    -------
    int
        Number of bytes received.

    Raises
    ------
    FileSizeMismatch
        The number of bytes is not the expected one.
    Timeout
        A part does not come in time, or the throughput is below the limit of the connection.
    """
    operation = f"download {name!r}"
    with _open_file(connection, operation, name) as (handle, announced):
        expected = announced if expected_size is None else expected_size
        reader = _Reader(connection, operation, handle)
        throughput = ThroughputLimit(connection.host, operation, connection.limits)
        received = 0
        more = True
        while more:
            asked_s = time.monotonic()
            chunk, more = reader.read()
            took_s = time.monotonic() - asked_s
            received += len(chunk)
            if received > expected:
                break
            sink.write(chunk)
            if more and not chunk:
                raise errors.ProtocolError(
                    connection.host, operation, 0, "the relay sends empty parts without end"
                )
            if more:
                throughput.add(len(chunk), took_s)
            if connection.closing:
                raise errors.ConnectionLost(connection.host, operation, 0, "closed during the download")
    if received != expected:
        found = f"{received} bytes or more" if more else f"{received} bytes"
        raise errors.FileSizeMismatch(
            connection.host, operation, 0, f"expected {expected} bytes, received {found}", expected, received
        )
    return received


@contextmanager
def _open_file(connection: Connection, operation: str, name: str) -> Iterator[tuple[int, int]]:
    lib = connection.lib
    size = ctypes.c_uint32(0)
    handle = connection.request(
        operation, lib.MmsConnection_fileOpen, file_name(name), 0, ctypes.byref(size), None,
        make_error=errors.file_error,
    )  # fmt: skip
    if handle is None:
        raise errors.ProtocolError(connection.host, operation, 0, "no file handle came")
    try:
        yield handle, size.value
    finally:
        _close_file(connection, operation, handle)


def _close_file(connection: Connection, operation: str, handle: int) -> None:
    """Close the file: a relay has few handles. A lost connection holds none and is reported elsewhere."""
    try:
        connection.request(
            f"{operation}: close the file", connection.lib.MmsConnection_fileClose, handle,
            make_error=errors.file_error,
        )  # fmt: skip
    except errors.ConnectionLost:
        return
    except errors.MmsError as error:
        log.warning("%s", error)


class _Reader:
    """Reads one open file, part by part, with one callback for all parts."""

    def __init__(self, connection: Connection, operation: str, handle: int) -> None:
        self._connection = connection
        self._operation = operation
        self._file = handle
        self._parts: list[bytes] = []
        self._answers: list[tuple[int, bool]] = []
        self._handler = FileReadHandler(guarded(self._receive, None))
        self._async_handler = FileReadAsyncHandler(guarded(self._receive_answer, None))

    def read(self) -> tuple[bytes, bool]:
        """Carry out one FileRead; return the bytes and whether more follow."""
        self._parts.clear()
        ticked = self._connection.ticked
        if ticked is None:
            more = self._connection.request(
                self._operation, self._connection.lib.MmsConnection_fileRead, self._file, self._handler, None,
                make_error=errors.file_error,
            )  # fmt: skip
        else:
            more = self._connection.request(
                self._operation, partial(self._read_ticking, ticked), make_error=errors.file_error
            )
        return b"".join(self._parts), bool(more)

    def _read_ticking(
        self, ticked: TickedConnection, mms: int, error: ctypes.c_int, *_arguments: object
    ) -> bool:
        """Do as the library's MmsConnection_fileRead, and let this thread read the answer."""
        invoke_id = ctypes.c_uint32(0)
        self._answers.clear()
        # Unless it is answered, the library may still call the handler when it frees the connection.
        self._connection.keep_callback(self._async_handler)
        self._connection.lib.MmsConnection_fileReadAsync(
            mms, invoke_id, error, self._file, self._async_handler, None
        )
        more = False
        if not error.value:
            ticked.tick_until(lambda: bool(self._answers), self._connection.request_timeout_s + _MARGIN_S)
            if not self._answers:
                error.value = _CONNECTION_LOST if ticked.has_closed() else _NO_ANSWER
                return False
            ((error.value, more),) = self._answers
        self._connection.release_callback(self._async_handler)
        return more

    def _receive(self, _parameter: int | None, _handle: int, buffer: object, size: int) -> None:
        self._parts.append(ctypes.string_at(buffer, size))  # type: ignore[arg-type]

    def _receive_answer(
        self,
        _invoke_id: int,
        parameter: int | None,
        error: int,
        handle: int,
        buffer: object,
        size: int,
        more: bool,
    ) -> None:
        answer = _NO_ANSWER, False
        try:
            if not error and size:
                self._receive(parameter, handle, buffer, size)
            answer = error, more
        finally:
            self._answers.append(answer)  # in any case: the library calls once
