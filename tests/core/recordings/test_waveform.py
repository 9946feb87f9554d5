import numpy as np
import pytest

from core.recordings import Channel, Digitals, Quantity, Recording

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


def test_states_are_packed_and_found_by_name() -> None:
    states = np.random.default_rng(1).random((50, 19)) > 0.5
    digitals = Digitals.of(tuple(f"RB{k}" for k in range(19)), states)
    assert digitals.packed.shape == (50, 3)
    np.testing.assert_array_equal(digitals.unpacked(), states)
    np.testing.assert_array_equal(digitals.state("RB17"), states[:, 17])
    for absent in ("RB19", ""):
        with pytest.raises(KeyError):
            digitals.state(absent)
    with pytest.raises(KeyError):
        Digitals.of(("A", "A"), states[:, :2]).state("A")


def test_everything_beside_the_samples_has_their_number() -> None:
    with pytest.raises(ValueError, match="2 states cannot be packed"):
        Digitals(("A", "B"), np.zeros((5, 2), np.uint8))
    with pytest.raises(ValueError, match="4 states beside 5 samples"):
        Recording(np.zeros((1, 5)), 1.0, 0, (IA,), digitals=Digitals.of(("A",), np.zeros((4, 1), bool)))
    with pytest.raises(ValueError, match="5 samples need as many instants"):
        Recording(np.zeros((1, 5)), 1.0, 0, (IA,), instants_s=np.arange(4.0))


def test_times_of_unevenly_spaced_samples() -> None:
    instants = np.array([0, 0.1, 0.2, 0.7, 0.8])
    recording = Recording(np.zeros((1, 5)), 10.0, 10**18, (IA,), trigger_index=3, instants_s=instants)
    assert recording.duration_s == pytest.approx(0.9)
    assert recording.trigger_time_ns == 10**18 + 700_000_000
    assert recording.time_s is instants
    alone = Recording(np.zeros((1, 1)), 10.0, 0, (IA,), instants_s=np.zeros(1))
    assert alone.duration_s == pytest.approx(0.1)
