"""The demo plant, whose relays send their protection data by GOOSE."""

from pathlib import Path

import scl
from service.configuration.settings import Settings
from service.plant import Plant, read_plant
from testing.relays.goose import with_goose

MOTORS = Path(__file__).parents[4] / "service" / "demo" / "motors.toml"


def goose_plant(directory: Path) -> tuple[scl.Scl, Plant]:
    """Return the plant, and its SCL."""
    file = directory / "plant.scd"
    document = with_goose(scl.DEMO_PLANT_SCD, file)
    return document, read_plant(Settings(data_directory=directory, scd=file, motors=MOTORS))
