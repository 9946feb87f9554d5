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
from service.web.pictures import markup

SPANS: Final = (1, 7, 30, 90)
"""Days that can be chosen."""


@dataclass(frozen=True, slots=True)
class LoadPage:
    """What the page shows. picture: of the profile, as SVG."""

    load: MotorLoad
    picture: Markup
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
    shares = [LoadShare(one.from_level + CLASS_WIDTH / 2.0, one.hours) for one in load.profile.classes]
    picture = load_profile_picture(motor, shares, of_what="of the running time", look=look)
    costs = fault_costs(repository, motor, known, energy, now_ns=now_ns)
    return LoadPage(load, markup(picture), costs)
