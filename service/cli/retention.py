"""`mcc retention`: what the rules of the settings would delete, and deleting it now."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.text import Text
from sqlalchemy.exc import SQLAlchemyError

from core.units import NANOSECONDS_PER_SECOND
from service.cli.audit.actor import command_line_actor
from service.cli.output import failing_clearly, print_document, progress, results
from service.client.tables import FittedTable
from service.configuration.settings import Settings, SettingsError
from service.recording_store.opening import open_store
from service.recording_store.store import RecordingStore
from service.recording_store.unknown_folders import APART, Folder
from service.retention.batches import Batches, Pace
from service.retention.deletion import remove_discarded_folders
from service.retention.reasons import WORDS
from service.retention.rules import Rule, rules
from service.retention.unknown_folders import KEPT_DAYS, UnknownFolderSweep
from service.storage import Repository, StorageError, connect
from service.storage.migrations import require_current_tables
from service.storage.records import Amount, OldRecording

MB = 1e6
UNTIL_DONE = Pace(round_s=float("inf"))


@dataclass(frozen=True, slots=True)
class Outcome:
    """A rule, what there was to delete, and how much of it was deleted; None in a dry run.

    listed: the recordings that the rule is for, also those that stay.
    """

    rule: Rule
    amount: Amount
    deleted: int | None
    listed: tuple[OldRecording, ...] = ()


def apply_retention(config: Path | None, *, dry_run: bool, each: bool = False, as_json: bool) -> None:
    """Print what every rule would delete and, unless it is a dry run, delete that. Raises CommandError.

    each: print each recording too, with the reason why it goes or stays.
    """
    with failing_clearly(SettingsError, StorageError, SQLAlchemyError, OSError):
        settings = Settings.load(config)
        require_current_tables(settings.database_url)
        engine = connect(settings.database_url)
        try:
            repository = Repository(engine)
            store = open_store(settings, "retention")
            outcomes = _outcomes(settings, repository, store, dry_run=dry_run, each=each)
            unknown = _unknown_folders(store, repository, dry_run=dry_run)
        finally:
            engine.dispose()
    if as_json:
        folders = {"number": len(unknown), "bytes": _size_bytes(unknown), "moved": not dry_run}
        print_document(
            {
                "dry_run": dry_run,
                "rules": [_document(outcome) for outcome in outcomes],
                **({"recordings": list(_recordings(outcomes))} if each else {}),
                "unknown_folders": folders,
            }
        )
        return
    _print_table(outcomes, dry_run=dry_run)
    for recording in _recordings(outcomes):
        results().print(Text(_line(recording)), soft_wrap=True)
    if unknown:
        _print_unknown(unknown, dry_run=dry_run)


def _outcomes(
    settings: Settings, repository: Repository, store: RecordingStore, *, dry_run: bool, each: bool
) -> list[Outcome]:
    outcomes = []
    batches = Batches(UNTIL_DONE)
    for rule in rules(settings, repository, time.time_ns(), command_line_actor()):
        amount = rule.amount()
        listed = tuple(rule.listed()) if each else ()
        deleted = None
        if not dry_run:
            if amount.rows:
                progress().print(f"{rule.setting}: deleting {amount.rows} rows")
            deleted = rule.forget(batches)
        outcomes.append(Outcome(rule, amount, deleted, listed))
    if not dry_run:
        remove_discarded_folders(repository, store, time.time_ns())
    return outcomes


def _unknown_folders(store: RecordingStore, repository: Repository, *, dry_run: bool) -> list[Folder]:
    """Return the folders that the database does not know and, unless it is a dry run, move them apart."""
    now_s = time.time()
    sweep = UnknownFolderSweep(repository, store.unknown)
    unknown = sweep.unknown(now_s)
    if not dry_run:
        sweep.sweep(now_s)
    return unknown


def _size_bytes(folders: list[Folder]) -> int:
    return sum(folder.size_bytes for folder in folders)


def _print_unknown(unknown: list[Folder], *, dry_run: bool) -> None:
    what = f"folders of the recording store that the database does not know: {len(unknown)}"
    done = (
        "" if dry_run else f", moved to its folder {APART}, where they are deleted after {KEPT_DAYS:g} days"
    )
    results().print(Text(f"{what}, {_size_bytes(unknown) / MB:.1f} MB{done}"), soft_wrap=True)


def _print_table(outcomes: list[Outcome], *, dry_run: bool) -> None:
    table = FittedTable(box=SIMPLE_HEAD, collapse_padding=True)
    table.add_column("rule", no_wrap=True)
    for heading in ("days", "rows" if dry_run else "deleted", "MB"):
        table.add_column(heading, justify="right")
    for heading in ("oldest", "newest"):
        table.add_column(heading)
    for outcome in outcomes:
        if outcome.rule.days is None:
            continue
        amount = outcome.amount
        table.add_row(
            outcome.rule.setting,
            f"{outcome.rule.days:g}",
            str(amount.rows if outcome.deleted is None else outcome.deleted),
            f"{amount.size_bytes / MB:.1f}",
            _time(amount.oldest_ns) or "-",
            _time(amount.newest_ns) or "-",
        )
    results().print(table)
    keeping = [outcome.rule.setting for outcome in outcomes if outcome.rule.days is None]
    if keeping:
        results().print(Text(f"not set, so all is kept: {', '.join(keeping)}"), soft_wrap=True)


def _document(outcome: Outcome) -> dict[str, object]:
    return {
        "rule": outcome.rule.setting,
        "days": outcome.rule.days,
        "rows": outcome.amount.rows,
        "bytes": outcome.amount.size_bytes,
        "oldest": _time(outcome.amount.oldest_ns),
        "newest": _time(outcome.amount.newest_ns),
        "deleted": outcome.deleted,
    }


def _recordings(outcomes: list[Outcome]) -> Iterator[Mapping[str, object]]:
    """Yield each recording that a rule is for, with what becomes of it and why."""
    for outcome in outcomes:
        for one in outcome.listed:
            older = f"older than {outcome.rule.setting} = {outcome.rule.days:g}"
            yield {
                "motor": one.motor,
                "recording": one.id,
                "name": one.name,
                "seen": _time(one.announced_ns),
                "recorded": _time(one.recorded_ns),
                "bytes": one.size_bytes,
                "rule": outcome.rule.setting,
                "goes": one.stays is None,
                "reason": older if one.stays is None else WORDS[one.stays],
                "stays_for": one.stays,
            }


def _line(recording: Mapping[str, object]) -> str:
    time = recording["recorded"] or recording["seen"]
    outcome = "goes" if recording["goes"] else "stays"
    return f"{outcome:5}  {recording['motor']}  {time}  {recording['recording']}  {recording['reason']}"


def _time(time_ns: int | None) -> str | None:
    """Return a time as RFC 3339, to the second."""
    if time_ns is None:
        return None
    return f"{datetime.fromtimestamp(time_ns // NANOSECONDS_PER_SECOND, UTC):%Y-%m-%dT%H:%M:%SZ}"
