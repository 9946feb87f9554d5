"""Others read what we write: an MMS client and a COMTRADE reader that are not ours."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import comtrade
import numpy as np
import pytest

from core.recordings import read
from mms import Client
from testing.service.processes import SimulatedPlant, simulated_plant
from testing.waiting import eventually
from tests.integration import foreign_client

pytestmark = pytest.mark.timeout(300)
"""The first test starts a simulator."""

RELAY = "A1_SEL710"
TRIGGER = f"{RELAY}CON/RBGGIO1.SPCSO01"


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[SimulatedPlant]:
    """One relay with one record."""
    with simulated_plant(tmp_path_factory.mktemp("plant"), [RELAY]) as simulated:
        address = simulated.address(RELAY)
        with Client.connect(address.host, address.port) as client:
            client.operate(TRIGGER, True)  # noqa: FBT003 - the value of a control
            client.operate(TRIGGER, False)  # noqa: FBT003
        assert eventually(lambda: len(simulated.records()) == 1, 20)
        yield simulated


def record(plant: SimulatedPlant) -> Path:
    (configuration,) = plant.events(RELAY).glob("*.CFG")
    return configuration


def test_the_wheels_own_client_browses_a_relay_and_fetches_a_record(plant: SimulatedPlant) -> None:
    address = plant.address(RELAY)
    data = record(plant).with_suffix(".DAT")
    program = foreign_client.__file__
    answer = subprocess.run(
        [sys.executable, program, address.host, str(address.port), data.name],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert answer.returncode == 0, answer.stderr
    found = json.loads(answer.stdout)
    assert sorted(found["devices"]) == [f"{RELAY}{device}" for device in ("ANN", "CFG", "CON", "MET", "PRO")]
    assert "RBGGIO1" in found["nodes"][f"{RELAY}CON"]
    assert {"RcdMade", "FltNum"} <= set(found["objects"])
    names = {name.rpartition("/")[2] for name in found["events"]}
    assert names == {path.name for path in plant.events(RELAY).iterdir()}
    assert found["fetched_bytes"] == data.stat().st_size


def test_another_reader_reads_the_same_samples(plant: SimulatedPlant) -> None:
    path = record(plant)
    ours = read(path)
    theirs = comtrade.Comtrade(ignore_warnings=True)
    theirs.load(str(path), str(path.with_suffix(".DAT")))
    assert theirs.total_samples == ours.samples.shape[1]
    assert theirs.analog_channel_ids == [channel.name for channel in ours.channels]
    assert theirs.cfg.sample_rates == [[ours.sample_rate_hz, ours.samples.shape[1]]] == [[10_000, 10_000]]
    assert theirs.analog_channel_ids == ["IA", "IB", "IC", "VA", "VB", "VC"]
    for channel, samples in zip(ours.channels, np.array(theirs.analog), strict=True):
        row = ours.samples[ours.channels.index(channel)]
        step = (channel.full_scale or 0) / 32767
        np.testing.assert_allclose(samples, row, atol=step / 100)
    assert theirs.trigger_time == pytest.approx(0.2)
    assert ours.trigger_index == 2_000
