"""The analogue channels of a COMTRADE record: their counts in primary SI units, and what is told of them."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.channel_roles import ChannelRole
from core.recordings.comtrade.configuration import AnalogChannel, Configuration
from core.recordings.errors import RecordingError
from core.recordings.waveform import Channel


def channels_of(configuration: Configuration, roles: tuple[ChannelRole, ...]) -> tuple[Channel, ...]:
    """Return the channels as a recording tells them.

    Parameters
    ----------
    configuration : Configuration
        The checked configuration.
    roles : tuple of ChannelRole
        What each channel measures.

    Returns
    -------
    tuple of Channel
        The channels, in the order of the file.
    """
    return tuple(
        Channel(
            c.name,
            role.quantity,
            role.phase,
            role.unit,
            full_scale=_full_scale(c, role.scale),
            transformer_ratio=c.ratio,
            applied_ratio=c.to_primary,
            is_constant=c.gain == 0,
        )
        for c, role in zip(configuration.analog, roles, strict=True)
    )


def scale_counts(
    path: Path,
    data_path: Path,
    configuration: Configuration,
    roles: tuple[ChannelRole, ...],
    counts: NDArray[np.float64],
    column: str = "sample",
) -> NDArray[np.float64]:
    """Turn counts into primary SI values, in place: a long record is not held twice.

    Parameters
    ----------
    path : pathlib.Path
        Configuration file, for messages.
    data_path : pathlib.Path
        Data file, for messages.
    configuration : Configuration
        The checked configuration.
    roles : tuple of ChannelRole
        What each channel measures.
    counts : ndarray, shape (channels, samples)
        Values as written; they are overwritten.
    column : str, optional
        What a column of them is, for messages.

    Returns
    -------
    ndarray, shape (channels, samples)
        The same array, each row in its channel's SI unit.

    Raises
    ------
    RecordingError
        If a value is infinite, or becomes so.
    """
    _check_counts(data_path, counts, column)
    for channel, role, values in zip(configuration.analog, roles, counts, strict=True):
        scale = role.scale * channel.to_primary
        if channel.gain == 0:
            values[:] = 0.0  # missing counts, too
        with np.errstate(over="ignore", invalid="ignore"):
            values *= scale * channel.gain
            values += scale * channel.offset
        finite = np.isfinite([scale * channel.gain, scale * channel.offset]).all()
        if not finite or np.isinf(values).any():
            raise RecordingError(
                path,
                f"channel {channel.name!r}",
                expected="finite values",
                found="values too large for a number",
            )
    return counts


def _check_counts(path: Path, table: NDArray[np.float64], column: str) -> None:
    for channel, counts in enumerate(table, 1):
        infinite = np.isinf(counts)
        if infinite.any():
            sample = int(np.argmax(infinite))
            raise RecordingError(
                path,
                f"{column} {sample + 1}, analogue channel {channel}",
                expected="a finite value",
                found=str(counts[sample]),
            )


def _full_scale(channel: AnalogChannel, unit_scale: float) -> float | None:
    """Largest magnitude within the file's minimum and maximum counts; None if these say nothing."""
    if channel.minimum == channel.maximum:
        return None
    ends = (channel.gain * count + channel.offset for count in (channel.minimum, channel.maximum))
    full_scale = max(abs(end) for end in ends) * channel.to_primary * unit_scale
    return full_scale if np.isfinite(full_scale) else None
