"""Whether a database has the tables that the models say."""

from typing import Any

from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import Connection

from service.storage.models import Base
from service.storage.partitions import partitions


def differences(connection: Connection) -> list[Any]:
    """Return what differs between the tables and the models; partitions are no tables of their own."""
    others = set(partitions(connection))

    def is_table(name: str | None, kind: str, _parents: object) -> bool:
        return kind != "table" or name not in others

    context = MigrationContext.configure(connection, opts={"compare_type": True, "include_name": is_table})
    return list(compare_metadata(context, Base.metadata))
