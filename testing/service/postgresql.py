"""A PostgreSQL server for the tests, on a socket of its own, gone when its process ends."""

import os
import shutil
import signal
import subprocess
import tempfile
import uuid
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import sqlalchemy

from service.storage import migrate
from testing.memory_folder import memory_folder
from testing.service.processes import descendants
from testing.waiting import wait_until

INSTALLED = Path("/usr/lib/postgresql")
"""Where Debian puts the servers, one folder a version."""

OWNER = "postgres"
"""The server refuses to run as root; then it runs as this user, whom Debian's package makes."""

OPTIONS = {
    "listen_addresses": "",
    "fsync": "off",
    "full_page_writes": "off",
    "synchronous_commit": "off",
    "max_connections": "200",
    "shared_buffers": "32MB",
}
"""For tests that are over in a moment: nothing need outlive the server."""

TEMPLATE = "migrated"


def binaries() -> Path | None:
    """The folder of the latest server installed; None without one."""
    known = sorted(INSTALLED.glob("*/bin/postgres"), key=lambda path: int(path.parts[-3].partition(".")[0]))
    if known:
        return known[-1].parent
    found = shutil.which("postgres")
    return None if found is None else Path(found).resolve().parent


class PostgresServer:
    """A server. Its databases are copies of one that is migrated once."""

    def __init__(self, programs: Path, directory: Path, options: Mapping[str, str]) -> None:
        """directory: for its data, its log and its socket."""
        self._programs = programs
        self._directory = directory
        self._options = options
        self._as_owner = ["setpriv", "--pdeathsig=QUIT"]
        if os.getuid() == 0:
            shutil.chown(directory, OWNER)
            directory.chmod(0o711)  # processes of the service, which give up root's rights, find the socket
            self._as_owner += [f"--reuid={OWNER}", f"--regid={OWNER}", "--init-groups"]
        # The server ends with the thread that has started it, so that one has to live as long.
        self._starting = ThreadPoolExecutor(1, "postgresql")
        self._process: subprocess.Popen[bytes] | None = None
        self._migrated = False

    @property
    def log(self) -> Path:
        """What the server says."""
        return self._directory / "log"

    @property
    def _data(self) -> Path:
        return self._directory / "data"

    def make(self) -> None:
        """Make the files of the server."""
        making = [str(self._programs / "initdb"), f"--pgdata={self._data}", f"--username={OWNER}"]
        making += ["--auth=trust", "--encoding=UTF8", "--no-locale", "--no-sync"]
        subprocess.run([*self._as_owner, *making], check=True, capture_output=True, cwd=self._directory)

    def start(self) -> None:
        """Start it, and wait until it answers."""
        process = self._process = self._starting.submit(self._started).result()
        wait_until(lambda: process.poll() is not None or self.answers(), "PostgreSQL to answer")
        assert process.poll() is None, self.log.read_text()

    def stop(self, number: signal.Signals = signal.SIGQUIT) -> None:
        """End it: SIGINT is a fast shutdown, SIGQUIT one without any care, as a crash."""
        if self._process is not None:
            self._process.send_signal(number)
            self._process.wait()

    def freeze(self) -> None:
        """Have all its processes stand still: what it is asked waits, and no connection ends."""
        self._signal_all(signal.SIGSTOP)

    def thaw(self) -> None:
        """Let it go on."""
        self._signal_all(signal.SIGCONT)

    def _signal_all(self, number: signal.Signals) -> None:
        assert self._process is not None
        for process_id in (self._process.pid, *descendants(self._process.pid)):
            os.kill(process_id, number)

    def close(self) -> None:
        """End it for good."""
        self.stop()
        self._starting.shutdown()

    def _started(self) -> "subprocess.Popen[bytes]":
        options = [f"--{name}={value}" for name, value in self._options.items()]
        command = [*self._as_owner, str(self._programs / "postgres")]
        command += ["-D", str(self._data), "-k", str(self._directory)]
        with self.log.open("ab") as log:
            return subprocess.Popen([*command, *options], stdout=log, stderr=log, cwd=self._directory)

    def url(self, database: str) -> str:
        """SQLAlchemy URL of a database of this server."""
        port = self._options.get("port", "5432")
        return f"postgresql+psycopg://{OWNER}@/{database}?host={self._directory}&port={port}"

    @contextmanager
    def database(self, *, migrated: bool = True, encoding: str = "UTF8") -> Iterator[str]:
        """The URL of a database of its own; one with tables is in UTF8."""
        assert encoding == "UTF8" or not migrated
        if migrated and not self._migrated:
            self.execute(f"CREATE DATABASE {TEMPLATE}")
            migrate(self.url(TEMPLATE))
            self._migrated = True
        name = f"test_{uuid.uuid4().hex}"
        template = TEMPLATE if migrated else f"template0 ENCODING '{encoding}'"
        self.execute(f"CREATE DATABASE {name} TEMPLATE {template}")
        try:
            yield self.url(name)
        finally:
            self.execute(f"DROP DATABASE {name} WITH (FORCE)")

    def answers(self) -> bool:
        """Whether the server can be asked."""
        try:
            self.execute("SELECT 1")
        except sqlalchemy.exc.OperationalError:
            return False
        return True

    def execute(self, statement: str) -> None:
        """Have the server do something, in no transaction."""
        engine = sqlalchemy.create_engine(self.url("postgres"), isolation_level="AUTOCOMMIT")
        with engine.connect() as connection:
            connection.exec_driver_sql(statement)
        engine.dispose()


@contextmanager
def serving_postgresql(folder: Path, options: Mapping[str, str] = OPTIONS) -> Iterator[PostgresServer]:
    """A server of the programs in `folder` that ends with the block, and with this process at the latest."""
    # Not in pytest's folder: the server's user may not enter that, and a socket's path is short.
    # A database is 300 files, and each test has one of its own: in memory they are copied sooner.
    with tempfile.TemporaryDirectory(prefix="pg-", dir=memory_folder(), ignore_cleanup_errors=True) as name:
        server = PostgresServer(folder, Path(name), options)
        server.make()
        try:
            server.start()
            yield server
        finally:
            server.close()
