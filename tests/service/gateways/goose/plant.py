"""The demo plant, whose relays send their protection data by GOOSE."""

from collections.abc import Callable
from pathlib import Path

from lxml import etree

import scl
from service.configuration.settings import Settings
from service.plant import read_plant

MOTORS = Path(__file__).parents[4] / "service" / "demo" / "motors.toml"
SCD = scl.DEMO_PLANT_SCD


def relays_of_motors(directory: Path) -> dict[str, str]:
    """Return the relay of each motor."""
    plant = read_plant(Settings(data_directory=directory, scd=SCD, motors=MOTORS))
    return {motor.name: motor.relay for motor in plant.motors}


def changed_scd(file: Path, change: Callable[[etree._Element, etree._Element], None]) -> scl.Scl:
    """Write the plant's SCD changed, and read it. change: is given each element, and its parent."""
    tree = etree.parse(SCD)
    for element in list(tree.iter(etree.Element)):
        parent = element.getparent()
        if parent is not None:
            change(element, parent)
    tree.write(file)
    return scl.read(file)
