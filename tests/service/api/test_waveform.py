import numpy as np
import pytest

from core.recordings import Channel, Quantity, Recording
from service.api.waveform import waveform_of


def recording(samples: list[list[float]]) -> Recording:
    channels = tuple(Channel(f"I{i}", Quantity.CURRENT, None, "A") for i in range(len(samples)))
    return Recording(np.array(samples, dtype=np.float64), 1000.0, 0, channels)


def test_no_peak_is_lost() -> None:
    samples = np.zeros(10_007)
    samples[[3, 5_000, 10_006]] = [7.0, -8.0, 9.0]
    waveform = waveform_of("id", recording([samples.tolist()]), 100)
    (channel,) = waveform.channels
    assert len(waveform.time_s) == len(channel.minimum) == len(channel.maximum) == 100
    assert (channel.maximum[0], channel.maximum[-1], channel.minimum[49]) == (7.0, 9.0, -8.0)
    assert waveform.samples == 10_007


def test_samples_the_recorder_missed_are_null() -> None:
    nan = float("nan")
    waveform = waveform_of("id", recording([[1.0, nan, nan, nan]]), 2)
    assert waveform.channels[0].minimum == [1.0, None]
    assert '"maximum":[1.0,null]' in waveform.model_dump_json()


def test_more_points_than_samples_and_no_samples() -> None:
    few = waveform_of("id", recording([[1.0, 2.0]]), 2000)
    assert few.time_s == pytest.approx([0.0, 0.001])
    assert waveform_of("id", recording([[]]), 10).channels[0].minimum == []
