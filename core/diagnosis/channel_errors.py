"""What an error of one channel adds to the ratios of the terminals' phasors."""

from cmath import exp as cexp
from math import pi
from typing import Final

from core.machines.parameters import Connection, Motor
from core.machines.stator_winding import Winding
from core.machines.winding_frame import terminal_winding
from core.signals.sequence import PhaseSequence
from core.signals.terminals import VoltageChannels

A: Final = cexp(2j * pi / 3.0)
SIXTH: Final = cexp(1j * pi / 6.0)


def terminal_turn(motor: Motor) -> complex:
    """Return the factor from V2/V1 of the terminals to that of the windings."""
    return 1.0 / SIXTH**2 if motor.nameplate.connection is Connection.DELTA else 1.0 + 0.0j


def voltage_channels(channels: VoltageChannels) -> tuple[complex, ...]:
    """Return what an error of each voltage channel adds to V2/V1 of the terminals, per relative error."""
    half, whole = 0.5 / 3.0**0.5, 1.0 / 3.0**0.5
    if channels is VoltageChannels.PHASE:
        return tuple(A**x / 3.0 for x in range(3))
    if channels is VoltageChannels.THREE_LINES:
        return (half * SIXTH, -0.5 + 0.0j, half / SIXTH)
    return (whole * SIXTH, whole * SIXTH**5, whole * SIXTH**3)


def voltage_forward_shares(channels: VoltageChannels) -> tuple[complex, ...]:
    """Return what an error of each voltage channel adds to V1, per relative error, as a share of V1."""
    if channels is VoltageChannels.PHASE:
        return (1.0 / 3.0 + 0.0j,) * 3
    if channels is VoltageChannels.THREE_LINES:
        half = 0.5 / 3.0**0.5
        return (half * SIXTH, 0.5 + 0.0j, half / SIXTH)
    return (0.5 + 0.0j,) * 3


def channel_of(index: int, channels: VoltageChannels, sequence: PhaseSequence) -> Winding | None:
    """Return which voltage channel of the terminals an index of `voltage_channels` means."""
    if channels is VoltageChannels.TWO_LINES:
        return None
    # Mirroring exchanges phases b and c, hence lines ab and ca, as the windings of a star and of a delta.
    as_if = Connection.STAR if channels is VoltageChannels.PHASE else Connection.DELTA
    return terminal_winding(index, sequence, as_if)
