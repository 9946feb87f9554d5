"""Frames, phasors and sequences of sampled three-phase quantities."""

from core.signals.clarke import clarke, clarke_from_line_voltages, inverse_clarke
from core.signals.errors import SignalError
from core.signals.phasors import fundamental_frequency, fundamental_phasors, harmonic_phasors
from core.signals.sequence import PhaseSequence, SequencePhasors, sequence_phasors
from core.signals.terminals import Terminals, terminals

__all__ = [
    "PhaseSequence",
    "SequencePhasors",
    "SignalError",
    "Terminals",
    "clarke",
    "clarke_from_line_voltages",
    "fundamental_frequency",
    "fundamental_phasors",
    "harmonic_phasors",
    "inverse_clarke",
    "sequence_phasors",
    "terminals",
]
