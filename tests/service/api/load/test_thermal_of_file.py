"""The relay's thermal element (49), from the table [motor.thermal] of a file to API, page and command."""

from pathlib import Path

import pytest

import scl
from service.api import ApiContext
from service.cli.app import main
from service.configuration.settings import Settings
from service.demo import MOTORS
from service.plant import read_plant
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.web.app import create_site
from testing.service.metered_days import POWER_W, meter_a_day
from testing.service.plants import motor
from tests.service.api.serving import serving

SERVICE_FACTOR, FULL_LOAD_A = 1.15, 2.0
THERMAL = f"""
[motor.thermal]
service_factor = {SERVICE_FACTOR}
locked_rotor_current = 6.0
locked_rotor_hot_s = 12.0
running_time_constant_s = 1800.0
full_load_current_A = {FULL_LOAD_A}

[[motor]]
name = "FAN-A2"
"""


def test_the_element_that_the_motors_file_tells_is_told_everywhere(
    repository: Repository, store: RecordingStore, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """After hours at one current it has settled at the square of that over what trips it.

    The bounds leave room for the latest minutes, of which there are no means yet.
    """
    motors = tmp_path / "motors.toml"
    motors.write_text(MOTORS.read_text().replace('\n[[motor]]\nname = "FAN-A2"\n', THERMAL))
    settings = Settings(scd=scl.DEMO_PLANT_SCD, motors=motors, data_directory=tmp_path)
    plant = read_plant(settings)
    known = {one.name: one.motor for one in plant.motors}
    repository.sync_plant(plant)
    meter_a_day(repository)
    current_A = POWER_W / (3.0**0.5 * motor("PUMP-A1").nameplate.rated_voltage_V * 0.75)
    settled = (current_A / (SERVICE_FACTOR * FULL_LOAD_A)) ** 2

    with serving(create_site(ApiContext(settings, repository, store, motors=known))) as client:
        thermal = client.get("/api/v1/motors/PUMP-A1/load-profile").json()["thermal"]
        page = client.get("/motors/PUMP-A1/load", headers={"Accept": "text/html"}).text
        assert main(["load", "PUMP-A1", "--url", str(client.base_url)]) == 0
        meter_a_day(repository, "FAN-A2")
        fan = client.get("/api/v1/motors/FAN-A2/load-profile").json()["thermal"]

    low, high = thermal["relay_capacity_used"]
    assert 0.95 * settled < low < settled < high < 1.2 * settled
    assert fan["relay_capacity_used"] is None
    words = f"{100 * low:.0f} to {100 * high:.0f} %"
    assert words in page
    assert "of what trips it (49)" in page
    assert f"{words} of what trips it" in " ".join(capsys.readouterr().out.split())
