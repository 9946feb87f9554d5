"""`mcc check`: all that is wrong in the files of a plant, and what its relays offer."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
from rich.text import Text

from core.error_words import one_line
from mms import mbed_tls_version
from service.cli.output import DONE, FAILED, print_document, progress, results
from service.cli.plant.windings import proposals, winding_document
from service.setup.check import CheckedPlant, check
from service.setup.relay_survey import RelaySurvey, survey

TIME_ZONE = "if it runs in local time, set time_zone"
QUARTER_S, ZONE_TOLERANCE_S = 900.0, 60.0
"""Time zones differ by quarters of an hour."""

CLOCK_S = 2.0
"""The clock of each relay is looked at for so long."""

LATE_S = 1.0
"""A clock that is further off is told in the line of its relay."""


def check_plant(config: Path | None, *, connect: bool, as_json: bool) -> int:
    """Check the files and print what is wrong; ask the relays if `connect`. Returns the exit code."""
    checked = check(config)
    answers: tuple[RelaySurvey, ...] = ()
    if connect and checked.plant is not None and checked.settings is not None:
        relays = checked.plant.relays
        with _progress_bar(len(relays)) as advance:
            answers = survey(relays, checked.settings, advance, clock_s=CLOCK_S)
    if as_json:
        print_document(_document(checked, answers))
    else:
        _print(checked, answers)
    unreachable = any(answer.unreachable is not None for answer in answers)
    return FAILED if checked.problems or unreachable else DONE


@contextmanager
def _progress_bar(relays: int) -> Iterator[Callable[[RelaySurvey], None]]:
    """Show a progress bar on stderr, if that is a terminal, with the relay that answered last."""
    console = progress()
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        asked = bar.add_task("asking the relays", total=relays)
        yield lambda answer: bar.update(asked, advance=1, description=f"asked {answer.relay.name}")


def _print(checked: CheckedPlant, answers: tuple[RelaySurvey, ...]) -> None:
    console = results()
    for problem in checked.problems:
        console.print(Text(one_line(str(problem))), soft_wrap=True)
    for warning in checked.warnings:
        console.print(Text(f"warning: {one_line(warning)}", style="yellow"), soft_wrap=True)
    for answer in answers:
        console.print(Text(line_of(answer)), soft_wrap=True)
    if checked.plant is not None and not checked.problems:
        for proposal in proposals(checked.plant.motors):
            console.print(Text(f"note: {one_line(proposal)}"), soft_wrap=True)
    silent = sum(answer.unreachable is not None for answer in answers)
    if silent:
        console.print(Text(f"{silent} of {_number(len(answers), 'relay')} did not answer"))
    if checked.problems:
        console.print(Text(f"{_number(len(checked.problems), 'problem')}: mcc serve would not start"))
    elif checked.plant is not None:
        plant = checked.plant
        number = len(checked.warnings)
        where = " in the files" if silent else ""
        said = (
            f"{_number(number, 'warning')}; mcc serve would start" if number else f"nothing is wrong{where}"
        )
        numbers = ((plant.motors, "motor"), (plant.relays, "relay"), (plant.sites, "site"))
        words = ", ".join(_number(len(found), what) for found, what in numbers)
        console.print(Text(f"TLS to relays: Mbed TLS {mbed_tls_version() or 'of unknown version'}"))
        console.print(Text(f"{said}: {words}"))


def _number(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def line_of(answer: RelaySurvey) -> str:
    """Return what a relay offers, in one line."""
    relay, found = answer.relay, answer.acquisition
    name = f"{relay.name} at {relay.host}:{relay.port}"
    if answer.unreachable is not None or found is None:
        return one_line(f"{name}: does not answer: {answer.unreachable}")
    plate = " ".join((answer.name_plate or {}).values())
    words = [
        "answers" + (f" as {plate}" if plate else ""),
        f"trigger {found.trigger}" if found.trigger else f"no trigger: {found.no_trigger}",
        f"reports {found.report_controls[0]}" if found.report_controls else "no reports: it is polled",
        f"{answer.recordings} recordings in {answer.folder}" if answer.folder else f"{answer.no_folder}",
        _clock(answer),
    ]
    if answer.text_reports:
        words.insert(-1, f"text reports {', '.join(answer.text_reports)}")
    if answer.differences:
        words.append(f"{answer.differences} names differ from its SCL file")
    return one_line(f"{name}: {'; '.join(words)}")


def _clock(answer: RelaySurvey) -> str:
    """Return how far the clock of a relay is off, as far as it can be seen."""
    offset_s, age_s = answer.clock_offset_s, answer.stamp_age_s
    if offset_s is None and age_s is None:
        return "it does not tell its clock"
    if offset_s is None and age_s is not None and age_s >= 0.0:
        return _clock_by_old_stamp(age_s)
    if offset_s is None:
        offset_s = -(age_s or 0.0)
    if abs(offset_s) < LATE_S:
        return "its clock agrees with this one"
    off = f"its clock is {abs(offset_s):.1f} s {'ahead of' if offset_s > 0 else 'behind'} this one"
    return f"{off}: {TIME_ZONE}" if _is_of_a_zone(offset_s) else off


def _clock_by_old_stamp(age_s: float) -> str:
    """Return what a stamp tells that is no news: it may be old because its value has not changed."""
    stamp = f"its latest time stamp is {age_s:.0f} s old and no value has changed meanwhile"
    if age_s < ZONE_TOLERANCE_S:
        return f"its clock agrees as far as can be seen ({stamp})"
    zone = f"; {TIME_ZONE}" if _is_of_a_zone(age_s) else ""
    return f"its clock cannot be seen ({stamp}; it may be behind this one{zone})"


def _is_of_a_zone(offset_s: float) -> bool:
    quarters = round(offset_s / QUARTER_S)
    return quarters != 0 and abs(offset_s - quarters * QUARTER_S) < ZONE_TOLERANCE_S


def _document(checked: CheckedPlant, answers: tuple[RelaySurvey, ...]) -> dict[str, object]:
    plant = checked.plant
    return {
        "problems": [{**problem.document(), "message": str(problem)} for problem in checked.problems],
        "warnings": list(checked.warnings),
        "motors": [] if plant is None else [motor.name for motor in plant.motors],
        "windings": [] if plant is None else [winding_document(motor) for motor in plant.motors],
        "relays": [] if plant is None else [relay.name for relay in plant.relays],
        "mbed_tls": mbed_tls_version(),
        "asked": [_answer_document(answer) for answer in answers],
    }


def _answer_document(answer: RelaySurvey) -> dict[str, object]:
    found = answer.acquisition
    return {
        "relay": answer.relay.name,
        "host": answer.relay.host,
        "port": answer.relay.port,
        "reachable": answer.unreachable is None,
        "reason": answer.unreachable,
        "name_plate": dict(answer.name_plate or {}),
        "logical_devices": [] if answer.offer is None else list(answer.offer.devices),
        "trigger": None if found is None else found.trigger,
        "report_control": next(iter(() if found is None else found.report_controls), None),
        "differences": answer.differences,
        "folder": answer.folder,
        "recordings": answer.recordings,
        "text_reports": list(answer.text_reports),
        "clock_offset_s": answer.clock_offset_s,
        "stamp_age_s": answer.stamp_age_s,
    }
