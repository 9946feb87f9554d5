"""Errors of measuring a start."""

from core.recordings import RecordingError


class NoStartError(RecordingError):
    """The error of a recording in which nothing can be measured of a start."""
