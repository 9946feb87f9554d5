"""`mcc commission`: writes a motor's file from recordings of its starts, without a service."""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.text import Text

from core.commissioning.commissioning import commission
from core.commissioning.errors import CommissioningError
from core.commissioning.result import Commissioning, Estimate
from core.machines.candidates import LoadLaw
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import read_plate
from core.machines.motor_file.writer import write_motor
from core.machines.motor_tables import layout_of
from core.quantity_text import plain, with_unit
from core.recordings import RecordingError
from service.cli.output import (
    WRONG_USE,
    CommandError,
    failing_clearly,
    print_document,
    print_warning,
    progress,
    results,
)
from service.cli.plant.windings import winding_row
from service.cli.recordings.files import read_recording
from service.client.tables import FittedTable


def commission_motor(
    records: Sequence[Path], nameplate: Path, output: Path, *, load: str, lenient: bool, as_json: bool
) -> None:
    """Read the recordings, estimate the parameters, write the motor's file and print the result.

    Warnings also go to stderr, and so does what a lenient reader mends.

    Raises CommandError, and writes nothing, where a recording cannot be read or holds no start, where the
    motor's file cannot be used or written or is one of the files read, or where the recordings determine no
    parameter at all.
    """
    law = load_law(load)
    check_output(output, nameplate, records)
    with failing_clearly(RecordingError, MotorFileError, CommissioningError, OSError):
        plate = read_plate(nameplate)
        recordings = [read_recording(record, lenient=lenient, layout=layout_of(plate)) for record in records]
        for note in (note for one in recordings for note in (*one.warnings, *one.repairs)):
            print_warning(note)
        with progress_bar() as advance:
            found = commission(recordings, plate, load_law=law, progress=advance)
        if not found.identifiable:
            raise CommandError(
                found.reasons[0], details={"type": "NotIdentifiable", "fixed": list(found.fixed)}
            )
        write_motor(
            output,
            found.motor,
            intervals={name: one.ci95 for name, one in found.parameters.items() if one.ci95},
            remarks={name: f"fixed: {one.fixed}" for name, one in found.parameters.items() if one.fixed},
            heading=_heading(records, found),
        )
    if as_json:
        winding = found.motor.winding
        print_document(
            {
                **found.as_dict(),
                "winding": None if winding is None else asdict(winding),
                "output": str(output),
            }
        )
    else:
        results().print(commissioning_table(output, found))
        results().print(Text(f"{output} is written"), soft_wrap=True)
    for warning in found.warnings:
        print_warning(warning)


def check_output(output: Path, nameplate: Path, records: Sequence[Path]) -> None:
    """Raise CommandError (wrong use) where the output cannot be written or is one of the files read."""
    folder = output.parent
    if output.is_dir():
        found = "a folder; name the file in it"
    elif not folder.is_dir():
        found = f"no folder {folder}; make it first"
    elif not os.access(folder, os.W_OK):
        found = f"a folder {folder} that cannot be written to"
    elif any(_is_same(output, other) for other in (nameplate, *records)):
        found = "a file that is read; name another, so that what was known before is kept"
    else:
        return
    raise CommandError(
        f"--output {output}: expected a file to write the motor to, found {found}",
        details={"type": "OutputUnusable", "path": str(output)},
        exit_code=WRONG_USE,
    )


def _is_same(output: Path, read: Path) -> bool:
    """Tell whether two paths lead to the same file, or `output` to a part of the recording `read`."""
    one, other = output.resolve(), read.resolve()
    part = one.suffix.lower() != ".toml" and one.with_suffix("") == other.with_suffix("")
    return part or one == other or (one.exists() and other.exists() and one.samefile(other))


def _heading(records: Sequence[Path], found: Commissioning) -> str:
    lines = [f"Estimated by `mcc commission` from {', '.join(record.name for record in records)}"]
    lines += [
        f"{Path(start.record).name}: load level {start.load_level.value:.3f} ({found.load_law} torque), "
        f"{start.residual_share:.1%} of the current unexplained"
        for start in found.starts
    ]
    lines += [f"WARNING: {warning}" for warning in found.warnings]
    return "\n".join(lines)


def load_law(name: str) -> LoadLaw | None:
    """Return the law of the load of a name; None for the one that fits best."""
    return None if name == "auto" else LoadLaw[name.upper()]


def commissioning_table(output: Path, found: Commissioning) -> FittedTable:
    """Return what was found as a table. output: the file that it is written to, the table's title."""
    table = FittedTable(title=Text(output.name), title_justify="left")
    for heading in ("quantity", "value", "95 % interval", "remark"):
        table.add_column(heading, no_wrap=heading == "quantity")
    for name, one in found.parameters.items():
        table.add_row(
            name, plain(one.value, 5), _interval(one), Text(f"fixed: {one.fixed}" if one.fixed else "")
        )
    if found.change:
        table.add_section()
        table.add_row("from a start to running", "", "", "deep bars, leakage that saturates")
    for name, one in found.change.items():
        table.add_row(
            name, plain(one.value, 4), _interval(one), Text(f"fixed: {one.fixed}" if one.fixed else "")
        )
    winding, remark = winding_row(found.motor)
    table.add_row("stator winding", Text(winding), "", Text(remark))
    for start in found.starts:
        table.add_section()
        table.add_row("record", Text(Path(start.record).name), "", f"switched on at {start.onset_s:.4f} s")
        table.add_row(
            "load level", f"{start.load_level.value:.4f}", _interval(start.load_level), found.load_law
        )
        table.add_row(
            "time offset", f"{start.time_offset_s.value * 1e6:.1f} us", _interval(start.time_offset_s, 1e6)
        )
        table.add_row(
            "residual",
            f"{with_unit(start.residual_rms_A, 'A', 4)} rms",
            "",
            f"{start.residual_share:.2%} of the current",
        )
    table.add_section()
    table.add_row("effort", f"{found.evaluations} simulations", "", f"{found.compute_seconds:.1f} s")
    for warning in found.warnings:
        table.add_row("WARNING", "", "", Text(warning))
    for reason in found.reasons:
        if not reason.startswith(tuple(found.parameters)):
            table.add_row("mind", "", "", Text(reason))
    return table


def _interval(one: Estimate, scale: float = 1.0) -> str:
    return f"{plain(one.ci95[0] * scale, 5)} .. {plain(one.ci95[1] * scale, 5)}" if one.ci95 else ""


@contextmanager
def progress_bar() -> Iterator[Callable[[float, str], None]]:
    """Show a progress bar on stderr, if that is a terminal."""
    console = progress()
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading", total=1.0)
        yield lambda share, stage: bar.update(task, completed=share, description=stage)
