"""The one answer of a motor over the API."""

from fastapi import APIRouter

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.classification.schemas import MotorClassification
from service.api.context import Context
from service.api.document import Name
from service.api.problems import problems

router = APIRouter(prefix="/motors/{name}", tags=["condition"])


@router.get("/classification", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_classification(context: Context, name: Name) -> MotorClassification:
    """Return which causes are likely for all that is known of a motor, and what is not told apart."""
    answer = context.repository.motor_answer(name)
    document = answer.classification.as_dict() | {"motor": name, "records": answer.records}
    return MotorClassification.model_validate(document)
