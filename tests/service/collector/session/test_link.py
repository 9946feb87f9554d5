"""The history and the figures of a link."""

import time

import pytest

from service.storage.states import LinkState
from testing.service.links import set_link_state
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME, ScriptedRelay


def changes(bench: Bench) -> list[LinkState]:
    """Oldest first."""
    return [change.state for change in bench.repository.link_changes(NAME, limit=100).items][::-1]


def test_a_link_tells_what_went_over_it(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_record("HR_1", b"x" * 5000)
        assert eventually(lambda: bench.is_stored("HR_1"))
        assert eventually(lambda: bench.repository.link_figures(NAME).received_bytes > 0)
    figures = bench.repository.link_figures(NAME)
    assert figures.received_bytes == 5000 + len(b"configuration of HR_1")
    assert figures.connections == 1
    assert figures.reports >= 1
    assert figures.report_gaps == 0
    assert figures.round_trip_s is not None
    assert 0 < figures.round_trip_s < bench.settings.request_timeout_s


def test_a_link_that_stays_up_says_so_again(
    bench: Bench, relay: ScriptedRelay, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another host may say late that the gateway is gone; nobody else would say otherwise."""
    monkeypatch.setattr("service.collector.session.link.STATE_PERIOD_S", 0.2)
    with bench.with_settings(metering_period_s=0.2).session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        set_link_state(bench.repository, NAME, LinkState.UNKNOWN, "said late", now_ns=time.time_ns())
        assert eventually(lambda: bench.link() is LinkState.UP)
    assert bench.repository.link_figures(NAME).connections == 1


def test_a_link_s_changes_are_kept_with_their_reasons(bench: Bench) -> None:
    with bench.session():
        assert eventually(lambda: bench.link() is LinkState.DOWN)
        relay = bench.start_relay()
        assert eventually(lambda: bench.link() is LinkState.UP, within_s=15)
        relay.stop()
        assert eventually(lambda: bench.link() is LinkState.DOWN)
    history = bench.repository.link_changes(NAME, limit=100).items
    assert [state for state in changes(bench) if state is LinkState.UP] == [LinkState.UP]
    assert changes(bench)[0] is changes(bench)[-1] is LinkState.DOWN
    assert all((change.reason is None) == (change.state is LinkState.UP) for change in history)
    assert str(bench.relay.port) in (history[-1].reason or "")
