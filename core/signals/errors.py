"""Errors of the signal estimators."""


class SignalError(ValueError):
    """Samples from which the quantity cannot be estimated; the message names the figure and its limit."""
