"""`mcc commission`: recordings of a motor's starts in, the motor's file out; no service needed."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

from core.commissioning.commissioning import commission
from core.commissioning.errors import CommissioningError
from core.commissioning.result import Commissioning, Estimate
from core.machines.candidates import LoadLaw
from core.machines.motor_file import MotorFileError, read_plate
from core.machines.motor_file_writer import write_motor
from core.recordings import RecordingError, read
from service.cli.output import CommandError, failing_clearly, print_document, progress, results


def commission_motor(
    records: Sequence[Path], nameplate: Path, output: Path, *, load: str, as_json: bool
) -> None:
    """Read, estimate, write, print.

    Raises CommandError where a recording is no start or cannot be read, where the motor's file cannot be used
    or written, or where the recordings tell no parameter at all: then nothing is written.
    """
    law = None if load == "auto" else LoadLaw[load.upper()]
    with failing_clearly(RecordingError, MotorFileError, CommissioningError, OSError):
        plate = read_plate(nameplate)
        recordings = [read(record) for record in records]
        with _bar() as advance:
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
        print_document({**found.as_dict(), "output": str(output)})
    else:
        results().print(_table(output, found))


def _heading(records: Sequence[Path], found: Commissioning) -> str:
    lines = [f"Estimated by `mcc commission` from {', '.join(record.name for record in records)}"]
    lines += [
        f"{Path(start.record).name}: load level {start.load_level.value:.3f} ({found.load_law} torque), "
        f"{start.residual_share:.1%} of the current unexplained"
        for start in found.starts
    ]
    return "\n".join(lines)


def _table(output: Path, found: Commissioning) -> Table:
    table = Table(title=Text(output.name), title_justify="left")
    for heading in ("quantity", "value", "95 % interval", "remark"):
        table.add_column(heading)
    for name, one in found.parameters.items():
        table.add_row(
            name, f"{one.value:.5g}", _interval(one), Text(f"fixed: {one.fixed}" if one.fixed else "")
        )
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
            "residual", f"{start.residual_rms_A:.4g} A rms", "", f"{start.residual_share:.2%} of the current"
        )
    table.add_section()
    table.add_row("effort", f"{found.evaluations} simulations", "", f"{found.compute_seconds:.1f} s")
    table.add_row("written", Text(str(output)))
    for reason in found.reasons:
        if not reason.startswith(tuple(found.parameters)):
            table.add_row("mind", "", "", Text(reason))
    return table


def _interval(one: Estimate, scale: float = 1.0) -> str:
    return f"{one.ci95[0] * scale:.5g} .. {one.ci95[1] * scale:.5g}" if one.ci95 else ""


@contextmanager
def _bar() -> Iterator[Callable[[float, str], None]]:
    """A bar on stderr while the work lasts; nothing where nobody watches."""
    console = progress()
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading", total=1.0)
        yield lambda share, stage: bar.update(task, completed=share, description=stage)
