"""Errors of the simulator."""


class SimulatorError(Exception):
    """The simulated plant cannot be served as asked; the message says which relay and what to do."""
