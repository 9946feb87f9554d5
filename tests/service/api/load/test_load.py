"""The load profile over REST, of a day that is counted by hand."""

import time
from dataclasses import replace

import httpx
import pytest

from core.machines.parameters import Connection, ThermalElement
from core.supply.definitions import unbalance_of_magnitudes
from core.units import NANOSECONDS_PER_SECOND
from service.api.load.schemas import load_document
from service.condition.metered_load import motor_load
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.machines.motors import REFERENCE
from testing.service.metered_days import POWER_W, meter_a_day
from testing.service.rotor_and_supply import SUPPLY, ExaminedRecordings

URL = "/api/v1/motors/PUMP-A1/load-profile"


def test_a_day_of_metering(client: httpx.Client, repository: Repository) -> None:
    meter_a_day(repository)

    load = client.get(URL, params={"days": 7}).json()

    assert load["step_s"] == 900
    assert (load["running_hours"], load["standing_hours"]) == (15.0, 6.0)
    assert load["unknown_hours"] == pytest.approx(7 * 24.0 - 21.0)
    assert load["energy_kWh"] == pytest.approx(15.0 * POWER_W / 1000.0)
    assert load["duty"] == pytest.approx(15.0 / 21.0)
    assert load["starts"] == 1  # it stood before the silence, and ran behind it
    used = [one for one in load["classes"] if one["hours"]]
    assert [one["hours"] for one in used] == [15.0]
    plate, machine = REFERENCE.nameplate, REFERENCE.parameters
    assert plate.connection is Connection.STAR
    squares = 3.0 * (POWER_W / (3.0**0.5 * plate.rated_voltage_V * 0.75)) ** 2
    torque = (POWER_W - machine.stator_resistance_ohm * squares) / plate.rated_power_W
    assert used[0]["from_level"] <= torque < used[0]["to_level"]
    assert load["mean_load"] == pytest.approx(torque)


def test_hours_beyond_limits(client: httpx.Client, repository: Repository) -> None:
    meter_a_day(repository)

    limits = {one["name"]: one for one in client.get(URL).json()["limits"]}

    low = limits["voltage below 90 %"]
    assert (low["hours"], low["longest_hours"], low["known_hours"]) == (1.0, 1.0, 21.0)
    assert low["worst"] == pytest.approx(0.88)
    uneven = limits["unbalance above 1 %"]
    assert uneven["hours"] == 1.0
    assert uneven["worst"] == pytest.approx(0.02 / 0.99)
    assert limits["unbalance above 5 %"]["hours"] == 0.0
    assert limits["load above rated"]["known_hours"] == 15.0


def test_hours_of_slow_supply_and_uneven_currents(client: httpx.Client, repository: Repository) -> None:
    meter_a_day(repository, disturbed=True)

    limits = {one["name"]: one for one in client.get(URL).json()["limits"]}

    slow = limits["frequency below 98 %"]
    assert (slow["hours"], slow["known_hours"], slow["worst"]) == (1.0, 21.0, pytest.approx(0.96))
    assert limits["frequency below 95 %"]["hours"] == limits["frequency above 102 %"]["hours"] == 0.0
    currents = limits["current unbalance above 10 %"]
    assert (currents["hours"], currents["known_hours"]) == (1.0, 15.0)
    assert currents["worst"] == pytest.approx(unbalance_of_magnitudes([1.3, 1.0, 1.0]), rel=1e-6)


def test_records_beyond_limits_are_counted_as_records(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    meter_a_day(repository)
    now_ns = time.time_ns()
    recorded = ExaminedRecordings(repository, store)
    for back, factor in ((3600, 0.0085), (7200, 0.025), (40 * 86_400, 0.5)):
        figures = replace(SUPPLY, harmonic_voltage_factor=factor)
        recorded.add(None, figures, at_ns=now_ns - back * NANOSECONDS_PER_SECOND)

    distortion, low, high = client.get(URL).json()["record_limits"]

    assert (low["name"], low["beyond"], low["records"], low["share"]) == ("HVF above 0.02", 1, 2, 0.5)
    assert (low["worst"], high["beyond"]) == (0.025, 0)
    assert (distortion["beyond"], distortion["worst"]) == (0, 0.021)
    assert client.get(URL, params={"days": 90}).json()["record_limits"][2]["beyond"] == 1


def test_heat_lies_between_bounds_that_known_hours_close(
    client: httpx.Client, repository: Repository
) -> None:
    meter_a_day(repository)

    thermal = client.get(URL).json()["thermal"]

    low, high = thermal["winding_rise_K"]
    assert 5.0 < low < high < 80.0
    assert high - low < 25.0
    assert thermal["from_resistance_K"] is None
    assert thermal["reasons"] == ["there are no two records of the same sensors"]


def test_a_motor_of_which_nothing_is_metered(client: httpx.Client, repository: Repository) -> None:
    nothing = client.get("/api/v1/motors/FAN-A2/load-profile").json()
    assert nothing["classes"] == []
    assert nothing["running_hours"] is None

    meter_a_day(repository)
    minutes = client.get(URL, params={"days": 1}).json()
    assert minutes["step_s"] == 60
    assert client.get(URL, params={"days": 91}).status_code == 422
    assert client.get("/api/v1/motors/NOPE/load-profile").status_code == 404


def test_the_relays_thermal_element_by_the_settings_of_the_motors_file(
    client: httpx.Client, repository: Repository
) -> None:
    meter_a_day(repository)
    assert client.get(URL).json()["thermal"]["relay_capacity_used"] is None

    element = ThermalElement(1.15, 6.0, 12.0, running_time_constant_s=1800.0)
    motor = replace(REFERENCE, name="PUMP-A1")
    found = motor_load(repository, motor, days=1, now_ns=time.time_ns(), thermal=element)
    document = load_document(found).thermal
    assert document is not None
    assert document.relay_capacity_used is not None
    low, high = document.relay_capacity_used
    assert 0.05 < low < high < 1.0
