"""However reports are lost, the directory tells: every record comes, and the link says what was lost."""

from service.storage.states import LinkState
from testing.waiting import eventually
from tests.service.collector.conftest import Bench
from tests.service.collector.scripted_relay import NAME, RECORD_MADE, ScriptedRelay


def gaps(bench: Bench) -> int:
    return bench.repository.link_figures(NAME).report_gaps


def test_a_gap_in_the_relay_s_count_of_records(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.with_settings(poll_period_s=2.0).session():
        assert eventually(lambda: bench.link() is LinkState.UP)
        relay.write_record("HR_1")
        assert eventually(lambda: bench.is_stored("HR_1"))
        relay.write_record("HR_2", report=False)
        relay.write_record("HR_3")
        assert eventually(lambda: bench.is_stored("HR_2") and bench.is_stored("HR_3"))
        assert eventually(lambda: gaps(bench) == 1)


def test_a_buffer_that_overflowed_while_nobody_listened(bench: Bench, relay: ScriptedRelay) -> None:
    with bench.session():
        relay.write_record("HR_1")
        assert eventually(lambda: bench.repository.entry_id(NAME) is not None)
    for number in range(2, 5):
        relay.write_record(f"HR_{number}")
    for _ in range(1500):
        relay.server.update_many({f"{RECORD_MADE}.stVal": False})
        relay.server.update_many({f"{RECORD_MADE}.stVal": True})
    with bench.session():
        assert eventually(lambda: all(bench.is_stored(f"HR_{number}") for number in range(2, 5)))
        assert eventually(lambda: gaps(bench) >= 1)


def test_a_relay_that_restarted_with_a_record_made_meanwhile(bench: Bench) -> None:
    relay = bench.start_relay()
    try:
        with bench.session():
            relay.write_record("HR_1")
            assert eventually(lambda: bench.repository.entry_id(NAME) is not None)
            relay.stop()
            relay.write_file("HR_2.DAT", b"while it was off")
            relay.write_file("HR_2.CFG", b"or before anybody listened")
            relay = bench.start_relay()
            assert eventually(lambda: bench.is_stored("HR_2"))
            assert eventually(lambda: gaps(bench) == 1), "its buffer began anew"
    finally:
        relay.stop()
