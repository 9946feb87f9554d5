"""A process of the service gets the plant that the service has read."""

import pickle

import pytest

from scl import DEMO_PLANT_SCD
from service.demo import MOTORS
from service.plant.files import plant_of_files
from service.plant.handover import plant_from_bytes, plant_to_bytes


def test_the_plant_arrives_as_it_was_read() -> None:
    plant = plant_of_files(DEMO_PLANT_SCD, MOTORS)
    arrived = plant_from_bytes(plant_to_bytes(plant))
    assert arrived == plant
    # What a relay promises is left out of that comparison.
    promised = [relay.expected for relay in plant.relays]
    assert [relay.expected for relay in arrived.relays] == promised
    assert None not in promised


def test_anything_else_is_no_plant() -> None:
    with pytest.raises(TypeError, match="expected the plant from the parent process, found list"):
        plant_from_bytes(pickle.dumps([]))
