"""Which time stamps a client wants (OPC 10000-4, 7.40): the library sends those that a node has."""

from dataclasses import replace
from datetime import UTC, datetime
from typing import Any, Final

from asyncua import ua
from asyncua.common.utils import ServiceError

WITH_SOURCE: Final = (ua.TimestampsToReturn.Source, ua.TimestampsToReturn.Both)
WITH_SERVER: Final = (ua.TimestampsToReturn.Server, ua.TimestampsToReturn.Both)
KNOWN: Final = (*WITH_SOURCE, *WITH_SERVER, ua.TimestampsToReturn.Neither)


def check_timestamps(wanted: ua.TimestampsToReturn, *, may_be_neither: bool = True) -> None:
    """Refuse what is none of the choices. Raises ServiceError.

    may_be_neither: not of a history, whose values are told by their times.
    """
    if wanted not in KNOWN or (wanted is ua.TimestampsToReturn.Neither and not may_be_neither):
        raise ServiceError(ua.StatusCodes.BadTimestampsToReturnInvalid)


def stamped(value: Any, wanted: ua.TimestampsToReturn) -> Any:
    """Return a value that was read just now with the time stamps that are wanted, and no others."""
    return replace(
        value,
        SourceTimestamp=value.SourceTimestamp if wanted in WITH_SOURCE else None,
        ServerTimestamp=(value.ServerTimestamp or datetime.now(UTC)) if wanted in WITH_SERVER else None,
        SourcePicoseconds=None,
        ServerPicoseconds=None,
    )
