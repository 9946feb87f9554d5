"""Connections that come and go leave nothing behind.

benchmarks/collector/connection_cycles.py makes a thousand of them.
"""

from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.collector.connection_cycles import Visits, closed_by_the_client, cut, grown, unanswered
from testing.relays.serving import Relaying, RelayProcess, mute_server

pytestmark = pytest.mark.timeout(300)


@pytest.fixture
def relay_port(tmp_path: Path) -> Iterator[int]:
    (tmp_path / "relay" / "EVENTS").mkdir(parents=True)
    process = RelayProcess(tmp_path / "relay")
    yield process.port
    process.end()


def test_clients_leave_no_thread_and_no_descriptor(relay_port: int) -> None:
    growth = grown(lambda: closed_by_the_client(relay_port), 100)
    assert growth.is_none, growth


def test_connections_that_are_cut_leave_nothing(relay_port: int) -> None:
    cutting = Relaying(relay_port, cuts=1_000_000, after_messages=6)
    growth = grown(lambda: cut(cutting.port), 20)
    cutting.close()
    assert growth.is_none, growth


def test_associations_nobody_answers_leave_nothing() -> None:
    with mute_server() as port:
        growth = grown(lambda: unanswered(port), 20)
    assert growth.is_none, growth


def test_sessions_leave_nothing(relay_port: int, tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    visits = Visits.of(tmp_path / "data", relay_port)
    growth = grown(visits.visit, 15)
    assert growth.is_none, growth
