"""Errors of the diagnosis."""

from core.recordings import RecordingError


class DiagnosisError(ValueError):
    """The error of a diagnosis asked for a method or model that does not exist.

    It is also raised where recordings cannot give the baseline that is to be learnt from them.
    """


class NoVoltagesError(RecordingError):
    """The error of a recording without voltages, where they were not waived."""
