"""`mcc rediagnose`: another diagnosis of stored recordings."""

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

from rich.text import Text

from service.cli.output import FAILED, CommandError, failing_clearly
from service.cli.rows import Column, print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import level, verdict_text

if TYPE_CHECKING:
    from statorwatch_client.models import DiagnosisRequest

ENDED = ("done", "failed")
POLL_PERIOD_S = 0.25
FIELDS = ("recording_id", "state", "verdict", "mu_f", "mu_f_ci95", "phase", "load_level", "error", "id")


def rediagnose_recordings(
    url: str,
    recordings: Sequence[str],
    method: str,
    model: str,
    *,
    wait_s: float,
    as_csv: bool,
    as_json: bool,
) -> None:
    """Ask for the diagnoses, wait for at most `wait_s`, and print what came of each.

    Raises CommandError, also where one has failed.
    """
    require_one_format(as_csv=as_csv, as_json=as_json)
    wanted = cast("DiagnosisRequest", {"method": method, "model": model})
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        runs = [service.request_diagnosis(one, wanted) for one in recordings]
        deadline_s = time.monotonic() + wait_s
        while any(run["state"] not in ENDED for run in runs) and time.monotonic() < deadline_s:
            time.sleep(POLL_PERIOD_S)
            runs = [
                run if run["state"] in ENDED else service.get_diagnosis(run["recording_id"], run["id"])
                for run in runs
            ]
    rows = [{**run, **_result(run)} for run in runs]
    columns: dict[str, Column] = {
        "recording": lambda row: str(row["recording_id"]),
        "diagnosis": lambda row: _said(row),
        "level": lambda row: level(row.get("mu_f"), row.get("mu_f_ci95")),
    }
    shown = runs if as_json else rows
    print_rows("diagnoses", shown, FIELDS, columns, as_csv=as_csv, as_json=as_json, whole=("recording",))
    failed = [run for run in runs if run["state"] == "failed"]
    if failed and not as_json:
        raise CommandError(f"{len(failed)} of {len(runs)} diagnoses failed", exit_code=FAILED)


def _result(run: Document) -> Document:
    result = run["result"]
    return result if isinstance(result, dict) else {}


def _said(row: Document) -> Text:
    if row["state"] == "done":
        return verdict_text(str(row["verdict"]), row["phase"])
    return Text(f"{row['state']}: {row['error']}" if row["error"] else str(row["state"]))
