"""Brings a database to the tables of this version: `migrate(url)`, run at every start."""

from pathlib import Path

from alembic import command
from alembic.config import Config
from sqlalchemy import Connection

from service.storage.engine import connect


def migrate(url: str) -> None:
    """Creates the tables or brings older ones up to date; nothing to do is fine too.

    Raises StorageError (no such URL), sqlalchemy.exc.SQLAlchemyError (the database does not answer).
    """
    engine = connect(url)
    try:
        with engine.begin() as connection:
            command.upgrade(config(connection), "head")
    finally:
        engine.dispose()


def config(connection: Connection) -> Config:
    """Alembic's configuration for one connection; there is no alembic.ini."""
    settings = Config()
    settings.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    settings.set_main_option("path_separator", "os")
    settings.set_main_option("file_template", "v%%(rev)s_%%(slug)s")
    settings.attributes["connection"] = connection
    return settings
