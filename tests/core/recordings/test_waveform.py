import numpy as np
import pytest

from core.recordings import Channel, Quantity, Recording

IA = Channel("IA", Quantity.CURRENT, "a", "A")


def test_times_follow_from_the_rate() -> None:
    recording = Recording(np.zeros((1, 500)), 1_000.0, 10**18, (IA,), trigger_index=250)
    assert recording.duration_s == 0.5
    assert recording.trigger_time_ns == 10**18 + 250_000_000


def test_without_a_trigger_the_first_sample_stands_for_it() -> None:
    assert Recording(np.zeros((1, 500)), 1_000.0, 10**18, (IA,)).trigger_time_ns == 10**18


def test_every_channel_has_its_row() -> None:
    with pytest.raises(ValueError, match="1 channels, array of shape"):
        Recording(np.zeros((2, 500)), 1_000.0, 0, (IA,))
