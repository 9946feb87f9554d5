"""Errors of the signal estimators."""


class SignalError(ValueError):
    """The error of samples from which a quantity cannot be estimated; it names the figure and its limit."""
