"""The plant as the service sees it: sites, relays with what they offer, motors with their parameters."""

from service.plant.acquisition import Acquisition, acquisition_from_offer, acquisition_from_scl
from service.plant.differences import Difference, differences
from service.plant.errors import PlantError
from service.plant.files import read_plant
from service.plant.metering import Measurand
from service.plant.model import Bus, Plant, PlantMotor, Relay, Site
from service.plant.offer import Offer, ReportBlock
from service.plant.overrides import Overrides, TriggerAction
from service.plant.quantities import AveragingStep, MeteredQuantity, PowerUnit
from service.plant.schedule import Schedule

__all__ = [
    "Acquisition",
    "AveragingStep",
    "Bus",
    "Difference",
    "Measurand",
    "MeteredQuantity",
    "Offer",
    "Overrides",
    "Plant",
    "PlantError",
    "PlantMotor",
    "PowerUnit",
    "Relay",
    "ReportBlock",
    "Schedule",
    "Site",
    "TriggerAction",
    "acquisition_from_offer",
    "acquisition_from_scl",
    "differences",
    "read_plant",
]
