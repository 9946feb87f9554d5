"""Event recordings: what a relay measured, as arrays with units."""

from core.recordings.errors import RecordingError
from core.recordings.reading import read
from core.recordings.waveform import Channel, Digitals, Quantity, Recording

__all__ = ["Channel", "Digitals", "Quantity", "Recording", "RecordingError", "read"]
