"""`mcc init`: the files of a new plant, from its list of motors, its SCL files or what its relays answer."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rich.text import Text

import scl
from core.error_words import one_line
from service.cli.output import WRONG_USE, CommandError, failing_clearly, print_document, progress, results
from service.configuration.settings import Settings
from service.plant import PlantError
from service.setup.addresses import host_and_port, is_address
from service.setup.check import check
from service.setup.draft import (
    MOST_RELAYS,
    Draft,
    draft_of_answers,
    draft_of_files,
    draft_of_scd,
    relays_to_ask,
)
from service.setup.motor_list import draft_of_list, write_list_template
from service.setup.motor_list_file import is_motor_list
from service.setup.new_plant import SETTINGS, write_plant
from service.setup.relay_survey import RelaySurvey, survey

SCL_SUFFIXES = (".scd", ".cid", ".iid", ".icd", ".ssd", ".sed", ".xml")


def init_plant(directory: Path, sources: Sequence[str], *, as_json: bool) -> None:
    """Write the files. Raises CommandError where a source cannot be used, or a file is there already."""
    with failing_clearly(scl.SclError, PlantError, OSError):
        draft = _draft(sources)
        written = write_plant(directory, draft)
    problems = check(directory / SETTINGS).problems
    if as_json:
        print_document(
            {
                "written": [str(path) for path in written],
                "relays": [relay.name for relay in draft.relays],
                "left_out": list(draft.left_out),
                "to_fill_in": [str(problem) for problem in problems],
            }
        )
        return
    console = results()
    for path in written:
        console.print(Text(f"wrote {path}"), soft_wrap=True)
    for words in draft.left_out:
        console.print(Text(f"left out: {one_line(words)}"), soft_wrap=True)
    console.print(
        Text(
            f"{_counted(draft)}; {len(problems)} values to fill in: "
            f"mcc check --config {directory / SETTINGS} names them"
        ),
        soft_wrap=True,
    )


def write_template(path: Path, *, as_json: bool) -> None:
    """Write an empty list of motors. Raises CommandError where it cannot be written."""
    with failing_clearly(PlantError, OSError):
        write_list_template(path)
    if as_json:
        print_document({"written": [str(path)]})
        return
    words = f"wrote {path}: fill in a row for each motor, then: mcc init DIR {path}"
    results().print(Text(words), soft_wrap=True)


def _counted(draft: Draft) -> str:
    number = len(draft.relays)
    return f"{number} relays" if number > 1 else f"{number or 'example'} relay"


def _draft(sources: Sequence[str]) -> Draft:
    files = [source for source in sources if _is_file(source)]
    if not files:
        return _asked(sources)
    if len(files) < len(sources):
        raise CommandError(
            "expected a list of motors, SCL files, or addresses of relays, found several kinds",
            details={"type": "WrongUse"},
            exit_code=WRONG_USE,
        )
    if len(files) == 1 and is_motor_list(Path(files[0])):
        return draft_of_list(Path(files[0]))
    if len(files) == 1 and not _is_scl(Path(files[0])):
        return _asked(_listed(Path(files[0])))
    read, unreadable = _read(files)
    if len(read) == 1 and (read[0].feeders() or len(read[0].ieds) > 1):
        draft = draft_of_scd(read[0])
    else:
        draft = draft_of_files(read)
    return replace(draft, left_out=(*draft.left_out, *unreadable))


def _read(files: Sequence[str]) -> tuple[list[scl.Scl], list[str]]:
    """Read SCL files, and say of those that cannot be read why. Raises SclError where none can."""
    read: list[scl.Scl] = []
    errors: list[scl.SclError] = []
    for file in files:
        try:
            read.append(scl.read(file))
        except scl.SclError as error:
            errors.append(error)
    if not read:
        raise errors[0]
    return read, [str(error) for error in errors]


def _is_file(source: str) -> bool:
    return Path(source).exists() or Path(source).suffix.lower() in SCL_SUFFIXES or "/" in source


def _is_scl(path: Path) -> bool:
    """Tell whether a file is meant to be SCL, by its name or its beginning; others list addresses."""
    if path.suffix.lower() in SCL_SUFFIXES or not path.is_file():
        return True
    with path.open("rb") as file:
        return file.read(200).lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


def _listed(path: Path) -> list[str]:
    """Return the addresses that a text file lists, one a line; # begins a comment."""
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise _no_source(path, "another kind of file") from error
    lines = [line.partition("#")[0].strip() for line in text.splitlines()]
    addresses = [line for line in lines if line]
    for line in addresses:
        if not is_address(line):
            raise _no_source(path, repr(line[:60]))
    return addresses


def _no_source(path: Path, found: str) -> CommandError:
    """Return the error of a file that is neither SCL nor a list of addresses."""
    return CommandError(
        f"{path}: expected an SCL file, or a list of relays' addresses, one a line, such as 10.20.1.11 or "
        f"10.20.1.11:102, found {found}",
        details={"type": "WrongUse"},
        exit_code=WRONG_USE,
    )


def _asked(sources: Sequence[str]) -> Draft:
    """Ask the relays at these addresses what they are."""
    addresses = [_address(source) for source in sources]
    if len(addresses) > MOST_RELAYS:
        raise CommandError(f"expected at most {MOST_RELAYS} addresses, found {len(addresses)}")
    relays = relays_to_ask(dict.fromkeys(addresses))
    return draft_of_answers(survey(relays, Settings(), _tell))


def _tell(answer: RelaySurvey) -> None:
    words = "answers" if answer.unreachable is None else f"does not answer: {answer.unreachable}"
    progress().print(Text(one_line(f"{answer.relay.host}:{answer.relay.port}: {words}")), soft_wrap=True)


def _address(text: str) -> scl.Address:
    """Read an address. Raises CommandError."""
    if not is_address(text):
        raise CommandError(
            f"expected a file, or an address such as 10.20.1.11 or 10.20.1.11:102, found {text[:60]!r}",
            details={"type": "WrongUse"},
            exit_code=WRONG_USE,
        )
    host, port = host_and_port(text)
    return scl.Address(host) if port is None else scl.Address(host, port)
