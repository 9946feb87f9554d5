"""What the numbers of an observation can be."""

from core.condition.errors import ObservationError
from core.condition.observation import Observation
from core.quantity_text import plain

LARGEST_VOLTAGE_V = 1e9
LARGEST_CURRENT_A = 1e9
LEAST_VOLTAGE_V = 1e-6
"""Peak values that no motor has; what lies beyond is a fault of the record."""
FREQUENCIES_HZ = (5.0, 500.0)
LARGEST_SCATTER = 1.0
"""The noise is then as large as the voltage."""
LARGEST_LOAD = 100.0
LONGEST_RECORDER = 200
"""Characters of the recorder's name: it is part of every state that is saved."""

_BOUNDS = {
    "positive_voltage_V": LARGEST_VOLTAGE_V,
    "negative_voltage_V": LARGEST_VOLTAGE_V,
    "zero_voltage_V": LARGEST_VOLTAGE_V,
    "positive_current_A": LARGEST_CURRENT_A,
    "negative_current_A": LARGEST_CURRENT_A,
    "zero_current_A": LARGEST_CURRENT_A,
    "scatter": LARGEST_SCATTER,
    "load_level": LARGEST_LOAD,
}
"""Largest absolute values; a number that is none is beyond them too."""


def check(observation: Observation) -> None:
    """Check that all numbers of an observation are finite and possible.

    Parameters
    ----------
    observation : Observation
        Phasors of the record.

    Raises
    ------
    ObservationError
        If a number is missing, infinite or impossible, or a text too long; the message names it.
    """
    for name, largest in _BOUNDS.items():
        value = getattr(observation, name)
        if value is not None and not (abs(value.real) <= largest and abs(value.imag) <= largest):
            raise ObservationError(f"{name} is {value:.4g}: expected a finite number, at most {largest:.4g}")
    lowest, highest = FREQUENCIES_HZ
    if not lowest <= observation.frequency_hz <= highest:
        raise ObservationError(
            f"frequency_hz is {plain(observation.frequency_hz, 4)}: expected {lowest:g} Hz to {highest:g} Hz"
        )
    if observation.scatter < 0.0:
        raise ObservationError(f"scatter is {observation.scatter}: expected a variance, not below 0")
    if observation.cycles < 1:
        raise ObservationError(f"cycles is {observation.cycles}: expected at least 1")
    if len(observation.recorder) > LONGEST_RECORDER:
        raise ObservationError(
            f"recorder has {len(observation.recorder)} characters: expected at most {LONGEST_RECORDER}"
        )
    if abs(observation.positive_voltage_V) < LEAST_VOLTAGE_V:
        raise ObservationError(
            f"positive_voltage_V is {observation.positive_voltage_V:.4g}: expected that of a running motor"
        )
