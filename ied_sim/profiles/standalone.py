"""A relay without a plant: the configuration of one IED made from its profile's ICD."""

import tempfile
from pathlib import Path

import scl
from ied_sim.profiles.profile import Profile
from scl import Address, Scl

IED_NAME = "SIM_RELAY"


def standalone(profile: Profile, ied_name: str, address: Address) -> Scl:
    """Make the configuration of one relay. Raise SclError where the name is unusable or the ICD is bad."""
    with tempfile.TemporaryDirectory(prefix="ied-sim-") as directory:
        path = Path(directory) / f"{ied_name}.cid"
        scl.instantiate(profile.icd_path, path, ied_name, address)
        return scl.read(path)
