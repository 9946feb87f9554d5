"""Rows for every table of a database whose revision may be any: made from the tables as they are found."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    Column,
    Connection,
    Enum,
    Float,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    insert,
    inspect,
    select,
)

from service.storage.models import Base
from service.storage.partitions import partitions

RENAMED: Mapping[str, str] = {"event_reports": "recording_requests"}
"""Tables that got another name, by the one that they had."""

OURS = frozenset({"alembic_version", "state_counts", "standing_alarm_counts", "audit_head"})
"""Tables whose rows the migrations and the service keep, one for each thing that is counted."""

WORDS: Mapping[tuple[str, str], object] = {
    ("alarms", "kind"): "file-refused",
    ("audit_entries", "roles"): "ENGINEER",
}
"""What stands in columns in which a migration expects a certain word."""

DOCUMENT = {"mu_f": 0.01, "mu_f_ci95": [0.009, 0.011], "load_level": 0.5, "load_level_ci95": [0.4, 0.6]}
"""A document that has what migrations look for in one."""


@dataclass(frozen=True, slots=True)
class Filled:
    """A row that was written: its table, and all of its columns."""

    table: str
    values: Mapping[str, Any]


def fill_tables(connection: Connection, number: int) -> Sequence[Filled]:
    """Write a row into every table, those first that others refer to; return them.

    number: makes the row differ from those of other calls.
    """
    metadata = MetaData()
    others = {*partitions(connection), *OURS}
    names = [name for name in inspect(connection).get_table_names() if name not in others]
    metadata.reflect(connection, only=names)
    written: dict[str, Mapping[str, Any]] = {}
    for table in metadata.sorted_tables:
        if table.name in OURS:
            continue
        values = dict(_values(table, number, written))
        connection.execute(insert(table), values)
        written[table.name] = values
    return [Filled(name, values) for name, values in written.items()]


def lost(connection: Connection, filled: Sequence[Filled]) -> Iterator[str]:
    """Yield, in words, what is not there any more of rows that were written before migrations."""
    metadata = MetaData()
    metadata.reflect(connection, only=list(Base.metadata.tables))
    for row in filled:
        table = metadata.tables.get(RENAMED.get(row.table, row.table))
        if table is None:
            yield f"table {row.table}"
            continue
        values = {name: value for name, value in row.values.items() if name in table.columns}
        key = [column for column in table.primary_key if column.name in values]
        if not key:
            yield f"the key of {table.name}"
            continue
        found = connection.execute(
            select(*(table.columns[name] for name in values)).where(
                *(column == values[column.name] for column in key)
            )
        ).one_or_none()
        if found is None:
            yield f"{table.name}: {[values[column.name] for column in key]}"
            continue
        for name, value in zip(values, found, strict=True):
            if value != values[name]:
                yield f"{table.name}.{name}: {values[name]!r} became {value!r}"


def _values(
    table: Table, number: int, written: Mapping[str, Mapping[str, Any]]
) -> Iterator[tuple[str, object]]:
    for column in table.columns:
        if column.computed is not None:
            continue
        target = next(iter(column.foreign_keys), None)
        if target is not None:
            referred, _, name = target.target_fullname.rpartition(".")
            if referred in written:
                yield column.name, written[referred][name]
            elif not column.nullable:
                raise LookupError(f"{table.name}.{column.name}: nothing is in {referred} yet")
            continue
        yield column.name, WORDS.get((table.name, column.name), _value(table, column, number))


def _value(table: Table, column: Column[Any], number: int) -> object:
    """Return a value that the column takes; a word of an enumeration where the models have one."""
    model = Base.metadata.tables.get(RENAMED.get(table.name, table.name))
    known = None if model is None else model.columns.get(column.name)
    if known is not None and isinstance(known.type, Enum):
        return known.type.enums[0]
    kind = column.type
    if isinstance(kind, Boolean):
        return True
    if isinstance(kind, JSON):
        is_list = known is not None and type(known.type).__name__ == "_Items"
        return [1.0, 2.0, 3.0] if is_list else DOCUMENT
    if isinstance(kind, LargeBinary):
        return b"%d" % number
    if isinstance(kind, Integer | BigInteger):
        return 1000 * number  # a migration may number rows of its own from 1
    if isinstance(kind, Float):
        return number / 2
    if isinstance(kind, String):
        word = f"{number:04d} {column.name}"
        return word if kind.length is None else word[: kind.length]
    raise LookupError(f"{table.name}.{column.name}: no value is known for {kind!r}")
