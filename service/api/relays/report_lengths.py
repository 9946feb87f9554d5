"""How long a relay's event reports are, for the API and for its page."""

from service.api.context import ApiContext
from service.plant.report_length import ReportLength, report_length
from service.storage.records.overviews import RelayOverview


def report_length_of(context: ApiContext, overview: RelayOverview) -> ReportLength | None:
    """Return what the latest record of a relay tells; None where none was read, or no file has its motor."""
    for name in overview.motors:
        motor, length = context.motors.get(name), context.repository.record_length(name)
        if motor is not None and length is not None:
            return report_length(overview.relay.type, length, motor.nameplate.rated_frequency_Hz)
    return None
