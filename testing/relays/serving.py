"""Relays to talk to: in this process, in a process of their own, and things that only look like one."""

import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from mms import FileAnswer, FileRequest, Server, ServerStartFailed, TlsConfiguration
from testing.ports import LOOPBACK, free_port
from testing.relays.model import MODEL_TEXT


def start_relay(
    *, file_root: Path | None = None, max_connections: int = 5, report_buffer_bytes: int = 65_536,
    on_file_request: Callable[[FileRequest], FileAnswer] | None = None, tls: TlsConfiguration | None = None,
    passwords: Iterable[str] = (), tls_handshake_timeout_s: float = 5.0,
) -> Server:  # fmt: skip
    """A running server on a free port; tries again if another process was faster."""
    for attempt in range(5):
        server = Server(
            MODEL_TEXT, port=free_port(), file_root=file_root, max_connections=max_connections,
            report_buffer_bytes=report_buffer_bytes, on_file_request=on_file_request,
            tls=tls, passwords=passwords, tls_handshake_timeout_s=tls_handshake_timeout_s,
        )  # fmt: skip
        try:
            server.start()
        except ServerStartFailed:
            if attempt == 4:
                raise
        else:
            return server
    raise AssertionError("unreachable")


class RelayProcess:
    """A relay in a process of its own, to be frozen or killed."""

    def __init__(self, file_root: Path, certificates: Path | None = None) -> None:
        """With the certificates of a Pki it speaks TLS."""
        folder = [] if certificates is None else [str(certificates)]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "testing.relays.process", str(file_root), *folder],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert self._process.stdout is not None
        self.port = int(self._process.stdout.readline())

    def freeze(self) -> None:
        os.kill(self._process.pid, signal.SIGSTOP)
        os.waitid(os.P_PID, self._process.pid, os.WSTOPPED)

    def thaw(self) -> None:
        os.kill(self._process.pid, signal.SIGCONT)

    def kill(self) -> None:
        self._process.kill()
        self._process.wait()

    def end(self) -> None:
        if self._process.poll() is None:
            self.thaw()
            self._process.terminate()
        self._process.communicate(timeout=20)


@contextmanager
def mute_server() -> Iterator[int]:
    """Accepts connections (the kernel does) and never answers; gives its port."""
    with socket.socket() as listener:
        listener.bind((LOOPBACK, 0))
        listener.listen()
        yield int(listener.getsockname()[1])


class Relaying:
    """A TCP proxy before a relay that cuts the first connections at the client's next message after some."""

    def __init__(self, target_port: int, *, cuts: int, after_messages: int) -> None:
        self._target_port = target_port
        self._cuts = cuts
        self._after_messages = after_messages
        self._listener = socket.create_server((LOOPBACK, 0))
        self.port = int(self._listener.getsockname()[1])
        self.accepted = 0
        self._threads: list[threading.Thread] = []
        self._run(self._accept)

    def close(self) -> None:
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        for thread in self._threads:
            thread.join(10)

    def _run(self, target: Callable[[], None]) -> None:
        thread = threading.Thread(target=target)
        self._threads.append(thread)
        thread.start()

    def _accept(self) -> None:
        while True:
            try:
                client, _ = self._listener.accept()
            except OSError:
                return
            self.accepted += 1
            cut_after = self._after_messages if self.accepted <= self._cuts else sys.maxsize
            relay = socket.create_connection((LOOPBACK, self._target_port))
            self._run(lambda source=client, sink=relay, left=cut_after: _copy(source, sink, left))  # type: ignore[misc]
            self._run(lambda source=relay, sink=client: _copy(source, sink, sys.maxsize))  # type: ignore[misc]


def _copy(source: socket.socket, sink: socket.socket, messages: int) -> None:
    try:
        while (data := source.recv(65_536)) and messages:
            sink.sendall(data)
            messages -= 1
    except OSError:
        pass  # the other direction ended it
    for end in (source, sink):
        try:
            end.shutdown(socket.SHUT_RDWR)
        except OSError:
            continue
    sink.close()
