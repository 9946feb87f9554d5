"""The plant as the service sees it: sites, relays with their references, motors with their parameters."""

from service.plant.errors import PlantError
from service.plant.files import read_plant
from service.plant.model import Plant, PlantMotor, Relay, Site

__all__ = ["Plant", "PlantError", "PlantMotor", "Relay", "Site", "read_plant"]
