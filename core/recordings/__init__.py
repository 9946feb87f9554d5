"""Event recordings: what a relay measured, as arrays with units."""

from core.recordings.envelope import Envelope
from core.recordings.errors import RecordingError
from core.recordings.reading import read, read_envelope
from core.recordings.waveform import Channel, Digitals, Quantity, Recording

__all__ = [
    "Channel",
    "Digitals",
    "Envelope",
    "Quantity",
    "Recording",
    "RecordingError",
    "read",
    "read_envelope",
]
