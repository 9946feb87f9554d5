"""Substation configuration (IEC 61850-6): reads ICD, CID, IID and SCD files, and writes copies of them.

`SEL710_ICD` is the relay's own description, `DEMO_PLANT_SCD` the demo plant of six such relays.
"""

from pathlib import Path

from scl.configuration import Address, Scl
from scl.errors import Finding, SclError
from scl.instantiation import instantiate, with_addresses
from scl.reader import read
from scl.substation_model import MotorFeeder

SEL710_ICD = Path(__file__).with_name("sel710.icd")
DEMO_PLANT_SCD = Path(__file__).with_name("demo_plant.scd")

__all__ = [
    "DEMO_PLANT_SCD",
    "SEL710_ICD",
    "Address",
    "Finding",
    "MotorFeeder",
    "Scl",
    "SclError",
    "instantiate",
    "read",
    "with_addresses",
]
