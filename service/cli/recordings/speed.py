"""`mcc speed`: the speed of a motor in its recordings, from which bars and lines of its rotor are learnt."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.text import Text

from core.findings.examining import examine
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import read_motor
from core.recordings import RecordingError
from core.speed.finding import SpeedFinding
from core.speed.memory import LineMemory
from service.cli.output import CommandError, facts_table, failing_clearly, print_document, results
from service.cli.recordings.files import read_recording
from service.client.speed import speed_words


@dataclass(frozen=True, slots=True)
class _Told:
    """What one recording tells."""

    name: str
    speed: SpeedFinding


def tell_speeds(
    records: Sequence[Path], motor_file: Path, lines: Path | None, *, lenient: bool, as_json: bool
) -> None:
    """Tell the speed in recordings, the oldest first, each by what those before have taught.

    lines: file that holds what was learnt; it is read where it is there, and written at the end.
    Raises CommandError where a file cannot be used.
    """
    with failing_clearly(RecordingError, MotorFileError, OSError):
        motor = read_motor(motor_file)
        memory = _memory(lines, motor.nameplate.rotor_bars)
        found = [(path, read_recording(path, lenient=lenient)) for path in records]
        found.sort(key=lambda one: (one[1].start_time_ns is None, one[1].start_time_ns or 0))
        told = [_Told(path.name, examine(recording, motor, lines=memory).speed) for path, recording in found]
        if lines is not None:
            lines.write_text(json.dumps(memory.as_dict()) + "\n", "utf-8")
    if as_json:
        print_document(
            {
                "motor": motor.name,
                "rotor_bars": memory.known_bars,
                "possible_bars": list(memory.candidates),
                "records": [{"record": one.name, **one.speed.as_dict()} for one in told],
            }
        )
        return
    rows = [
        (one.name if number == 0 else "", Text(words))
        for one in told
        for number, words in enumerate(speed_words(one.speed))
    ]
    rows.append(("rotor bars", Text(_bars(memory))))
    results().print(facts_table(rows, title=motor.name))


def _memory(lines: Path | None, bars: int | None) -> LineMemory:
    if lines is None or not lines.exists():
        return LineMemory(bars)
    try:
        return LineMemory.from_dict(json.loads(lines.read_text("utf-8")), bars)
    except (ValueError, KeyError, TypeError) as error:
        raise CommandError(
            f"{lines}: expected what mcc speed --lines wrote, found something else ({error}); name another "
            "file or delete this one"
        ) from error


def _bars(memory: LineMemory) -> str:
    if memory.known_bars is not None:
        return f"{memory.known_bars}, {'given' if memory.given_bars is not None else 'learnt'}"
    if not memory.candidates:
        return "not known: no lines were seen"
    return "not told apart yet: " + ", ".join(map(str, memory.candidates))
