"""The answer to a report that cannot be kept: what is wrong, in which line and field."""

from http import HTTPStatus

from core.relay_reports import ReportError
from service.api.problems import FieldError, ProblemError


def refused(location: str, message: str) -> ProblemError:
    """Return the answer to a report that is read, and cannot be kept."""
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        f"{location}: {message}",
        errors=[FieldError(location=location, message=message)],
    )


def unreadable(error: ReportError) -> ProblemError:
    """Return the answer to a report that cannot be read."""
    return refused(f"body: {error.place}", f"expected {error.expected}, found {error.found}")
