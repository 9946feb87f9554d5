"""A host or a file that is not as it should be: one line says what and where."""

import os
from pathlib import Path

import pytest

import scl
from scl.demo_enterprise import write_demo_enterprise
from service.application.serve import ServeError, require_writable
from service.configuration.settings import Settings
from service.demo import MOTORS
from service.plant import PlantError, read_plant


def test_a_data_directory_that_cannot_be_written_to() -> None:
    with pytest.raises(ServeError) as failure:
        require_writable(Path("/proc/self"))  # nobody may, not even root
    assert str(failure.value).startswith(
        f"/proc/self: expected a directory that user {os.getuid()} may write to (setting data_directory)"
    )


def test_relays_are_where_the_chosen_subnetwork_says(tmp_path: Path) -> None:
    scd = tmp_path / "plant.scd"
    write_demo_enterprise(scd)
    outside = read_plant(Settings(scd=scd, motors=MOTORS, subnetwork="WAN")).relay("B3_SEL710")
    assert (outside.host, outside.port) == ("router-b", 10215)
    inside = read_plant(Settings(scd=scd, motors=MOTORS)).relay("B3_SEL710")
    assert (inside.host, inside.port) == ("relay-b3", 102)


def test_a_subnetwork_the_scd_does_not_have() -> None:
    expected = r'demo_plant\.scd: <Communication>: .*name="LAN", found FACTORY_A, FACTORY_B'
    with pytest.raises(PlantError, match=expected):
        read_plant(Settings(scd=scl.DEMO_PLANT_SCD, motors=MOTORS, subnetwork="LAN"))
