"""The error of a report that cannot be kept: what is wrong, in which line or field."""

from core.relay_reports import ReportError


class RefusedReportError(ValueError):
    """A report cannot be read, or nothing that it tells can be kept.

    place: where in it, such as "line 12, IA"; empty for the whole report.
    message: what was expected and found.
    """

    def __init__(self, place: str, message: str) -> None:
        self.place = place
        self.message = message
        super().__init__(f"{place}: {message}" if place else message)


def unreadable(error: ReportError) -> RefusedReportError:
    """Return the refusal of a report that cannot be read."""
    return RefusedReportError(error.place, f"expected {error.expected}, found {error.found}")
