"""What the relays measure all the time, over time."""

from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Query
from fastapi.responses import StreamingResponse
from pydantic import Field, create_model

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Document, Name
from service.api.exports.answers import FILES, ListAnswer
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.times import From, Time, To
from service.exports import measurements as table
from service.plant import AveragingStep, MeteredQuantity
from service.storage.records import Measurement as StoredMeasurement
from service.storage.states import MeasurementSource

router = APIRouter(tags=["condition"])


class MeasurementTime(Document):
    """When it was measured: at `time`, or `samples` times from then on.

    source: the service polled it, or it is from the relay's load profile.
    """

    time: Time = Field(validation_alias="time_ns")
    samples: int
    source: MeasurementSource


if TYPE_CHECKING:
    _Measurement = MeasurementTime
else:
    _Measurement = create_model(
        "_Measurement",
        __base__=MeasurementTime,
        **{quantity.value: (float | None, ...) for quantity in MeteredQuantity},
    )


class Measurement(_Measurement):
    """What the relay measured: at `time`, or means of `samples` values from then on."""


@router.get(
    "/motors/{name}/measurements",
    response_model=Page[Measurement],
    responses=problems(404) | FILES,
    dependencies=[require(Permission.VIEW)],
)
def list_measurements(
    context: Context,
    name: Name,
    file: ListAnswer,
    step: Annotated[
        AveragingStep, Query(description="0: as sampled; 60, 900: means of so many seconds, kept for longer.")
    ] = AveragingStep.AS_SAMPLED,
    from_: From = None,
    to: To = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[Measurement] | StreamingResponse:
    """Return what a motor's relay measures, oldest first: currents, voltages, power and frequency."""
    if file is not None:
        context.require_motor(name)
        rows = table.measurements(context.repository, [name], step, from_ns=from_, to_ns=to)
        return file.of(table.TABLE, rows, [name])
    measurements = context.repository.measurements(
        name, int(step), from_ns=from_, to_ns=to, limit=limit, after=decode(cursor, int)
    )
    return page(measurements, _document)


def _document(stored: StoredMeasurement) -> Measurement:
    return Measurement.model_validate(
        {"time_ns": stored.time_ns, "samples": stored.samples, "source": stored.source, **stored.values}
    )
