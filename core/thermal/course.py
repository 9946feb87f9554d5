"""Currents of a motor over time, as thermal models take them."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class CurrentStep:
    """Currents that hold for a while.

    Parameters
    ----------
    duration_s : float
        How long they hold [s].
    positive : float
        Positive-sequence current over the full-load current; 0 while the motor stands.
    negative : float, default 0.0
        Negative-sequence current over the full-load current.
    """

    duration_s: float
    positive: float
    negative: float = 0.0

    @property
    def is_standing(self) -> bool:
        """Whether no current flows."""
        return self.positive == 0.0 and self.negative == 0.0
