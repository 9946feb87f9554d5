"""What a server's clients may do with its files (ISO 9506-2 file services, IEC 61850-7-2 clause 23)."""

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import Final

from mms.binding.callbacks import guarded, log
from mms.binding.prototypes import FileAccessHandler


class FileOperation(IntEnum):
    """File service asked for, with the numbers of the library's MmsFileServiceType."""

    LIST = 0
    OPEN = 1
    OBTAIN = 2
    DELETE = 3
    RENAME = 4


class FileAnswer(IntEnum):
    """What the client is told, with the numbers of the library's MmsError.

    BUSY is sent as a lack of resources: the library's server has no other way to say "later".
    """

    SERVE = 0
    BUSY = 40
    DENIED = 96
    ABSENT = 97


@dataclass(frozen=True, slots=True)
class FileRequest:
    """A client's request for a file or a listing.

    Parameters
    ----------
    operation : FileOperation
        The service.
    name : str
        The name that the client gave.
    path : pathlib.Path
        The path that the name means under the file root.
    """

    operation: FileOperation
    name: str
    path: Path


FileHook = Callable[[FileRequest], FileAnswer]


class FileGuard:
    """Decides each file request: reading inside the root only, then the hook.

    Writing services, "..", and links that lead out of the root are refused whatever the hook says. The hook
    runs before the path is checked, so that it can make content on demand, or answer BUSY until the content
    is there.

    Parameters
    ----------
    root : pathlib.Path
        Folder whose files are served.
    hook : FileHook or None
        Function that is asked first.
    """

    def __init__(self, root: Path, hook: FileHook | None) -> None:
        self._root: Final = root.resolve()
        self._hook = hook

    def answer(self, operation: int, name: bytes | None) -> FileAnswer:
        """Decide one request.

        Parameters
        ----------
        operation : int
            The library's number of the service.
        name : bytes or None
            The name that the client gave.

        Returns
        -------
        FileAnswer
            SERVE, or why not.
        """
        if operation not in (FileOperation.LIST, FileOperation.OPEN):
            return FileAnswer.DENIED
        text = (name or b"").decode("utf-8", "surrogateescape")
        relative = text.replace("\\", "/").lstrip("/")
        if ".." in relative.split("/"):
            log.warning("refused the file name %r: it leaves the file root", text)
            return FileAnswer.DENIED
        path = self._root / relative
        if self._hook is not None:
            answer = self._hook(FileRequest(FileOperation(operation), text, path))
            if answer is not FileAnswer.SERVE:
                return answer
        return self._check_path(operation, text, path)

    def _check_path(self, operation: int, text: str, path: Path) -> FileAnswer:
        try:
            real = path.resolve(strict=True)
        except (OSError, RuntimeError):  # RuntimeError: links in a circle
            return FileAnswer.ABSENT
        if not real.is_relative_to(self._root):
            log.warning("refused the file %r: a link that leaves the file root", text)
            return FileAnswer.DENIED
        if operation == FileOperation.OPEN and not real.is_file():
            return FileAnswer.ABSENT
        return FileAnswer.SERVE


def install_file_guard(lib: ctypes.CDLL, server: int, guard: FileGuard) -> object:
    """Let a guard decide each file request to a server.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    server : int
        Pointer to the IedServer.
    guard : FileGuard
        Decides the requests.

    Returns
    -------
    object
        The ctypes callback, to be held for as long as the server lives.
    """

    def answer(
        _parameter: int | None,
        _connection: int | None,
        service: int,
        name: bytes | None,
        _other: bytes | None,
    ) -> int:
        return int(guard.answer(service, name))

    handler = FileAccessHandler(guarded(answer, int(FileAnswer.DENIED)))
    lib.MmsServer_installFileAccessHandler(lib.IedServer_getMmsServer(server), handler, None)
    return handler
