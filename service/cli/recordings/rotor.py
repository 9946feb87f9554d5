"""`mcc rotor`: the sidebands of broken bars in the current of one phase, where nothing else was recorded."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.text import Text

from core.recordings import Quantity, RecordingError
from core.recordings.columns import read_columns
from core.rotor.finding import decibels
from core.rotor.one_phase_finding import OnePhaseFinding, examine_one_phase
from service.cli.output import WRONG_USE, CommandError, facts_table, failing_clearly, print_document, results
from service.cli.recordings.files import read_recording
from service.client.rotor_and_supply import STATES

TABLES = (".csv", ".tsv", ".txt")
"""Suffixes of files with columns of numbers; all others are read as recordings."""
SECONDS_PER_MINUTE = 60.0


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
    with failing_clearly(RecordingError, OSError):
        current, rate_hz = _current(record, source)
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
    if path.suffix.lower() in TABLES:
        table = read_columns(path)
        rate_hz = source.sample_rate_hz or table.sample_rate_hz
        if rate_hz is None:
            expected = "a first column of times, or --rate with the sampling rate in Hz"
            raise RecordingError(path, "sampling rate", expected=expected, found="neither")
        return table.samples[_chosen(path, table.names, source.column)], rate_hz
    recording = read_recording(path, lenient=False)
    rows = [k for k, channel in enumerate(recording.channels) if channel.quantity is Quantity.CURRENT]
    names = tuple(recording.channels[k].name for k in rows)
    return recording.samples[rows[_chosen(path, names, source.column)]], recording.sample_rate_hz


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
