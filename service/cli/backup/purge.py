"""`mcc purge`: deletes all of a plant, told before and looked at afterwards."""

import os
import sys
import time
from pathlib import Path

from rich.prompt import Prompt
from rich.text import Text
from sqlalchemy.exc import SQLAlchemyError

from service.audit.actions import AuditAction
from service.audit.entries import line
from service.backup.errors import BackupError
from service.backup.purging import PurgePlan, alone, purge_plan
from service.backup.purging import purge as delete_all
from service.cli.audit.actor import command_line_actor
from service.cli.output import CommandError, failing_clearly, print_document, progress, results
from service.configuration.settings import Settings, SettingsError
from service.process.private_files import written_privately
from service.process.single_instance import AlreadyRunningError
from service.storage import Repository, StorageError, connect
from service.storage.migrations import require_current_tables


def purge(
    config: Path | None, *, audit: Path | None, backups: bool, is_confirmed: bool, as_json: bool
) -> None:
    """Delete all of a plant. audit: where its trail goes first; None: it goes too. Raises CommandError."""
    errors = (SettingsError, StorageError, SQLAlchemyError, OSError, BackupError, AlreadyRunningError)
    with failing_clearly(*errors), written_privately():
        settings = Settings.load(config)
        plan = purge_plan(settings, config, backups=backups)
        _tell(plan, audit)
        if not is_confirmed:
            _confirm(plan)
        with alone(plan):
            if audit is not None:
                _export(settings, plan, audit)
            delete_all(plan)
    if as_json:
        print_document(_document(plan, audit))
        return
    results().print(
        Text(
            f"deleted: {plan.number} files, {plan.size_bytes / 1e6:.1f} MB, {plan.tables} tables, "
            f"{plan.objects} objects of a bucket; looked again: nothing is left of them"
        ),
        soft_wrap=True,
    )


def _tell(plan: PurgePlan, audit: Path | None) -> None:
    """Say what is about to go, and what stays."""
    say = progress().print
    say(Text(f"about to be deleted for good ({plan.number} files, {plan.size_bytes / 1e6:.1f} MB):"))
    for path in (*plan.named, *plan.files):
        say(Text(f"  {path}"), soft_wrap=True)
    say(
        Text(f"  database {plan.database}" + (f", {plan.tables} tables" if plan.tables else "")),
        soft_wrap=True,
    )
    if plan.bucket is not None:
        say(Text(f"  {plan.bucket}, {plan.objects} objects"), soft_wrap=True)
    say(Text("stays, to be deleted elsewhere:"))
    for words in plan.left:
        say(Text(f"  {words}"), soft_wrap=True)
    kept = "the audit trail goes too" if audit is None else f"the audit trail is exported to {audit} first"
    say(Text(kept), soft_wrap=True)


def _confirm(plan: PurgePlan) -> None:
    """Ask for the name of the data directory. Raises CommandError."""
    name = plan.data.resolve().name
    if not sys.stdin.isatty():
        raise CommandError(
            f"expected somebody who types {name!r}, found no terminal: --yes deletes all of it"
        )
    if Prompt.ask(f"type {name} to delete all of it", console=progress()) != name:
        raise CommandError("nothing was deleted: another name was typed")


def _export(settings: Settings, plan: PurgePlan, audit: Path) -> None:
    """Have the trail end with the purge, and write it elsewhere. Raises CommandError, OSError."""
    if any(audit.resolve().is_relative_to(folder.resolve()) for folder in plan.folders):
        raise CommandError(f"--audit {audit}: expected a file outside of what is deleted")
    require_current_tables(settings.database_url)
    engine = connect(settings.database_url)
    told = {
        "files": plan.number,
        "size_bytes": plan.size_bytes,
        "folders": [str(one) for one in plan.named],
        "bucket": None if plan.bucket is None else str(plan.bucket),
        "objects": plan.objects,
    }
    try:
        repository = Repository(engine)
        repository.note_by(
            command_line_actor(),
            AuditAction.PLANT_PURGED,
            ("plant", str(plan.data)),
            now_ns=time.time_ns(),
            after=told,
        )
        with audit.open("x", encoding="utf-8", newline="") as sink, repository.audit_trail() as trail:
            sink.writelines(f"{line(entry)}\n" for entry in trail.entries())
            sink.flush()
            os.fsync(sink.fileno())
    finally:
        engine.dispose()


def _document(plan: PurgePlan, audit: Path | None) -> dict[str, object]:
    return {
        "files": plan.number,
        "size_bytes": plan.size_bytes,
        "tables": plan.tables,
        "objects": plan.objects,
        "bucket": None if plan.bucket is None else str(plan.bucket),
        "folders": [str(one) for one in plan.named],
        "database": plan.database,
        "left": list(plan.left),
        "audit": None if audit is None else str(audit),
    }
