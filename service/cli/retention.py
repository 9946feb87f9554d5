"""`mcc retention`: what the rules of the settings would delete, and deleting it now."""

import time
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.table import Table
from rich.text import Text
from sqlalchemy.exc import SQLAlchemyError

from core.units import NANOSECONDS_PER_SECOND
from service.cli.output import failing_clearly, print_document, progress, results
from service.configuration.settings import Settings, SettingsError
from service.recording_store.store import RecordingStore
from service.retention.batches import Batches, Pace
from service.retention.deletion import remove_discarded_folders
from service.retention.rules import Rule, rules
from service.storage import Repository, StorageError, connect
from service.storage.records import Amount

MB = 1e6
UNTIL_DONE = Pace(round_s=float("inf"))


@dataclass(frozen=True, slots=True)
class Outcome:
    """A rule, what there was to delete, and how much of it was deleted; None in a dry run."""

    rule: Rule
    amount: Amount
    deleted: int | None


def apply_retention(config: Path | None, *, dry_run: bool, as_json: bool) -> None:
    """Print what every rule would delete and, unless it is a dry run, delete that. Raises CommandError."""
    with failing_clearly(SettingsError, StorageError, SQLAlchemyError, OSError):
        settings = Settings.load(config)
        engine = connect(settings.database_url)
        try:
            outcomes = _outcomes(settings, Repository(engine), dry_run=dry_run)
        finally:
            engine.dispose()
    if as_json:
        print_document({"dry_run": dry_run, "rules": [_document(outcome) for outcome in outcomes]})
        return
    _print_table(outcomes, dry_run=dry_run)


def _outcomes(settings: Settings, repository: Repository, *, dry_run: bool) -> list[Outcome]:
    outcomes = []
    batches = Batches(UNTIL_DONE)
    for rule in rules(settings, repository, time.time_ns()):
        amount = rule.amount()
        deleted = None
        if not dry_run:
            if amount.rows:
                progress().print(f"{rule.setting}: deleting {amount.rows} rows")
            deleted = rule.forget(batches)
        outcomes.append(Outcome(rule, amount, deleted))
    if not dry_run:
        remove_discarded_folders(repository, RecordingStore(settings.recordings_directory, "retention"))
    return outcomes


def _print_table(outcomes: list[Outcome], *, dry_run: bool) -> None:
    table = Table(box=SIMPLE_HEAD, collapse_padding=True)
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


def _time(time_ns: int | None) -> str | None:
    """Return a time as RFC 3339, to the second."""
    if time_ns is None:
        return None
    return f"{datetime.fromtimestamp(time_ns // NANOSECONDS_PER_SECOND, UTC):%Y-%m-%dT%H:%M:%SZ}"
