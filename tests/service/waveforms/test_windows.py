"""Windows of samples: what is in them, and how they go to a browser."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from core.machines.parameters import ChannelNames, Transformers
from core.recordings import Channel, Digitals, Quantity, Recording
from core.recordings.comtrade.writer import write
from service.waveforms.opened import Group, Opened, opened, shown_channels
from service.waveforms.states import timelines
from service.waveforms.windows import encoded, window_of
from testing.machines.motors import REFERENCE

Array = NDArray[Any]
RATE = 1000.0


def of_samples(samples: Array, **others: Any) -> Opened:
    """Return a recording of currents."""
    channels = tuple(Channel(f"I{k}", Quantity.CURRENT, None, "A") for k in range(len(samples)))
    recording = Recording(samples, RATE, 0, channels, **others)
    return Opened(recording, None, shown_channels(channels, None))


def decoded(content: bytes) -> tuple[dict[str, Any], list[Array]]:
    """Read what the browser reads."""
    length = int.from_bytes(content[:4], "little")
    head = json.loads(content[4 : 4 + length])
    figures = np.frombuffer(content[4 + length :], "<f4").reshape(len(head["columns"]), head["count"])
    return head, list(figures)


def test_few_samples_are_given_as_they_are() -> None:
    samples = np.array([[1.0, np.nan, 3.0, -4.5], [0.0, 0.5, 0.25, 1e-3]])
    head, (times, first, second) = decoded(encoded(window_of(of_samples(samples), 10)))
    assert (head["count"], head["samples"]) == (4, 4)
    assert [one["of"] for one in head["columns"]] == ["time", "value", "value"]
    np.testing.assert_allclose(times, [0, 0.001, 0.002, 0.003])
    np.testing.assert_array_equal(first, np.array([1.0, np.nan, 3.0, -4.5], np.float32))
    np.testing.assert_array_equal(second, samples[1].astype(np.float32))


def test_of_many_samples_no_extreme_is_lost() -> None:
    samples = np.sin(np.arange(60_000) / 7.0)[np.newaxis].repeat(6, axis=0)
    samples[2, 12_345], samples[5, 54_321] = 9.0, -9.0
    head, columns = decoded(encoded(window_of(of_samples(samples), 800)))
    assert (head["count"], head["samples"]) == (800, 60_000)
    assert [one["of"] for one in head["columns"][1:3]] == ["minimum", "maximum"]
    assert columns[1 + 2 * 2 + 1].max() == 9.0
    assert columns[1 + 2 * 5].min() == -9.0
    assert len(encoded(window_of(of_samples(samples), 800))) < 50_000


def test_a_part_has_the_samples_that_cover_it_and_at_least_two() -> None:
    samples = np.arange(1000.0)[np.newaxis]
    part = window_of(of_samples(samples), 100, 0.1004, 0.1101)
    assert (part.first_s, part.last_s, part.samples) == (0.1, 0.111, 12)
    np.testing.assert_array_equal(part.channels[0].lowest, np.arange(100.0, 112.0))
    for from_s, to_s in ((0.5, 0.5), (5.0, 6.0), (-3.0, -2.0), (0.7, 0.2)):
        assert window_of(of_samples(samples), 100, from_s, to_s).samples >= 2


def test_uneven_instants_and_no_samples_at_all() -> None:
    uneven = of_samples(np.arange(4.0)[np.newaxis], instants_s=np.array([0.0, 0.001, 0.5, 0.501]))
    np.testing.assert_array_equal(window_of(uneven, 9, 0.4, 0.6).times_s, [0.001, 0.5, 0.501])
    head, columns = decoded(encoded(window_of(of_samples(np.zeros((1, 0))), 9)))
    assert head["count"] == 0
    assert all(column.size == 0 for column in columns)


def test_channels_are_grouped_and_scaled_as_the_motor_s_file_says(tmp_path: Path) -> None:
    names = ("I1", "I2", "I3", "U12", "U23", "U31", "TEMP")
    units = ("A",) * 3 + ("V",) * 3 + ("degC",)
    channels = tuple(
        Channel(name, Quantity.OTHER, None, unit, 100.0) for name, unit in zip(names, units, strict=True)
    )
    recording = Recording(np.ones((7, 50)), RATE, 0, channels)
    motor = replace(
        REFERENCE,
        channels=ChannelNames(currents=("I3", "I2", "I1"), line_voltages=("U12", "U23", "U31")),
        transformers=Transformers(voltage_ratio=None, current_ratio=50.0),
    )
    shown = opened(write(tmp_path / "ONE", recording), motor)
    by_name = {one.name: one for one in shown.channels}
    assert by_name["I1"].phase == "c"
    assert by_name["U23"].phase == "bc"
    assert by_name["TEMP"].group is Group.OTHERS
    assert shown.values(by_name["I1"], 0, 2) == pytest.approx([50.0, 50.0], rel=2e-3)
    assert shown.values(by_name["U12"], 0, 2) == pytest.approx([1.0, 1.0], rel=2e-3)


def test_states_are_told_by_their_changes() -> None:
    states = np.zeros((1000, 3), dtype=np.bool_)
    states[100:200, 1] = True
    states[:, 2] = True
    digitals = Digitals.of(("52A", "50P1", "IN</b>"), states)
    shown = of_samples(np.zeros((1, 1000)), digitals=digitals)
    still, pulse, closed = timelines(shown)
    assert (still.begins_with, still.changes_s) == (False, ())
    assert pulse.changes_s == (0.1, 0.2)
    assert [pulse.at(t) for t in (0.05, 0.15, 0.25)] == [False, True, False]
    assert (closed.begins_with, closed.changes_s) == (True, ())
    bouncing = np.arange(5000)[:, np.newaxis] % 2 == 1
    one = of_samples(np.zeros((1, 5000)), digitals=Digitals.of(("R",), bouncing))
    assert timelines(one)[0].is_cut
