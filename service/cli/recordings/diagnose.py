"""`mcc diagnose`: the verdict of one recording of one motor, without a service."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from rich.text import Text

from core.diagnosis.errors import DiagnosisError
from core.diagnosis.phase_words import turns_phase_in_words
from core.diagnosis.stator import learn_baseline
from core.diagnosis.verdict import Diagnosis
from core.findings.examining import examine
from core.findings.findings import Findings
from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.reader import read_motor
from core.machines.motor_tables import layout_of
from core.machines.parameters import ParametersSource
from core.machines.typical import COMMISSION
from core.quantity_text import with_unit
from core.recordings import RecordingError
from core.speed.memory import LineMemory
from service.cli.output import WRONG_USE, CommandError, failing_clearly, print_document, results
from service.cli.recordings.files import read_recording, with_advice
from service.cli.recordings.given_columns import NOTHING_GIVEN, GivenColumns, with_given_columns
from service.client.classification import answer_rows
from service.client.losses import loss_words
from service.client.rotor_and_supply import (
    gap_words,
    rotor_words,
    sideband_words,
    supply_words,
    swing_words,
)
from service.client.speed import speed_words
from service.client.tables import FittedTable
from service.client.verdicts import OPERATIONS, detection, interval, level, load, verdict_text


def diagnose_recording(
    record: Path,
    motor: Path | None,
    *,
    method: str,
    model: str,
    baseline: Sequence[Path],
    currents_only: bool,
    lenient: bool,
    report: int | None,
    as_json: bool,
    given: GivenColumns = NOTHING_GIVEN,
) -> None:
    """Read a recording, diagnose it and print the result, with what a lenient reader repaired as reasons.

    The result names the motor's file, which may be one found beside the recording.

    given: what the command line says of a table's columns.
    baseline: healthy recordings of the same motor, whose standing asymmetry is subtracted.

    Raises CommandError where the recording or the motor file cannot be used, or the method is not known.
    """
    with (
        failing_clearly(RecordingError, MotorFileError, OSError),
        failing_clearly(DiagnosisError, exit_code=WRONG_USE),
    ):
        if not record.is_file():
            read_recording(record, lenient=lenient)  # which says so, before a motor file that is not there
        motor_file = motor or _motor_file_beside(record)
        found = with_given_columns(read_motor(motor_file), given)
        layout = layout_of(found)
        recording = read_recording(record, lenient=lenient, layout=layout, report=report)
        healthy = [read_recording(one, lenient=lenient, layout=layout) for one in baseline]
        with _naming_currents_only():
            examined = examine(
                recording,
                found,
                method=method,
                model=model,
                baseline=learn_baseline(healthy, found, currents_only=currents_only) if healthy else None,
                currents_only=currents_only,
                lines=LineMemory(found.nameplate.rotor_bars),
            )
    repaired = (f"repaired: {note}" for note in recording.repairs)
    diagnosis = examined.diagnosis
    diagnosis = replace(diagnosis, reasons=(*diagnosis.reasons, *repaired))
    examined = replace(examined, diagnosis=diagnosis)
    if as_json:
        source = str(found.parameters_source)
        print_document({**examined.as_dict(), "motor_file": str(motor_file), "parameters_source": source})
    else:
        results().print(_table(record, motor_file, found.parameters_source, examined))


@contextmanager
def _naming_currents_only() -> Iterator[None]:
    """Name the option that does without voltages where they are what is missing."""
    try:
        yield
    except RecordingError as error:
        if error.field != "voltages":
            raise
        raise with_advice(
            error, "--currents-only does without: it assumes a balanced supply, and says watch at most"
        ) from error


def _motor_file_beside(record: Path) -> Path:
    candidates = (record.with_suffix(".toml"), record.with_name("motor.toml"))
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    raise CommandError(
        f"{record.name}: which motor is it? Name its file with --motor MOTOR.toml, "
        f"or put {candidates[0].name} or {candidates[1].name} beside the recording",
        details={"type": "MotorUnknown", "path": str(record)},
        exit_code=WRONG_USE,
    )


def _verdict(diagnosis: Diagnosis) -> Text:
    """Return the verdict; where the motor does not run all the time, what the recording shows instead."""
    verdict = verdict_text(diagnosis.verdict)
    does = OPERATIONS.get(str(diagnosis.operation))
    return verdict if does is None else verdict.append(f" (the recording shows {does})")


def _table(record: Path, motor_file: Path, source: ParametersSource, examined: Findings) -> FittedTable:
    diagnosis = examined.diagnosis
    table = FittedTable(title=Text(record.name), title_justify="left", show_header=False)
    table.add_row("verdict", _verdict(diagnosis))
    if diagnosis.mu_f is not None:
        table.add_row("equivalent fault level", level(diagnosis.mu_f, diagnosis.mu_f_ci95))
        table.add_row("detection limit", detection(diagnosis.detection_limit))
    phase = turns_phase_in_words(diagnosis.as_dict())
    if phase:
        table.add_row("phase", phase)
    if diagnosis.load_level is not None:
        table.add_row("load level", load(diagnosis.load_level, diagnosis.load_level_ci95))
    for reason in diagnosis.reasons:
        table.add_row("reason", Text(reason))
    if diagnosis.mu_f_scatter95 is not None:
        table.add_row(
            "scatter of the level", f"{interval(diagnosis.mu_f_scatter95)} % (95 %, this record's own)"
        )
    if diagnosis.residual_rms_A is not None:
        table.add_row("residual", f"{with_unit(diagnosis.residual_rms_A, 'A', 4)} rms")
    _add_what_is_beside(table, examined)
    for name, words in answer_rows(examined.classification.as_dict()):
        table.add_row(name, Text(words))
    table.add_row("model, method", f"{diagnosis.model}, {diagnosis.method}")
    table.add_row("effort", f"{diagnosis.evaluations} evaluations, {diagnosis.compute_seconds:.3f} s")
    table.add_row("motor file", Text(str(motor_file)))
    needs = f"; {COMMISSION}" if source is ParametersSource.TYPICAL else ""
    table.add_row("parameters", f"{source}{needs}")
    for finding in diagnosis.quality:
        if not finding.passed and not any(finding.message in reason for reason in diagnosis.reasons):
            table.add_row("quality", Text(finding.message))
    for finding in diagnosis.quality:
        if finding.is_warning:
            table.add_row("warning", Text(finding.message))
    table.add_row("checks passed", str(sum(finding.passed for finding in diagnosis.quality)))
    return table


def _add_what_is_beside(table: FittedTable, examined: Findings) -> None:
    rotor = examined.rotor
    for words in speed_words(examined.speed):
        table.add_row("speed", Text(words))
    table.add_row("rotor", Text(rotor_words(rotor)))
    sidebands = sideband_words(rotor)
    if sidebands is not None:
        table.add_row("sidebands", Text(sidebands))
    for reason in rotor.reasons:
        table.add_row("rotor because", Text(reason))
    gap = gap_words(examined.eccentricity)
    if gap is not None:
        table.add_row("air gap", Text(gap))
    for words in swing_words(examined.eccentricity, examined.pulsation):
        table.add_row("load", Text(words))
    if examined.supply is not None:
        for words in supply_words(examined.supply):
            table.add_row("supply", Text(words))
        for words in loss_words(examined.losses):
            table.add_row("losses", Text(words))
