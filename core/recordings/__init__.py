"""Event recordings: what a relay measured, as arrays with units."""

from core.recordings.errors import RecordingError
from core.recordings.reading import read
from core.recordings.waveform import Channel, Quantity, Recording

__all__ = ["Channel", "Quantity", "Recording", "RecordingError", "read"]
