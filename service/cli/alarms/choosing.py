"""Which alarm is meant: its id, or how it begins."""

from itertools import islice

from service.client.rest_client import ServiceClient, ServiceError

LENGTH = 36
FEWEST = 4
MOST_NAMED = 5
"""So many ids are named where several begin alike."""


def whole_id(service: ServiceClient, begin: str) -> str:
    """Return the id of the open alarm that begins so; a whole id is returned as it is.

    Raises ServiceError.
    """
    if len(begin) >= LENGTH:
        return begin
    if len(begin) < FEWEST:
        raise ServiceError(
            f"expected an alarm's id or at least its first {FEWEST} characters, found {begin!r}"
        )
    alike = (
        str(alarm["id"])
        for alarm in service.list_open_alarms(limit=1000)
        if str(alarm["id"]).startswith(begin.lower())
    )
    found = list(islice(alike, MOST_NAMED))
    if not found:
        raise ServiceError(
            f"no open alarm has an id that begins with {begin!r}; mcc alarms shows them, and of one that is "
            "over the whole id is needed"
        )
    if len(found) > 1:
        raise ServiceError(f"several alarms begin with {begin!r}: {', '.join(found)}")
    return found[0]
