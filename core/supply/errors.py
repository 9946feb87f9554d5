"""Errors of measuring a supply."""

from core.recordings import RecordingError


class NoSupplyError(RecordingError):
    """The error of a recording in which nothing can be measured of a supply."""
