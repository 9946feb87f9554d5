"""A relay without a plant: one IED made from its profile's ICD."""

import tempfile
from pathlib import Path

import scl
from ied_sim.profiles.profile import Profile
from scl import Address, Scl

IED_NAME = "SIM_RELAY"


def standalone(profile: Profile, ied_name: str, address: Address) -> Scl:
    """Configuration of one relay of this kind. Raises SclError where the name is none or the ICD is bad."""
    with tempfile.TemporaryDirectory(prefix="ied-sim-") as directory:
        path = Path(directory) / f"{ied_name}.cid"
        scl.instantiate(profile.icd_path, path, ied_name, address)
        return scl.read(path)
