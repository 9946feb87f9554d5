"""The gateways to the plant's other systems, and what does not work in them."""

from fastapi import APIRouter

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Document
from service.api.pages import Page
from service.api.problems import problems

router = APIRouter(tags=["operation"])


class Integration(Document):
    """A gateway to another system, by its kind in the settings.

    restarts: how often it ended since the service started. problem: null while all works in it.
    """

    kind: str
    process_id: int | None
    restarts: int
    problem: str | None


@router.get("/integrations", responses=problems(), dependencies=[require(Permission.VIEW)])
def list_integrations(context: Context) -> Page[Integration]:
    """Return the gateways to other systems that the settings of this service name."""
    found = [Integration.model_validate(one) for one in context.integrations()]
    return Page(items=found, next_cursor=None)
