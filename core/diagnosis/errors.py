"""Errors of the diagnosis."""


class DiagnosisError(ValueError):
    """The error of a diagnosis asked for a method or model that does not exist.

    It is also raised where recordings cannot give the baseline that is to be learnt from them.
    """
