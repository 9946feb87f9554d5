"""What a connection to PostgreSQL asks of the server and the network, and what is told where it is ended."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import structlog
from sqlalchemy import Engine, event
from sqlalchemy.engine import ExceptionContext
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.exc import OperationalError
from sqlalchemy.pool import ConnectionPoolEntry

from service.storage.transaction_limits import TransactionLimits

if TYPE_CHECKING:
    from psycopg.errors import Diagnostic

log = structlog.get_logger(__name__)

PARAMETERS: Mapping[str, str] = {
    # Without it, texts of a database of no encoding (SQL_ASCII, where a server has no locale) are bytes.
    "client_encoding": "utf8",
    "connect_timeout": "10",
    "keepalives_idle": "10",
    "keepalives_interval": "5",
    "keepalives_count": "3",
    "tcp_user_timeout": "25000",
}
"""Parameters of libpq, where the URL does not say others.

A server that is cut off without a word is given up after 25 s, not after hours. Times are in s, the last
one is in ms."""

SERVER_SETTINGS: Mapping[str, str] = {
    "tcp_keepalives_idle": "10",
    "tcp_keepalives_interval": "5",
    "tcp_keepalives_count": "3",
    "tcp_user_timeout": "25000",
}
"""The same the other way: the server keeps no connection of a host that is gone, of which it has so many."""

IDLE_IN_TRANSACTION = "25P03"
"""SQLSTATE of a connection that the server has ended as its transaction stood still."""

STOOD_STILL = (
    "this process stood still inside a transaction: the database ended it, none of its changes are kept"
)


def parameters(
    asked: Mapping[str, str | Sequence[str]], limits: TransactionLimits | None
) -> dict[str, str | Sequence[str]]:
    """Return all parameters of a connection: those that the URL asks for, and ours where it does not.

    limits: of transactions; None for none. What the URL's own `options` say of them counts.
    """
    settings = dict(SERVER_SETTINGS)
    if limits is not None:
        settings["idle_in_transaction_session_timeout"] = _milliseconds(limits.idle_s)
        settings["lock_timeout"] = _milliseconds(limits.lock_wait_s)
    of_url = asked.get("options", "")
    options = [f"-c {name}={value}" for name, value in settings.items()]
    options += [of_url] if isinstance(of_url, str) else of_url
    return {**PARAMETERS, **asked, "options": " ".join(options).strip()}


def tell_of_ends(engine: Engine) -> None:
    """Have the log say where the server ends a transaction in which this process stood still.

    The server's word comes as the answer to the next statement, or behind that to an earlier one.
    """
    event.listen(engine, "connect", _listen_for_end)
    event.listen(engine, "handle_error", _as_lost_connection)


def _listen_for_end(connection: DBAPIConnection, entry: ConnectionPoolEntry) -> None:
    import psycopg

    del connection
    driver = entry.driver_connection
    assert isinstance(driver, psycopg.Connection)  # noqa: S101 - `connect` knows no other driver
    driver.add_notice_handler(_told)


def _told(notice: "Diagnostic") -> None:
    if notice.sqlstate == IDLE_IN_TRANSACTION:
        log.warning(STOOD_STILL)


def _as_lost_connection(context: ExceptionContext) -> Exception | None:
    """Take a transaction that was ended for a lost connection, after which another attempt may succeed.

    The driver takes it for an internal error.
    """
    error = context.original_exception
    if getattr(error, "sqlstate", None) != IDLE_IN_TRANSACTION:
        return None
    log.warning(STOOD_STILL)
    return OperationalError(context.statement, context.parameters, error, connection_invalidated=True)


def _milliseconds(seconds: float) -> str:
    """Return a time as the server takes it: 0 would mean without end."""
    return str(max(1, round(seconds * 1000)))
