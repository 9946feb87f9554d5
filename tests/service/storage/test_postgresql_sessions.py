"""On PostgreSQL a transaction ends that stands still, and nobody waits for a lock without end."""

from collections.abc import Iterator, MutableMapping
from pathlib import Path
from typing import Any

import pytest
import structlog
from sqlalchemy import Engine, text
from sqlalchemy.exc import OperationalError

from service.configuration.settings import Settings
from service.storage import connect
from service.storage.postgresql_sessions import parameters
from service.storage.transaction_limits import TransactionLimits, limits_of
from service.timing.database_silence import does_not_answer
from testing.waiting import wait_until

LIMITS = TransactionLimits(idle_s=0.5, lock_wait_s=0.3)
OPEN = text("SELECT count(*) FROM pg_stat_activity WHERE pid = :pid")


@pytest.fixture
def limited(postgresql_url: str) -> Iterator[Engine]:
    """Connections with short limits, and a table of one row."""
    engine = connect(postgresql_url, limits=LIMITS)
    with engine.begin() as connection:
        connection.exec_driver_sql("CREATE TABLE kept (number integer)")
        connection.exec_driver_sql("INSERT INTO kept VALUES (1)")
    yield engine
    engine.dispose()


def test_a_transaction_that_stands_still_is_ended_and_told(limited: Engine, postgresql_url: str) -> None:
    watching = connect(postgresql_url).execution_options(isolation_level="AUTOCOMMIT")
    told: list[MutableMapping[str, Any]]
    with structlog.testing.capture_logs() as told, limited.connect() as still:
        pid = still.scalar(text("SELECT pg_backend_pid()"))
        still.exec_driver_sql("UPDATE kept SET number = 2")
        with watching.connect() as looking:
            wait_until(lambda: not looking.scalar(OPEN, {"pid": pid}), "the server to end the transaction")
            looking.exec_driver_sql("UPDATE kept SET number = number + 10")  # the lock is free
        with pytest.raises(OperationalError) as lost:
            still.exec_driver_sql("UPDATE kept SET number = 3")
    watching.dispose()
    assert does_not_answer(lost.value), "so whoever asked tries again"
    (line,) = told
    assert line["event"].startswith("this process stood still inside a transaction")
    with limited.begin() as again:
        assert again.scalar(text("SELECT number FROM kept")) == 11


def test_a_lock_is_waited_for_no_longer_than_said(limited: Engine, postgresql_url: str) -> None:
    others = connect(postgresql_url, limits=None)
    with others.begin() as forgotten, limited.begin() as waiting:
        forgotten.exec_driver_sql("UPDATE kept SET number = 2")
        with pytest.raises(OperationalError, match="lock timeout") as late:
            waiting.exec_driver_sql("UPDATE kept SET number = 3")
        assert does_not_answer(late.value), "so whoever asked tries again"
    others.dispose()
    with limited.begin() as again:
        assert again.scalar(text("SELECT number FROM kept")) == 2


def test_what_the_url_says_counts() -> None:
    made = parameters({"options": "-c lock_timeout=7", "connect_timeout": "3"}, LIMITS)
    assert str(made["options"]).endswith(
        "-c idle_in_transaction_session_timeout=500 -c lock_timeout=300 -c lock_timeout=7"
    )
    assert made["connect_timeout"] == "3"


def test_work_without_limits_has_none() -> None:
    made = str(parameters({}, None)["options"])
    assert "tcp_keepalives_idle" in made
    assert not any(limit in made for limit in ("lock_timeout", "idle_in_transaction_session_timeout"))


def test_the_limits_follow_from_the_lease_where_they_are_not_set(tmp_path: Path) -> None:
    assert limits_of(Settings(data_directory=tmp_path)) == TransactionLimits(10.0, 15.0)
    settings = Settings(data_directory=tmp_path, lease_s=6.0, transaction_idle_s=1.0)
    assert limits_of(settings) == TransactionLimits(1.0, 3.0)
