"""`mcc rotor`: the sidebands of broken bars in the current of one phase, where nothing else was recorded."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.text import Text

from core.recordings import Quantity, RecordingError
from core.recordings.tables.reading import TABLE_READERS, read_table
from core.recordings.tables.table import Table
from core.rotor.finding import decibels
from core.rotor.one_phase import require_rate
from core.rotor.one_phase_finding import OnePhaseFinding, examine_one_phase
from core.signals.errors import SignalError
from core.units import SECONDS_PER_MINUTE
from service.cli.output import WRONG_USE, CommandError, facts_table, failing_clearly, print_document, results
from service.cli.recordings.files import read_recording
from service.client.rotor_and_supply import STATES

SAME_RATE = 0.01
"""A rate that is given may differ from that of the file's times by so much, relatively."""


@dataclass(frozen=True, slots=True)
class Source:
    """How a current is found in a file: its column or channel, and the rate where the file has no times."""

    column: str | None
    sample_rate_hz: float | None


def examine_current(
    record: Path,
    speed_rpm: float,
    source: Source,
    *,
    frequency_hz: float,
    pole_pairs: int | None,
    healthy: Path | None,
    as_json: bool,
) -> None:
    """Fit the sidebands of one phase's current and print what they tell.

    healthy: record of the same motor with a whole cage at the same speed.
    Raises CommandError where a file, or the speed, cannot be used.
    """
    one_pair_rpm = SECONDS_PER_MINUTE * frequency_hz
    pairs = pole_pairs or max(1, int(one_pair_rpm / speed_rpm))
    slip = 1.0 - pairs * speed_rpm / one_pair_rpm
    if not 0.0 < slip < 1.0:
        raise CommandError(
            f"--speed-rpm {speed_rpm:g}: expected less than the synchronous speed, which is "
            f"{one_pair_rpm / pairs:g} rpm with pole pairs {pairs} at {frequency_hz:g} Hz",
            exit_code=WRONG_USE,
        )
    with failing_clearly(RecordingError, SignalError, OSError):
        if source.sample_rate_hz is not None:
            require_rate(source.sample_rate_hz, slip, frequency_hz)
        current, rate_hz = _current(record, source)
        require_rate(rate_hz, slip, frequency_hz)
        beside = (
            None if healthy is None else examine_one_phase(*_current(healthy, source), slip, frequency_hz)
        )
    if beside is not None and beside.sidebands is None:
        raise CommandError(f"{healthy}: {beside.reasons[0]}")
    found = examine_one_phase(
        current, rate_hz, slip, frequency_hz, None if beside is None else beside.sidebands
    )
    if as_json:
        print_document({**found.as_dict(), "speed_rpm": speed_rpm, "pole_pairs": pairs})
    else:
        results().print(facts_table(_lines(found, speed_rpm, pairs), title=record.name))


def _current(path: Path, source: Source) -> tuple[NDArray[np.float64], float]:
    """Return the samples and their rate. Raises RecordingError, OSError, CommandError (wrong use)."""
    if path.suffix.casefold() in TABLE_READERS:
        table = read_table(path)
        rate_hz = _rate_of(path, table, source.sample_rate_hz)
        return table.columns[_chosen(path, table.names, source.column)].values, rate_hz
    recording = read_recording(path, lenient=False)
    rows = [k for k, channel in enumerate(recording.channels) if channel.quantity is Quantity.CURRENT]
    names = tuple(recording.channels[k].name for k in rows)
    return recording.samples[rows[_chosen(path, names, source.column)]], recording.sample_rate_hz


def _rate_of(path: Path, table: Table, given_hz: float | None) -> float:
    """Return the sampling rate by the file's times, or as it is given."""
    told_hz = table.sample_rate_hz
    if table.instants_s is not None:
        expected = "rows at even steps of time: a spectrum has no other"
        raise RecordingError(path, "column of times", expected=expected, found="gaps or several rates")
    if told_hz is None and given_hz is None:
        found = (
            "neither" if table.numbered_by is None else f"only the number of the row ({table.numbered_by!r})"
        )
        expected = "a column of times, or --rate with the sampling rate in Hz"
        raise RecordingError(path, "sampling rate", expected=expected, found=found)
    if told_hz is not None and given_hz is not None and abs(given_hz / told_hz - 1.0) > SAME_RATE:
        expected = f"the rate of the file's times, {told_hz:g} Hz"
        raise RecordingError(path, "--rate", expected=expected, found=f"{given_hz:g} Hz")
    return told_hz or given_hz or 0.0


def _chosen(path: Path, names: tuple[str, ...], column: str | None) -> int:
    """Return the place of the current among the columns, by its name; the only one needs none."""
    if column is None and len(names) == 1:
        return 0
    if column in names:
        return names.index(column)
    listed = ", ".join(names) or "no current"
    raise CommandError(
        f"{path.name}: expected --column with one of {listed}"
        + ("" if column is None else f", found {column}"),
        exit_code=WRONG_USE,
    )


def _lines(found: OnePhaseFinding, speed_rpm: float, pole_pairs: int) -> list[tuple[str, Text]]:
    """Return state, figures and reasons as lines of a name and a text."""
    lines = [("rotor", STATES[found.state])]
    sidebands = found.sidebands
    if sidebands is not None:
        lines += [
            ("lower sideband", f"{decibels(sidebands.lower):.1f} dB"),
            ("upper sideband", f"{decibels(sidebands.upper):.1f} dB"),
            ("noise", f"{decibels(sidebands.noise):.1f} dB"),
            (
                "beside the supply's line",
                f"{sidebands.distance_hz:.2f} Hz, at {sidebands.frequency_hz:.2f} Hz",
            ),
        ]
        if sidebands.spikes:
            lines.append(("spikes replaced", str(sidebands.spikes)))
    if found.change_dB is not None and found.change_dB_ci95 is not None:
        low, high = found.change_dB_ci95
        lines.append(("against the healthy record", f"{found.change_dB:+.1f} dB [{low:+.1f}..{high:+.1f}]"))
    lines.append(("slip", f"{found.slip:.2%}, {speed_rpm:g} rpm with {pole_pairs} pole pairs"))
    lines += [("because" if number == 0 else "", reason) for number, reason in enumerate(found.reasons)]
    return [(name, Text(words)) for name, words in lines]
