"""A recording for the screen: as many intervals as there are points to draw, no peak lost."""

import asyncio
import json
from collections.abc import Callable, Iterator, Mapping
from typing import Annotated

import numpy as np
import structlog
from fastapi.responses import StreamingResponse
from numpy.typing import NDArray
from pydantic import Field
from starlette.types import Send
from structlog.typing import FilteringBoundLogger

from core.recordings import Envelope, Quantity
from service.api.document import Document
from service.api.times import Time, rfc3339

log: FilteringBoundLogger = structlog.get_logger(__name__)

MAX_POINTS = 20_000
MAX_CHANNELS = 20_000
"""A record may have so many (core.recordings)."""

SENDING_LIMIT_S = 60.0
"""A client that has not taken its answer by then loses it: its figures are held in memory meanwhile."""

Figures = Annotated[list[float | None], Field(max_length=MAX_POINTS)]


class WaveformChannel(Document):
    """Smallest and largest sample of each interval, in `unit`; null where the recorder missed them all.

    Figures have seven digits.
    """

    name: str
    quantity: Quantity
    phase: str | None
    unit: str
    minimum: Figures
    maximum: Figures


class Waveform(Document):
    """Channels over time; `time_s` is where each interval begins, in seconds after `start_time`."""

    recording_id: str
    start_time: Time
    trigger_time: Time
    sample_rate_hz: float
    samples: int
    time_s: Annotated[list[float], Field(max_length=MAX_POINTS)]
    channels: Annotated[list[WaveformChannel], Field(max_length=MAX_CHANNELS)]


def intervals_within(points: int, most_values: int) -> Callable[[int, int], int]:
    """Return how many intervals a recording gets: `points`, or fewer where it has many channels.

    most_values: most intervals of all channels together.
    """

    def intervals_of(channels: int, samples: int) -> int:
        return min(points, samples, max(2, most_values // max(1, channels)))

    return intervals_of


def waveform_json(recording_id: str, envelope: Envelope) -> Iterator[bytes]:
    """Return the document `Waveform` piece by piece, one a channel: the whole of it is never in memory."""
    head = {
        "recording_id": recording_id,
        "start_time": rfc3339(envelope.start_time_ns),
        "trigger_time": rfc3339(envelope.trigger_time_ns),
        "sample_rate_hz": envelope.sample_rate_hz,
        "samples": envelope.samples,
        "time_s": envelope.times_s.tolist(),
    }
    yield _compact(head).removesuffix("}").encode() + b',"channels":['
    for row, channel in enumerate(envelope.channels):
        about = {
            "name": channel.name,
            "quantity": channel.quantity,
            "phase": channel.phase,
            "unit": channel.unit,
        }
        lowest, highest = _figures(envelope.lowest[row]), _figures(envelope.highest[row])
        text = f'{_compact(about).removesuffix("}")},"minimum":[{lowest}],"maximum":[{highest}]}}'
        yield (text if row == 0 else f",{text}").encode()
    yield b"]}"


class WaveformResponse(StreamingResponse):
    """A waveform on its way to a client that may be slow, but not for ever."""

    def __init__(self, recording_id: str, envelope: Envelope) -> None:
        super().__init__(waveform_json(recording_id, envelope), media_type="application/json")

    async def stream_response(self, send: Send) -> None:
        try:
            async with asyncio.timeout(SENDING_LIMIT_S):
                await super().stream_response(send)
        except TimeoutError:
            log.warning("a client was too slow to take its waveform", limit_s=SENDING_LIMIT_S)


def _compact(part: Mapping[str, object]) -> str:
    return json.dumps(part, separators=(",", ":"), allow_nan=False)


def _figures(values: NDArray[np.float64]) -> str:
    """Return the values as the inside of a JSON list, with null for NaN, which JSON does not know."""
    return ",".join(map("{:.7g}".format, values.tolist())).replace("nan", "null")
