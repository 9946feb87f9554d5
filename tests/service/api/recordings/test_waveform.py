import asyncio
from dataclasses import replace

import httpx
import numpy as np
import pytest
from starlette.types import Message, Receive, Scope, Send

from core.recordings import Channel, Quantity, Recording
from core.recordings.envelope import envelope_of
from service.api import ApiContext, create_app
from service.api.limits.admission import Admission
from service.api.problems import BusyError
from service.api.recordings.waveform import Waveform, intervals_within, waveform_json
from service.storage import Repository
from testing.service.plants import NOW_NS
from testing.service.small_record import CFG, DAT
from tests.service.api.serving import serving


def recording(samples: list[list[float]]) -> Recording:
    channels = tuple(Channel(f"I{i}", Quantity.CURRENT, None, "A") for i in range(len(samples)))
    return Recording(np.array(samples, dtype=np.float64), 1000.0, 0, channels)


def document(recording: Recording, points: int, most_values: int = 250_000) -> bytes:
    return b"".join(waveform_json("id", envelope_of(recording, intervals_within(points, most_values))))


def waveform_of(recording: Recording, points: int, most_values: int = 250_000) -> Waveform:
    return Waveform.model_validate_json(document(recording, points, most_values))


def test_no_peak_is_lost() -> None:
    samples = np.zeros(10_007)
    samples[[3, 5_000, 10_006]] = [7.0, -8.0, 9.0]
    waveform = waveform_of(recording([samples.tolist()]), 100)
    (channel,) = waveform.channels
    assert len(waveform.time_s) == len(channel.minimum) == len(channel.maximum) == 100
    assert (channel.maximum[0], channel.maximum[-1], channel.minimum[49]) == (7.0, 9.0, -8.0)
    assert waveform.samples == 10_007


def test_samples_the_recorder_missed_are_null() -> None:
    nan = float("nan")
    missed = recording([[1.0, nan, nan, nan]])
    assert waveform_of(missed, 2).channels[0].minimum == [1.0, None]
    assert b'"maximum":[1,null]' in document(missed, 2)


def test_more_points_than_samples_and_no_samples() -> None:
    few = waveform_of(recording([[1.0, 2.0]]), 2000)
    assert few.time_s == pytest.approx([0.0, 0.001])
    assert waveform_of(recording([[]]), 10).channels[0].minimum == []


def test_many_channels_share_the_values_of_an_answer_and_lose_no_peak() -> None:
    samples = np.zeros((40, 1000))
    samples[np.arange(40), np.arange(40)] = np.arange(1, 41)
    waveform = waveform_of(recording(samples.tolist()), 500, most_values=800)
    assert len(waveform.time_s) == 20
    assert [max(v for v in c.maximum if v is not None) for c in waveform.channels] == list(range(1, 41))
    assert len(waveform_of(recording(samples.tolist()), 500, most_values=1).time_s) == 2


def test_figures_have_seven_digits() -> None:
    waveform = waveform_of(recording([[1234.56789, -1e-12, 3e30]]), 3)
    assert waveform.channels[0].maximum == [1234.568, -1e-12, 3e30]
    assert b"1234.568," in document(recording([[1234.56789, 0.1]]), 2)


@pytest.fixture
def path(context: ApiContext, repository: Repository) -> str:
    stored = context.store.store({"EVENT.CFG": CFG, "EVENT.DAT": DAT})
    added = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS)
    return f"/api/v1/recordings/{added.recording.id}/waveform"


@pytest.mark.parametrize("step", ["waveforms_read", "waveforms_sent"])
def test_more_waveforms_than_the_service_takes_on_are_to_be_asked_for_again(
    context: ApiContext, path: str, step: str
) -> None:
    none_more = replace(context, **{step: Admission("waveforms", 0, wait_s=0.01)})  # type: ignore[arg-type]  # one field
    with serving(create_app(none_more)) as client:
        refused = client.get(path)
        assert refused.status_code == 503
        assert refused.headers["content-type"] == "application/problem+json"
        assert int(refused.headers["retry-after"]) > 0
        assert client.get("/api/v1/motors").status_code == 200


def test_a_waveform_counts_until_it_is_sent(context: ApiContext, path: str) -> None:
    sent = Admission("waveforms", 1, wait_s=0.01)
    refused = []

    async def others() -> None:
        try:
            async with sent.admitted():
                pass
        except BusyError as error:
            refused.append(str(error))

    async def ask() -> int:
        app = create_app(replace(context, waveforms_sent=sent))
        statuses = []

        async def watched(scope: Scope, receive: Receive, send: Send) -> None:
            async def watching(message: Message) -> None:
                await others()
                await send(message)

            await app(scope, receive, watching)

        transport = httpx.ASGITransport(app=watched)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
            for _ in range(2):
                answer = await client.get(path)
                statuses.append(answer.status_code)
                assert len(answer.json()["channels"]) == 2
        assert statuses == [200, 200]
        return len(refused)

    assert asyncio.run(ask()) >= 6
    assert refused[0] == "1 waveforms are under way, and none came to its end in time"
