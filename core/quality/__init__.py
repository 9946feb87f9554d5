"""The quality gate: named checks with figures, before any model sees the recording.

A check that fails makes the recording undiagnosable, with its figure and limit as the reason; it never
changes a sample. Limits are stated beside their reasons. Checks stand in an order in which each may rely on
those before it, and the gate stops at the first group that fails: what is named is the cause, not what
follows from it.
"""

from core.quality.circle_diagram import circle_diagram
from core.quality.gate import Passed, examine, sampled_well, wired_well
from core.quality.magnitude import rated_current_A
from core.quality.supply import FREQUENCY_TOLERANCE, LOWEST_VOLTAGE

__all__ = [
    "FREQUENCY_TOLERANCE",
    "LOWEST_VOLTAGE",
    "Passed",
    "circle_diagram",
    "examine",
    "rated_current_A",
    "sampled_well",
    "wired_well",
]
