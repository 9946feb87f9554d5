"""The files of a COMTRADE record: which they are, how large they may be, and who reads their samples."""

from functools import cache
from pathlib import Path

from core.recordings.code_pages import decode_text
from core.recordings.comtrade.ascii_samples import ascii_samples_held, decode_ascii
from core.recordings.comtrade.combined import split_combined
from core.recordings.comtrade.configuration import Configuration, Layout, parse_configuration
from core.recordings.comtrade.data import Sink, SinkOf, binary_samples_held, decode_binary
from core.recordings.comtrade.wide_text import ascii_text, warn_of_wide
from core.recordings.data_section import DataSection
from core.recordings.errors import RecordingError
from core.recordings.repairs import Repairs

MAX_CONFIGURATION_BYTES = 4 << 20
MAX_DATA_BYTES = 1 << 30


def open_record(path: Path, repairs: Repairs) -> tuple[Configuration, DataSection]:
    """Read a configuration file and find the data file beside it.

    Parameters
    ----------
    path : pathlib.Path
        Configuration file.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    configuration : Configuration
        The checked configuration.
    data : DataSection
        Place of the samples.

    Raises
    ------
    RecordingError
        If a file is missing, too large or contradicts itself.
    OSError
        If a file that exists cannot be read.
    """
    _check_file(path, MAX_CONFIGURATION_BYTES)
    content = path.read_bytes()
    warn_of_wide(path, content, repairs)

    @cache
    def data_of(data_format: str) -> DataSection:
        data_path = _data_file(path)
        data = DataSection(data_path, 0, _check_file(data_path, MAX_DATA_BYTES))
        return ascii_text(data, repairs) if data_format == "ASCII" else data

    configuration = parse_configuration(
        path, decode_text(content), repairs, lambda layout: _samples_held(data_of(layout.data_format), layout)
    )
    return configuration, data_of(configuration.data_format)


def open_combined(path: Path, repairs: Repairs) -> tuple[Configuration, DataSection]:
    """Read the configuration in a combined file (.cff) and find the samples in it.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    configuration : Configuration
        The checked configuration.
    data : DataSection
        Place of the samples.

    Raises
    ------
    RecordingError
        If a file is missing, too large or contradicts itself.
    OSError
        If a file that exists cannot be read.
    """
    _check_file(path, MAX_DATA_BYTES)
    cfg, data, data_format = split_combined(path, repairs)
    if len(cfg) > MAX_CONFIGURATION_BYTES:
        raise RecordingError(
            path,
            "CFG section",
            expected=f"at most {MAX_CONFIGURATION_BYTES} bytes",
            found=f"{len(cfg)} bytes",
        )
    configuration = parse_configuration(
        path, decode_text(cfg), repairs, lambda layout: _samples_held(data, layout)
    )
    if data_format != configuration.data_format:
        raise RecordingError(
            path, "DAT section", expected=f"format {configuration.data_format}", found=repr(data_format)
        )
    return configuration, data


def decode(data: DataSection, configuration: Configuration, repairs: Repairs, sink_of: SinkOf[Sink]) -> Sink:
    """Read the samples, whatever their format.

    Parameters
    ----------
    data : DataSection
        Place of the samples.
    configuration : Configuration
        The checked configuration.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.
    sink_of : callable
        Makes what takes the samples.

    Returns
    -------
    SampleSink
        What took the samples.

    Raises
    ------
    RecordingError
        If the samples do not fit the configuration.
    OSError
        If the file cannot be read.
    """
    decoder = decode_ascii if configuration.data_format == "ASCII" else decode_binary
    return decoder(data, configuration, repairs, sink_of)


def _samples_held(data: DataSection, layout: Layout) -> int:
    return ascii_samples_held(data) if layout.data_format == "ASCII" else binary_samples_held(data, layout)


def _check_file(path: Path, limit: int) -> int:
    """Size [bytes] of a file that is there and no larger than `limit`."""
    if not path.is_file():
        raise RecordingError(path, "file", expected="a file", found="none at this path")
    size = path.stat().st_size
    if size > limit:
        raise RecordingError(path, "size", expected=f"at most {limit} bytes", found=f"{size} bytes")
    return size


def _data_file(path: Path) -> Path:
    """Return the .dat of a .cfg: spelt in the same case, or the only one that differs in case."""
    suffix = "DAT" if path.suffix.isupper() else "dat"
    beside = path.with_suffix(f".{suffix}")
    if beside.is_file():
        return beside
    found = [
        file
        for file in path.parent.iterdir()
        if file.stem.casefold() == path.stem.casefold() and file.suffix.casefold() == ".dat"
    ]
    if len(found) != 1:
        names = ", ".join(sorted(file.name for file in found)) or "none"
        raise RecordingError(path, "data file", expected=f"one {beside.name} in the same folder", found=names)
    return found[0]
