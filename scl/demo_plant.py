"""The demo plant's SCD: two factories of three motors, each protected by a relay made from the relay's ICD.

`python -m scl.demo_plant` writes demo_plant.scd again after a change here or in sel710.icd.
"""

from dataclasses import dataclass
from pathlib import Path

from lxml import etree

from scl import DEMO_PLANT_SCD, SEL710_ICD
from scl.configuration import Address
from scl.document import Document
from scl.instantiation import number_goose, rename_ied, set_address, write

HOST = "127.0.0.1"
FIRST_PORT = 10210


@dataclass(frozen=True, slots=True)
class Drive:
    """A motor and the relay that protects it.

    Parameters
    ----------
    motor : str
        Name of the motor.
    description : str
        Its description.
    bay : str
        Name of its bay.
    ied : str
        Name of the relay's IED.
    """

    motor: str
    description: str
    bay: str
    ied: str


FACTORIES = {
    "FACTORY_A": (
        "Factory A",
        (
            Drive("PUMP-A1", "Cooling water pump, 800 W 380 V 50 Hz", "A1", "A1_SEL710"),
            Drive("FAN-A2", "Exhaust fan, 7.5 kW 400 V 50 Hz", "A2", "A2_SEL710"),
            Drive("MILL-A3", "Ball mill, 37 kW 400 V 50 Hz", "A3", "A3_SEL710"),
        ),
    ),
    "FACTORY_B": (
        "Factory B",
        (
            Drive("CONVEYOR-B1", "Belt conveyor, 7.5 kW 400 V 50 Hz", "B1", "B1_SEL710"),
            Drive("COMPRESSOR-B2", "Air compressor, 37 kW 400 V 50 Hz", "B2", "B2_SEL710"),
            Drive("PUMP-B3", "Transfer pump, 800 W 380 V 50 Hz", "B3", "B3_SEL710"),
        ),
    ),
}


ATTACHED = (("PRO", "TRIP", "PTRC"), ("PRO", "FLT", "RDRE"), ("MET", "MET", "MMXU"), ("MET", "MET", "MSQI"))


def write_demo_plant(path: Path | str) -> None:
    """Write the SCD: substations, communication, six IEDs and the data types they share.

    Parameters
    ----------
    path : pathlib.Path or str
        The file to write.
    """
    plant = Document(SEL710_ICD)
    header, communication, template, types = plant.root
    header.set("id", "Demo plant")
    for text in plant.children(header, "Text"):
        text.text = "Two factories, three motors each. Written by scl.demo_plant; change it there."
    plant.root.remove(template)
    plant.root.remove(communication)
    network = plant.add(plant.root, "Communication")
    port = FIRST_PORT
    for site, (description, drives) in FACTORIES.items():
        plant.root.insert(plant.root.index(network), _substation(plant, site, description, drives))
        subnetwork = plant.add(
            network, "SubNetwork", name=site, type="8-MMS", desc=f"Motor control, {description}"
        )
        for drive in drives:
            connected, relay = _relay(drive, Address(HOST, port), port - FIRST_PORT)
            subnetwork.append(connected)
            plant.root.append(relay)
            port += 1
    plant.root.append(types)
    etree.indent(plant.root)
    write(plant, Path(path))


def _substation(plant: Document, name: str, description: str, drives: tuple[Drive, ...]) -> etree._Element:
    substation = plant.add(plant.root, "Substation", name=name, desc=description)
    level = plant.add(substation, "VoltageLevel", name="LV", desc="Motor control centre")
    plant.add(level, "Voltage", unit="V").text = "400"
    for drive in drives:
        bay = plant.add(level, "Bay", name=drive.bay, desc=f"Feeder of {drive.motor}")
        motor = plant.add(bay, "ConductingEquipment", name=drive.motor, desc=drive.description, type="MOT")
        for device, prefix, ln_class in ATTACHED:
            plant.add(
                motor,
                "LNode",
                iedName=drive.ied,
                ldInst=device,
                prefix=prefix,
                lnClass=ln_class,
                lnInst="1",
            )
    return substation


def _relay(drive: Drive, address: Address, number: int) -> tuple[etree._Element, etree._Element]:
    """Make the ConnectedAP and the IED of a drive's relay from the ICD."""
    relay = Document(SEL710_ICD)
    rename_ied(relay, drive.ied)
    set_address(relay, drive.ied, address)
    number_goose(relay, number)
    connected = next(relay.descendants(relay.root, "ConnectedAP"))
    ied = next(relay.children(relay.root, "IED"))
    ied.set("desc", f"Motor protection relay of {drive.motor}")
    return connected, ied


if __name__ == "__main__":
    write_demo_plant(DEMO_PLANT_SCD)
