"""`mcc condition`, `note`, `notes`, `withdraw-note`, `restart-reference`: a motor over time and its notes."""

from collections.abc import Sequence
from itertools import islice
from typing import TYPE_CHECKING, cast

from rich.box import SIMPLE_HEAD
from rich.text import Text

from core.condition.events import ENDING
from core.error_words import one_line
from core.time_stamps import nanoseconds
from service.audit.acting import who_of
from service.cli.output import (
    READABLE_WIDTH,
    CommandError,
    facts_table,
    failing_clearly,
    print_document,
    print_warning,
    results,
)
from service.client.conditions import condition_lines, state_text
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.tables import FittedTable
from service.client.verdicts import level, local_time

if TYPE_CHECKING:
    from statorwatch_client.models import NoteRequest, RestartRequest, Withdrawal

MOST_CHANGES = 1000
"""So many changes are shown, the latest first."""


def show_condition(url: str, motor: str, *, history: bool, as_json: bool) -> None:
    """Print a motor's condition, and perhaps how it came to be. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        condition = service.get_condition(motor)
        changes = list(islice(service.list_condition_history(motor), MOST_CHANGES)) if history else []
        notes = {note["id"]: note for note in _notes(service, motor)} if history else {}
    if as_json:
        print_document({**condition, "changes": changes} if history else condition)
        return
    console = results()
    console.print(facts_table(condition_lines(condition), title=motor))
    if history:
        console.print(_history_table(changes, notes))


def add_note(
    url: str, motor: str, text: str, *, kind: str, time: str | None, on_behalf_of: str | None, as_json: bool
) -> None:
    """Tell something of a motor. Raises CommandError."""
    _require_words(text, "TEXT")
    said = {"kind": kind, "text": text, "on_behalf_of": on_behalf_of, "time": time}
    note = {name: value for name, value in said.items() if value is not None}
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        kept = service.add_note(motor, cast("NoteRequest", note))
        waits = _waits_for_a_record(service, kept)
    _print_kept(kept, waits=waits, as_json=as_json)


def list_notes(url: str, motor: str, *, as_json: bool) -> None:
    """Print what was told of a motor, latest first. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        notes = list(_notes(service, motor))
    if as_json:
        print_document({"notes": notes})
        return
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.kept = ("id",)
    for heading in ("time", "kind", "by"):
        table.add_column(heading)
    table.add_column("text", max_width=READABLE_WIDTH)
    table.add_column("id", no_wrap=True)
    for note in notes:
        text = one_line(str(note["text"]))
        if note["withdrawn_time"] is not None:
            who = who_of(note, "withdrawn_")
            text = one_line(f"{text} (withdrawn by {who}: {note['withdrawn_reason']})")
        table.add_row(
            local_time(note["time"]),
            Text(str(note["kind"])),
            Text(one_line(who_of(note))),
            Text(text),
            str(note["id"]),
        )
    results().print(table)


def restart_reference(
    url: str, motor: str, reason: str, *, time: str | None, on_behalf_of: str | None, as_json: bool
) -> None:
    """Have a motor's reference learnt anew. Raises CommandError."""
    _require_words(reason, "--reason")
    restart: RestartRequest = {"reason": reason}
    if on_behalf_of is not None:
        restart["on_behalf_of"] = on_behalf_of
    if time is not None:
        restart["time"] = time
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        kept = service.restart_reference(motor, restart)
        waits = _waits_for_a_record(service, kept)
    _print_kept(kept, waits=waits, as_json=as_json)


def withdraw_note(
    url: str, motor: str, note_id: str, reason: str, *, on_behalf_of: str | None, as_json: bool
) -> None:
    """Let a note that was wrong count no more. Raises CommandError."""
    _require_words(reason, "--reason")
    withdrawal: Withdrawal = {"reason": reason}
    if on_behalf_of is not None:
        withdrawal["on_behalf_of"] = on_behalf_of
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        note = service.withdraw_note(motor, note_id, withdrawal)
    if as_json:
        print_document(note)
        return
    words = f"{note['motor']}: {note['kind']} of {local_time(note['time'])} is withdrawn"
    results().print(Text(one_line(words)), soft_wrap=True)


def _notes(service: ServiceClient, motor: str) -> "islice[Document]":
    return islice(service.list_notes(motor, limit=1000), MOST_CHANGES)


def _history_table(changes: Sequence[Document], notes: dict[object, Document]) -> FittedTable:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("time", no_wrap=True)
    table.add_column("condition of the stator")
    table.add_column("level", no_wrap=True)
    table.add_column("because of", max_width=READABLE_WIDTH)
    for change in changes:
        note = notes.get(change["note_id"])
        if note is not None:
            because = f"{note['kind']}: {one_line(str(note['text']))} ({one_line(who_of(note))})"
        else:
            because = "a recording" if change["note_id"] is None else "a note"
        table.add_row(
            local_time(change["time"]),
            state_text(change),
            level(change["mu_f"], change["mu_f_ci95"]),
            Text(because),
        )
    return table


def _waits_for_a_record(service: ServiceClient, note: Document) -> bool:
    """Return whether a note ends the reference, and no record is later. Raises ServiceError."""
    if note["kind"] not in ENDING:
        return False
    as_of = service.get_condition(str(note["motor"]), history=0)["as_of"]
    return as_of is None or nanoseconds(str(as_of)) < nanoseconds(str(note["time"]))


def _print_kept(note: Document, *, waits: bool, as_json: bool) -> None:
    if as_json:
        print_document(note)
    else:
        words = f"{note['motor']}: {note['kind']} of {local_time(note['time'])} is noted"
        results().print(Text(one_line(words)), soft_wrap=True)
    if waits:
        print_warning(
            f"{note['motor']} has no record after that: its condition is judged anew from the next one on"
        )


def _require_words(text: str, what: str) -> None:
    if not text.strip():
        raise CommandError(f"{what}: expected a few words, found none")
