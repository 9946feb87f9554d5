"""`mcc commission --from-service`: a motor's parameters from starts that a service recorded."""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.text import Text

from core.commissioning.commissioning import commission
from core.commissioning.errors import CommissioningError
from core.commissioning.result import Commissioning
from core.error_words import nearest
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import Plate, plate_from_table
from core.recordings import RecordingError
from service.cli.output import (
    WRONG_USE,
    CommandError,
    failing_clearly,
    print_document,
    print_warning,
    results,
)
from service.cli.recordings.commission import commissioning_table, load_law, progress_bar
from service.cli.recordings.recorded_starts import FetchedStarts, fetch_starts
from service.client.rest_client import ServiceClient, ServiceError
from service.configuration.problems import Problems
from service.plant import PlantError
from service.plant.motors_file import read_motors_file
from service.plant.motors_file_edit import EstimatedParameters, MotorsFileEdit, with_parameters

MOST_UNEXPLAINED = 0.2
"""Share of the current that the fitted motor may leave; beyond it the parameters are not the motor's."""

HOW_TO_TAKE_THEM = (
    "The service reads the motors file when it starts: restart mcc serve. It notes the change of parameters "
    "with the motor, and judges its records by them from then on."
)


def commission_from_service(
    url: str,
    motor: str,
    motors_file: Path,
    *,
    recordings: Sequence[str],
    load: str,
    despite_warnings: bool,
    as_json: bool,
) -> None:
    """Fetch the starts, estimate the parameters and write them into the motor's table of the motors file.

    recordings: ids of those to be used; the latest starts if there are none.

    Raises CommandError, and writes nothing, where no start can be used, the parameters do not hold, or the
    file cannot be written.
    """
    with ExitStack() as stack:
        stack.enter_context(
            failing_clearly(
                ServiceError, PlantError, RecordingError, MotorFileError, CommissioningError, OSError
            )
        )
        plate = plate_of(motors_file, motor)
        service = stack.enter_context(ServiceClient(url))
        folder = Path(stack.enter_context(TemporaryDirectory(prefix="mcc-starts-")))
        starts = fetch_starts(service, plate, recordings, folder)
        with progress_bar() as advance:
            found = commission(
                [start.recording for start in starts.used],
                plate,
                load_law=load_law(load),
                progress=advance,
            )
        require_that_it_holds(found, despite_warnings=despite_warnings)
        edit = with_parameters(motors_file, motor, _estimated(found, starts))
        edit.write()
    _print(found, starts, edit, as_json=as_json)


def plate_of(motors_file: Path, motor: str) -> Plate:
    """Return what the motors file says of a motor. Raises CommandError, PlantError, MotorFileError."""
    motors = read_motors_file(motors_file, Problems()).motors
    entry = motors.get(motor)
    if entry is None:
        meant = nearest(motor, motors)
        raise CommandError(
            f"{motors_file}: expected a [[motor]] table of {motor}, found {', '.join(motors) or 'none'}"
            + ("" if meant is None else f" (did you mean {meant}?)"),
            details={"type": "MotorUnknown", "motor": motor},
            exit_code=WRONG_USE,
        )
    return plate_from_table(entry.data, name=motor, source=motors_file)


def require_that_it_holds(found: Commissioning, *, despite_warnings: bool) -> None:
    """Raise CommandError for parameters that no plant should be watched with."""
    if not found.identifiable:
        raise CommandError(found.reasons[0], details={"type": "NotIdentifiable", "fixed": list(found.fixed)})
    for start in found.starts:
        left = start.residual_share
        if left > MOST_UNEXPLAINED:
            raise CommandError(
                f"{Path(start.record).name}: expected parameters that leave at most {MOST_UNEXPLAINED:.0%} "
                f"of the current unexplained, found {left:.0%}: they are not written; is it a start of this "
                "motor, and is its nameplate right?",
                details={"type": "NotExplained", "residual_share": left},
            )
    if found.warnings and not despite_warnings:
        raise CommandError(
            f"the parameters are not written: {'; '.join(found.warnings)} (--despite-warnings writes them)",
            details={"type": "Unusual", "warnings": list(found.warnings)},
        )


def _estimated(found: Commissioning, starts: FetchedStarts) -> EstimatedParameters:
    used = ", ".join(start.time for start in starts.used)
    return EstimatedParameters(
        values=asdict(found.motor.parameters),
        intervals={name: one.ci95 for name, one in found.parameters.items() if one.ci95},
        remarks={name: f"fixed: {one.fixed}" for name, one in found.parameters.items() if one.fixed},
        origin=f"by mcc commission, from the start{'s' if len(starts.used) > 1 else ''} of {used}",
        change={
            table: asdict(what)
            for table, what in (
                ("deep_bars", found.motor.deep_bars),
                ("leakage_saturation", found.motor.leakage_saturation),
            )
            if what is not None
        },
    )


def _print(found: Commissioning, starts: FetchedStarts, edit: MotorsFileEdit, *, as_json: bool) -> None:
    if as_json:
        print_document(
            {
                **found.as_dict(),
                "recordings": [start.id for start in starts.used],
                "left_out": list(starts.left_out),
                "output": str(edit.path),
                "backup": str(edit.backup),
                "diff": edit.diff(),
            }
        )
    else:
        console = results()
        console.print(commissioning_table(edit.path, found))
        console.print(Text(edit.diff()), soft_wrap=True)
        console.print(Text(f"{edit.path} is written; as it was: {edit.backup}"), soft_wrap=True)
        console.print(Text(HOW_TO_TAKE_THEM), soft_wrap=True)
    for one in starts.left_out:
        print_warning(f"not used: {one}")
    for warning in found.warnings:
        print_warning(warning)
