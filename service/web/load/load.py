"""What the page of a motor's load shows, read from the repository."""

from dataclasses import dataclass
from typing import Final

from markupsafe import Markup

from core.load.profile import CLASS_WIDTH
from core.machines.parameters import ThermalElement
from service.condition.fault_costs import FaultCosts, fault_costs
from service.condition.metered_load import MotorLoad, motor_load
from service.condition.motor_data import motor_known
from service.configuration.energy import EnergySettings
from service.pictures.load_profile import LoadShare, load_profile_picture
from service.pictures.looks import PAGE, Look
from service.storage import Repository
from service.web.charts import Table
from service.web.motor.picture_tables import profile_table
from service.web.pictures import markup

OF_TIME: Final = "of the running time"
MOST_RECORDS: Final = 240
"""The latest records that stand for the profile where nothing was metered."""


@dataclass(frozen=True, slots=True)
class LoadPage:
    """What the page shows. picture: of the profile, as SVG.  table: the values behind it."""

    load: MotorLoad
    picture: Markup
    table: Table
    profile_of: str
    costs: FaultCosts


def load_page(
    repository: Repository,
    motor: str,
    *,
    days: int,
    now_ns: int,
    energy: EnergySettings,
    thermal: ThermalElement | None = None,
    look: Look = PAGE,
) -> LoadPage | None:
    """Read what the page shows; None before a service has read the motors file. Raises NotFoundError."""
    versions = repository.motor_versions(motor)
    if not versions:
        return None
    known = motor_known(motor, versions[-1].document)
    load = motor_load(repository, known, days=days, now_ns=now_ns, thermal=thermal)
    shares, of_what = _shares(repository, motor, load)
    picture = load_profile_picture(motor, shares, of_what=of_what, look=look)
    costs = fault_costs(repository, motor, known, energy, now_ns=now_ns)
    return LoadPage(load, markup(picture), profile_table(shares, of_what), of_what, costs)


def _shares(repository: Repository, motor: str, load: MotorLoad) -> tuple[list[LoadShare], str]:
    """Return how loaded the motor was: by what its relay meters, or else by its latest records."""
    if load.profile.running_hours > load.profile.unclassed_hours:
        classes = load.profile.classes
        return [LoadShare(one.from_level + CLASS_WIDTH / 2.0, one.hours) for one in classes], OF_TIME
    seen = repository.latest_records(motor, limit=MOST_RECORDS)
    loads = [one.observation.load_level for one in seen]
    return [LoadShare(load) for load in loads if load is not None], "of the records"
