"""A PostgreSQL server for the tests, on a socket of its own, gone when its process ends."""

import os
import shutil
import signal
import subprocess
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import sqlalchemy

from service.storage import migrate
from testing.memory_folder import memory_folder
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
TEMPLATE = "migrated"


def binaries() -> Path | None:
    """The folder of the latest server installed; None without one."""
    known = sorted(INSTALLED.glob("*/bin/postgres"), key=lambda path: int(path.parts[-3].partition(".")[0]))
    if known:
        return known[-1].parent
    found = shutil.which("postgres")
    return None if found is None else Path(found).resolve().parent


class PostgresServer:
    """A running server. Its databases are copies of one that is migrated once."""

    def __init__(self, socket: Path) -> None:
        self._socket = socket
        self._migrated = False

    def url(self, database: str) -> str:
        """SQLAlchemy URL of a database of this server."""
        return f"postgresql+psycopg://{OWNER}@/{database}?host={self._socket}"

    @contextmanager
    def database(self, *, migrated: bool = True) -> Iterator[str]:
        """The URL of a database of its own."""
        if migrated and not self._migrated:
            self._execute(f"CREATE DATABASE {TEMPLATE}")
            migrate(self.url(TEMPLATE))
            self._migrated = True
        name = f"test_{uuid.uuid4().hex}"
        self._execute(f"CREATE DATABASE {name} TEMPLATE {TEMPLATE if migrated else 'template0'}")
        try:
            yield self.url(name)
        finally:
            self._execute(f"DROP DATABASE {name} WITH (FORCE)")

    def answers(self) -> bool:
        """Whether the server can be asked."""
        try:
            self._execute("SELECT 1")
        except sqlalchemy.exc.OperationalError:
            return False
        return True

    def _execute(self, statement: str) -> None:
        engine = sqlalchemy.create_engine(self.url("postgres"), isolation_level="AUTOCOMMIT")
        with engine.connect() as connection:
            connection.exec_driver_sql(statement)
        engine.dispose()


@contextmanager
def serving_postgresql(folder: Path) -> Iterator[PostgresServer]:
    """A server of the programs in `folder` that ends with the block, and with this process at the latest."""
    # Not in pytest's folder: the server's user may not enter that, and a socket's path is short.
    # A database is 300 files, and each test has one of its own: in memory they are copied sooner.
    with tempfile.TemporaryDirectory(prefix="pg-", dir=memory_folder(), ignore_cleanup_errors=True) as name:
        directory = Path(name)
        as_owner: list[str] = ["setpriv", "--pdeathsig=QUIT"]
        if os.getuid() == 0:
            shutil.chown(directory, OWNER)
            as_owner += [f"--reuid={OWNER}", f"--regid={OWNER}", "--init-groups"]
        data = directory / "data"
        making = [str(folder / "initdb"), f"--pgdata={data}", f"--username={OWNER}", "--auth=trust"]
        making += ["--encoding=UTF8", "--no-locale", "--no-sync"]
        subprocess.run([*as_owner, *making], check=True, capture_output=True, cwd=directory)
        options = [f"--{name}={value}" for name, value in OPTIONS.items()]
        with (
            (directory / "log").open("wb") as log,
            subprocess.Popen(
                [*as_owner, folder / "postgres", "-D", data, "-k", directory, *options],
                stdout=log,
                stderr=log,
                cwd=directory,
            ) as process,
        ):
            try:
                server = PostgresServer(directory)
                wait_until(lambda: process.poll() is not None or server.answers(), "PostgreSQL to answer")
                assert process.poll() is None, (directory / "log").read_text()
                yield server
            finally:
                process.send_signal(signal.SIGQUIT)
                process.wait()
