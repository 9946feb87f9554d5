"""The recorded starts of a motor over REST, each beside the reference."""

from dataclasses import replace

import httpx
import pytest

from core.starts.examined import ExaminedStart, StartStress
from core.starts.examining import examine_start
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.machines.motors import LARGE
from testing.machines.starts import StartRecord
from testing.service.starts import START, RecordedStarts

HERE = "/api/v1/motors/PUMP-A1/starts"
STRESS = StartStress(10_000.0, None, 0.03, None, "motor file", 2)


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> RecordedStarts:
    return RecordedStarts(repository, store)


def test_starts_are_told_beside_the_first_ones(client: httpx.Client, recorded: RecordedStarts) -> None:
    ids = [recorded.add(ExaminedStart(START, stress=STRESS)) for _ in range(5)]
    weak = replace(START.curve, voltage_V=tuple(0.88 * one for one in START.curve.voltage_V or ()))
    ids.append(recorded.add(ExaminedStart(replace(START, acceleration_s=1.7, curve=weak), stress=STRESS)))

    latest, *first = client.get(HERE).json()["items"]

    assert [one["recording_id"] for one in (latest, *first)] == ids[::-1]
    assert all(one["is_reference"] and one["comparison"] is None for one in first)
    assert latest["comparison"]["state"] == "changed"
    assert latest["comparison"]["causes"] == ["supply"]
    low, high = latest["comparison"]["changes"]["voltage"]["ci95"]
    assert low < -0.12 < high
    assert (latest["starts_within_hour"], latest["starts_allowed"]) == (6, 2)
    assert latest["share_of_hot_limit"] == 0.03
    assert first[0]["mean_current_A"] == pytest.approx((333.5 / 1.25) ** 0.5)


def test_one_start_has_curves_and_what_the_model_tells(
    client: httpx.Client, recorded: RecordedStarts
) -> None:
    examined = examine_start(StartRecord(snr_db=45.0).of(LARGE), LARGE)
    recording_id = recorded.add(examined)

    found = client.get(f"{HERE}/{recording_id}").json()

    assert examined.torque is not None
    assert found["torque"]["torque_Nm"] == list(examined.torque.torque_Nm)
    assert found["torque"]["speed"][0] is None
    assert set(found["parameters"]["ci95"]) <= set(found["parameters"]["values"])
    assert found["sideband"]["state"] in ("unsupported", "healthy")
    assert found["curve"]["current_A"] == list(examined.figures.curve.current_A)
    assert client.get(f"/api/v1/motors/FAN-A2/starts/{recording_id}").status_code == 404
    assert client.get("/api/v1/motors/NONE/starts").status_code == 404
