"""How a motor was loaded, by what its relay meters, and what its losses cost."""

import time
from typing import Annotated, Final

from fastapi import APIRouter, Query

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name
from service.api.load.loss_schemas import Losses, losses_document
from service.api.load.schemas import LoadProfile, load_document
from service.api.problems import problems
from service.condition.fault_costs import fault_costs
from service.condition.metered_load import motor_load
from service.condition.motor_data import motor_known

MOST_DAYS: Final = 90
USUAL_DAYS: Final = 30

router = APIRouter(prefix="/motors/{name}", tags=["condition"])


@router.get("/load-profile", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_load_profile(
    context: Context,
    name: Name,
    days: Annotated[
        int, Query(ge=1, le=MOST_DAYS, description="Of so many days; up to 2 by minutes.")
    ] = USUAL_DAYS,
) -> LoadProfile:
    """Return how a motor was loaded: hours by torque, energy, starts, hours beyond limits, and its heat."""
    context.require_motor(name)
    versions = context.repository.motor_versions(name)
    if not versions:
        return LoadProfile()
    motor = motor_known(name, versions[-1].document)
    here = context.motors.get(name)
    thermal = None if here is None else here.thermal
    return load_document(
        motor_load(context.repository, motor, days=days, now_ns=time.time_ns(), thermal=thermal)
    )


@router.get("/losses", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_losses(context: Context, name: Name) -> Losses:
    """Return what a motor loses: efficiency by load, and what faults and supply cost a year."""
    context.require_motor(name)
    versions = context.repository.motor_versions(name)
    known = motor_known(name, versions[-1].document) if versions else None
    return losses_document(
        fault_costs(context.repository, name, known, context.settings.energy, now_ns=time.time_ns())
    )
