"""The programs of a built libiec61850 tree: where they are, and running them."""

import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from mms import AssociationRejected, Client, ConnectFailed
from testing.ports import LOOPBACK, free_port

C_CLIENT = Path(__file__).parent / "c_client.c"
START_LIMIT_S = 10.0
TOOL_LIMIT_S = 60.0


class PeerError(RuntimeError):
    """A program of the other side is missing, or does not start: what was looked for and where."""


@dataclass(frozen=True)
class Result:
    """What one side asked of the other, and what was seen."""

    server: str
    asked: str
    seen: str
    passed: bool


@dataclass(frozen=True)
class Tree:
    """A built source tree of libiec61850."""

    root: Path

    def program(self, name: str) -> Path:
        """The built example of this name. Raises PeerError."""
        found = [path for path in self.root.rglob(name) if path.is_file() and path.stat().st_mode & 0o100]
        if not found:
            raise PeerError(f"{self.root}: expected a built program {name}, found none: build the examples")
        return found[0]

    def file(self, name: str) -> Path:
        """A file of the sources. Raises PeerError."""
        found = sorted(self.root.rglob(name))
        if not found:
            raise PeerError(f"{self.root}: expected a file {name}, found none: give the source tree")
        return found[0]

    @property
    def library(self) -> Path:
        return self.file("libiec61850.so")

    def c_client(self, directory: Path) -> Path:
        """c_client.c linked against the tree's library. Raises PeerError."""
        return linked(self.library, directory / "c_client")


def linked(library: Path, program: Path) -> Path:
    """c_client.c linked against a shared library of libiec61850. Raises PeerError."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        raise PeerError("no C compiler: expected gcc or cc on the path")
    command = [compiler, "-O2", "-o", str(program), str(C_CLIENT), str(library)]
    built = subprocess.run(
        [*command, f"-Wl,-rpath,{library.parent.resolve()}"], capture_output=True, text=True, check=False
    )
    if built.returncode != 0:
        raise PeerError(f"{C_CLIENT.name} does not compile: {built.stderr.strip()}")
    return program


@contextmanager
def c_server(tree: Tree, name: str, directory: Path | None = None) -> Iterator[int]:
    """One of the example servers, running in `directory`; its port. Raises PeerError."""
    with tempfile.TemporaryDirectory(prefix="statorwatch-peer-") as temporary:
        port = free_port()
        log = Path(temporary) / "log"
        with (
            log.open("wb") as sink,
            subprocess.Popen(
                [str(tree.program(name)), str(port)], cwd=directory or temporary, stdout=sink, stderr=sink
            ) as process,
        ):
            try:
                _await(name, port, process, log)
                yield port
            finally:
                process.terminate()
                process.wait(10)


def _await(name: str, port: int, process: "subprocess.Popen[bytes]", log: Path) -> None:
    deadline_s = time.monotonic() + START_LIMIT_S
    while process.poll() is None and time.monotonic() < deadline_s:
        try:
            Client.connect(LOOPBACK, port).close()
        except AssociationRejected:  # it listens, and wants a password
            return
        except ConnectFailed:
            time.sleep(0.05)
        else:
            return
    raise PeerError(f"{name}: does not serve: {log.read_text(errors='replace')[-500:]}")


def output(
    program: Path, *arguments: str, directory: Path | None = None
) -> "subprocess.CompletedProcess[str]":
    """A client tool run to its end, its output as text."""
    return subprocess.run(
        [str(program), *arguments],
        cwd=directory,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        timeout=TOOL_LIMIT_S,
        check=False,
    )
