"""The plant on its way to a process of the service: bytes that only such a process reads.

The files of a thousand relays take seconds and 600 MB to read and to check. The service has done both, and a
process that starts later gets the same plant, also where somebody has changed the files since.
"""

import pickle

from service.plant.model import Plant


def plant_to_bytes(plant: Plant) -> bytes:
    """Return the plant as bytes, for a process of the same version."""
    return pickle.dumps(plant, pickle.HIGHEST_PROTOCOL)


def plant_from_bytes(data: bytes) -> Plant:
    """Return the plant from the bytes that the parent of this process has made of it.

    Bytes of anybody else must not come here: to read them can run code. Raises TypeError.
    """
    plant = pickle.loads(data)  # noqa: S301 - from the parent, through a file without a name
    if not isinstance(plant, Plant):
        raise TypeError(f"expected the plant from the parent process, found {type(plant).__name__}")
    return plant
