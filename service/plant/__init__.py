"""The plant as the service sees it: sites, relays with their references, motors with their parameters."""

from service.plant.errors import PlantError
from service.plant.files import read_plant
from service.plant.metering import Measurand, MeteredQuantity
from service.plant.model import Plant, PlantMotor, Relay, Site
from service.plant.schedule import Schedule

__all__ = [
    "Measurand",
    "MeteredQuantity",
    "Plant",
    "PlantError",
    "PlantMotor",
    "Relay",
    "Schedule",
    "Site",
    "read_plant",
]
