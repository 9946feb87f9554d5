"""Empty databases of the service, whose tables are made once in a process and then copied."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from sqlalchemy import make_url

from service.configuration.settings import sqlite_url
from service.storage import migrate


def make_database(directory: Path) -> str:
    """Put an SQLite file with all tables, and nothing in them, into the directory; return its URL."""
    url = sqlite_url(directory)
    _file_of(url).write_bytes(_empty_database())
    return url


@cache
def _empty_database() -> bytes:
    with TemporaryDirectory(prefix="statorwatch-test-") as directory:
        url = sqlite_url(Path(directory))
        migrate(url)
        return _file_of(url).read_bytes()


def _file_of(url: str) -> Path:
    file = make_url(url).database
    assert file is not None
    return Path(file)
