"""Real relays get confused by parallel requests: whatever is to be done at one, it has one at a time."""

from dataclasses import replace
from threading import Thread

import scl
from service.collector.session.relay_session import RelaySession
from service.plant.metering import measurands_from_scl
from service.storage.records import Sample
from service.storage.states import LinkState, RecordingRequestState
from testing.waiting import eventually
from tests.hostile.dialogue import message, tlv
from tests.service.collector.conftest import MOTOR, Bench
from tests.service.collector.outstanding import Outstanding
from tests.service.collector.scripted_relay import NAME, ScriptedRelay

READ, WRITE = b"\xa4", b"\xa5"
FILE_OPEN, FILE_READ, FILE_DIRECTORY = b"\xbf\x48", b"\x9f\x49", b"\xbf\x4d"
RECORDS = 2
RECORD_BYTES = 90_000


def test_a_relay_has_one_request_at_a_time(bench: Bench, relay: ScriptedRelay) -> None:
    """With metering, triggers and pulling under way together, and a request for a report now and then."""
    outstanding = Outstanding()
    samples: list[Sample] = []
    settings = bench.settings.model_copy(update={"metering_period_s": 0.1, "record_timeout_s": 15.0})
    with outstanding.before(relay.port) as port:
        metered = replace(
            bench.relay, port=port, measurands=measurands_from_scl(scl.read(scl.DEMO_PLANT_SCD).ied(NAME))
        )
        session = RelaySession(
            metered, MOTOR, bench.repository, bench.store, settings, on_sample=samples.append
        )
        thread = Thread(target=session.run)
        thread.start()
        try:
            assert eventually(lambda: bench.link() is LinkState.UP)
            for number in range(RECORDS):
                relay.write_record(f"OWN_{number}", bytes(RECORD_BYTES))
                request_id = bench.request()
                session.wake()
                assert bench.reaches(request_id, RecordingRequestState.FETCHED)
            assert eventually(lambda: len(bench.recordings()) == 2 * RECORDS)
        finally:
            session.stop()
            thread.join(15)
    assert len(samples) > 2
    assert outstanding.services.keys() >= {READ, WRITE, FILE_OPEN, FILE_READ, FILE_DIRECTORY}
    assert outstanding.most == 1


def test_requests_without_an_answer_are_counted() -> None:
    """The count itself: a client that does not wait, and every kind of answer."""
    outstanding = Outstanding()
    first, second, third = (
        message(tlv(0xA0, tlv(0x02, bytes([number])) + tlv(0xA4, b""))) for number in (1, 2, 3)
    )
    outstanding.asked(first)
    outstanding.answered(message(tlv(0xA1, tlv(0x02, b"\x01") + tlv(0xA4, b""))))
    assert outstanding.most == 1
    outstanding.asked(second)
    outstanding.answered(message(tlv(0xA3, tlv(0xA0, b""))))  # a report answers nothing
    outstanding.asked(third)
    assert outstanding.most == 2
    outstanding.answered(message(tlv(0xA2, tlv(0x80, b"\x02") + tlv(0xA2, b""))))
    outstanding.answered(message(tlv(0xA4, tlv(0x80, b"\x03") + tlv(0x81, b"\x01"))))
    outstanding.asked(first)
    assert outstanding.most == 2
    assert outstanding.services == {b"\xa4": 4}
