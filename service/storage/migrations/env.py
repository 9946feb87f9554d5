"""Alembic's entry: runs the revisions on the connection `migrations.config` was given."""

from alembic import context
from sqlalchemy import Connection

from service.storage.models import Base

connection = context.config.attributes["connection"]
if not isinstance(connection, Connection):
    raise TypeError("use service.storage.migrate: it brings the connection")

# SQLite alters a table by copying it (batch mode).
context.configure(connection=connection, target_metadata=Base.metadata, render_as_batch=True)
with context.begin_transaction():
    context.run_migrations()
