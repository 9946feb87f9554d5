"""Errors of the diagnosis."""


class DiagnosisError(ValueError):
    """The diagnosis was asked for something it does not know (a method, a model), or to learn a baseline
    from recordings that cannot give one."""
