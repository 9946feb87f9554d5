"""Transactions, and the step from table rows to plain values."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from copy import copy
from dataclasses import fields
from typing import TYPE_CHECKING, Any, Self, TypeVar

from sqlalchemy import ColumnElement, Engine, Row, Select, func, select, text, tuple_
from sqlalchemy.orm import InstrumentedAttribute, Session

from service.storage.engine import WRITES, busy_timeout_s_of
from service.storage.errors import NotFoundError
from service.storage.models import Base, IedRow, MotorRow
from service.storage.records import Cursor, Page
from service.storage.repository.bounded_session import BoundedSession
from service.storage.repository.counting_session import CountingSession
from service.storage.repository.nearest_name import nearest_name
from service.storage.repository.turns import Turns

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    Record = TypeVar("Record", bound=DataclassInstance)

Table = TypeVar("Table", bound=Base)
Item = TypeVar("Item")
Order = Sequence[InstrumentedAttribute[str] | InstrumentedAttribute[int]]

NONE_HELD: Mapping[str, Any] = {"synchronize_session": False}
"""Options of a statement that changes rows of which the session holds no objects: none are looked for."""

NAMES: Mapping[type[Base], InstrumentedAttribute[str]] = {MotorRow: MotorRow.name, IedRow: IedRow.name}
"""People type the keys of these tables, and may misspell them."""


class Sessions:
    """What every part of the repository stands on."""

    def __init__(self, engine: Engine) -> None:
        self._reading = engine
        self._writing = engine.execution_options(**{WRITES: True})
        self._busy_timeout_s = busy_timeout_s_of(engine.get_execution_options())
        self._turns = Turns(self._busy_timeout_s) if engine.dialect.name == "sqlite" else None
        self._sites: Collection[str] | None = None

    def within(self, sites: Collection[str] | None) -> Self:
        """Return the same repository for who may see these sites alone; None: all of them.

        What is read is bounded. What is written is not, because writers look at all rows to keep them right:
        whoever lets somebody write asks before whether it is at one of their sites.
        """
        bounded = copy(self)
        bounded._sites = sites  # noqa: SLF001 - the copy is ours
        return bounded

    def check(self) -> None:
        """Make one round trip to the database. Raises SQLAlchemyError when it does not answer."""
        with self._read() as session:
            session.execute(text("SELECT 1"))

    @contextmanager
    def _read(self) -> Iterator[Session]:
        sites = self._sites
        with Session(self._reading) if sites is None else BoundedSession(self._reading, sites) as session:
            yield session

    @contextmanager
    def _write(self, *, ahead: bool = False) -> Iterator[Session]:
        """Begin a transaction that writes.

        ahead: before the other threads of this process that wait for their turn.
        Raises sqlalchemy.exc.TimeoutError.
        """
        with self._own_turn(ahead=ahead), CountingSession(self._writing) as session, session.begin():
            yield session

    def _own_turn(self, *, ahead: bool) -> AbstractContextManager[None]:
        """Wait for this thread's turn to write, where the database is SQLite.

        SQLite has one writer, and who waits for it looks again now and then, whoever was there first. So
        threads of a process take turns before: the next one goes on at once.
        """
        return nullcontext() if self._turns is None else self._turns.one(ahead=ahead)


def found(session: Session, row_type: type[Table], key: str, kind: str, *, lock: bool = False) -> Table:
    """Return the row of this key. Raises NotFoundError.

    lock: other writers that ask for the same wait until this transaction has ended, and see what it did.
    On PostgreSQL only; SQLite lets one write at a time anyway, and a row that was read is not read again.
    """
    is_locked = lock and session.get_bind().dialect.name != "sqlite"
    row = session.get(row_type, key, with_for_update={"key_share": True} if is_locked else None)
    if row is None:
        nearest = nearest_name(session, NAMES[row_type], key) if row_type in NAMES else None
        raise NotFoundError(kind, key, nearest=nearest)
    return row


def record_of(record_type: "type[Record]", row: Base) -> "Record":
    """Return the dataclass whose fields are columns of the row, by name."""
    return record_type(**{field.name: getattr(row, field.name) for field in fields(record_type)})


def values_of(record: "DataclassInstance") -> dict[str, Any]:
    """Return the fields of a record by name. What they hold is not copied, as `asdict` would."""
    return {field.name: getattr(record, field.name) for field in fields(record)}


def columns_of(
    record_type: "type[DataclassInstance]", row_type: type[Base]
) -> list[InstrumentedAttribute[Any]]:
    """Return the columns of a table that a record has, in the order of its fields.

    `record_type(*row)` makes the record. To read a thousand rows of columns takes a fourth of the time of a
    thousand objects, and leaves out what the record does not have.
    """
    return [getattr(row_type, field.name) for field in fields(record_type)]


def rows_of(session: Session, query: Select[*tuple[Any, ...]]) -> Sequence[Row[*tuple[Any, ...]]]:
    """Return the rows of a query.

    Rows of columns come from the connection. The session would look in each for objects to make, which takes
    longer than the database does: a thousand rows of eight columns come in half the time.
    """
    has_objects = any(isinstance(one["type"], type) for one in query.column_descriptions)
    is_whole = has_objects or isinstance(session, BoundedSession)  # a connection knows no bounds
    return (session if is_whole else session.connection()).execute(query).all()


def page_of(
    session: Session,
    query: Select[*tuple[Any, ...]],
    order: Order,
    to_item: Callable[..., Item],
    *,
    limit: int,
    after: Cursor | None,
    descending: bool = False,
) -> Page[Item]:
    """Return one page of `query` in the order of unique `order` columns, from behind the sort key `after`.

    It uses keys, not offsets: rows that come or go meanwhile neither repeat nor hide others.

    to_item: takes what the query selects, one argument each.
    """
    if after is not None:
        position: ColumnElement[bool] = (
            tuple_(*order) < tuple_(*after) if descending else tuple_(*order) > tuple_(*after)
        )
        query = query.where(position)
    query = query.order_by(*(column.desc() if descending else column.asc() for column in order))
    rows = rows_of(session, query.add_columns(*order).limit(limit + 1))
    last = rows[limit - 1] if len(rows) > limit else None
    width = len(order)
    return Page(
        items=tuple(to_item(*row[:-width]) for row in rows[:limit]),
        next=None if last is None else tuple(last[-width:]),
    )


def latest_of(
    session: Session,
    query: Select[*tuple[Any, ...]],
    order: Order,
    to_item: Callable[..., Item],
    *,
    limit: int,
) -> tuple[Item, ...]:
    """Return the last items of `query` in the order of unique `order` columns, in that order.

    to_item: takes what the query selects, one argument each.
    """
    last = query.order_by(*(column.desc() for column in order)).limit(limit)
    return tuple(to_item(*row) for row in reversed(rows_of(session, last)))


def within(
    time: InstrumentedAttribute[int], from_ns: int | None, to_ns: int | None
) -> list[ColumnElement[bool]]:
    """Return the conditions that from_ns <= time < to_ns; an end that is None is open."""
    conditions = []
    if from_ns is not None:
        conditions.append(time >= from_ns)
    if to_ns is not None:
        conditions.append(time < to_ns)
    return conditions


def has_as_many(session: Session, query: Select[str], most: int) -> bool:
    """Return whether a query finds at least so many rows; what is beyond is not counted."""
    number = session.scalar(select(func.count()).select_from(query.limit(most).subquery()))
    return number is not None and number >= most


def only(session: Session, query: Select[Table]) -> Table | None:
    """Return the first row of a query, None without one."""
    return session.scalars(query.limit(1)).first()
