"""How much of a recording a reader may hold in memory."""

from pathlib import Path

from core.recordings.errors import RecordingTooLongError

VALUES_BESIDE = 4
"""Times, states and what is computed from them take as much of a sample as so many channels."""


def check_length(path: Path, channels: int, samples: int, most_values: int | None) -> None:
    """Refuse a recording that is too long.

    Parameters
    ----------
    path : pathlib.Path
        File it is in.
    channels : int
        Number of analogue channels.
    samples : int
        Number of samples.
    most_values : int or None
        Most values of all channels and of VALUES_BESIDE more; None for any number.

    Raises
    ------
    RecordingTooLongError
        If there are more.
    """
    values = (channels + VALUES_BESIDE) * samples
    if most_values is not None and values > most_values:
        told = f"{values}: {samples} samples of {channels} channels and {VALUES_BESIDE} more (time, states)"
        raise RecordingTooLongError(path, "length", expected=f"at most {most_values} values", found=told)
