"""Errors of the diagnosis."""


class DiagnosisError(ValueError):
    """The diagnosis was asked for something it does not know (a method, a model)."""
