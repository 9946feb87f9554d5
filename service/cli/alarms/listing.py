"""`mcc alarms list` and `show`: what to act on first with what to do, and what happened to one alarm."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

from rich.padding import Padding
from rich.text import Text

from core.error_words import one_line
from service.cli.alarms.choosing import whole_id
from service.cli.output import WRONG_USE, CommandError, failing_clearly, print_document, results
from service.cli.rows import print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import local_time, local_times, percent

FIELDS = (
    "priority", "state", "standing", "raised_time", "cleared_time", "site", "ied", "motor", "kind", "subject",
    "reason", "cause", "consequence", "advice", "value", "raises", "changed_time", "changed_by", "comment",
    "shelved_until", "shelved_above", "suppressed_because", "part_of", "id",
)  # fmt: skip

COLOURS = {"critical": "bold red", "high": "red", "medium": "yellow"}
MOST_CHANGES = 1000


@dataclass(frozen=True, slots=True)
class Chosen:
    """Which alarms are shown; None for all. over: also those that are over, the latest at the top.

    part_of: only those that this alarm tells in one line, over or not.
    """

    motor: str | None
    site: str | None
    relay: str | None
    state: str | None
    over: bool
    part_of: str | None = None

    @property
    def are_open(self) -> bool:
        """Tell whether the list of open alarms has them."""
        return not self.over and self.part_of is None

    @property
    def query(self) -> dict[str, Any]:
        """Return the parameters of their list."""
        words = {"motor": self.motor, "site": self.site, "ied": self.relay, "state": self.state}
        return {name: word for name, word in words.items() if word is not None}


def show_alarms(url: str, chosen: Chosen, *, limit: int, as_csv: bool, as_json: bool) -> None:
    """Print alarms. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    if not chosen.are_open and (chosen.site is not None or chosen.state is not None):
        raise CommandError(
            "--all, --part-of: expected neither --site nor --state beside it, which choose among open alarms",
            details={"type": "WrongUse"},
            exit_code=WRONG_USE,
        )
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        query = chosen.query
        if chosen.part_of is not None:
            query["part_of"] = whole_id(service, chosen.part_of)
        listed = service.list_open_alarms if chosen.are_open else service.list_alarms
        found = list(islice(listed(limit=min(limit, 1000), **query), limit))
    if as_csv or as_json or not found:
        print_rows("alarms", found, FIELDS, {}, as_csv=as_csv, as_json=as_json)
        return
    for alarm in found:
        print_alarm(alarm)


def show_alarm(url: str, alarm_id: str, *, as_json: bool) -> None:
    """Print one alarm and what happened to it, the latest at the top. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        whole = whole_id(service, alarm_id)
        alarm = service.get_alarm(whole)
        changes = list(islice(service.list_alarm_changes(whole, limit=1000), MOST_CHANGES))
    if as_json:
        print_document({**alarm, "changes": changes})
        return
    print_alarm(alarm)
    for words in (alarm["cause"], alarm["consequence"]):
        results().print(Padding(Text(local_times(words), overflow="fold"), (0, 0, 0, 4), expand=False))
    results().print()
    columns = {
        "time": lambda change: local_time(change["time"]),
        "what": lambda change: str(change["event"]),
        "state": lambda change: str(change["after"]),
        "by": lambda change: str(change["by"]),
        "comment": lambda change: str(change["comment"] or ""),
    }
    print_rows("changes", changes, (), columns, as_csv=False, as_json=False)


def print_alarm(alarm: Document) -> None:
    """Print how urgent an alarm is, where and what, since when, and below it why and what to do."""
    console = results()
    line = Text(f"{alarm['priority']}, {alarm['state']}", style=COLOURS.get(str(alarm["priority"]), ""))
    where = alarm["motor"] or alarm["ied"] or alarm["site"] or "the service"
    line.append(f"  {one_line(str(where))}: {alarm['kind']}, {_since(alarm)}", style="default not bold")
    console.print(line)
    for words in _details(alarm):
        console.print(Padding(Text(local_times(words), overflow="fold"), (0, 0, 0, 4), expand=False))


def _since(alarm: Document) -> str:
    """Return since when the cause stands, and until when it stood."""
    since = f"since {local_time(alarm['raised_time'])}"
    if isinstance(alarm["raises"], int) and alarm["raises"] > 1:
        since += f" ({alarm['raises']} times)"
    return since if alarm["cleared_time"] is None else f"{since}, until {local_time(alarm['cleared_time'])}"


def _details(alarm: Document) -> Iterator[str]:
    why = ": ".join(str(alarm[key]) for key in ("subject", "reason") if alarm[key])
    yield from (words for words in (why, str(alarm["advice"]), _what_was_done(alarm)) if words)
    yield f"id {alarm['id']}"


def _what_was_done(alarm: Document) -> str | None:
    """Return what somebody, or the plant's design, has made of an alarm."""
    said = "" if alarm["comment"] is None else f": {alarm['comment']}"
    by = f"by {alarm['changed_by']} {local_time(alarm['changed_time'])}"
    match alarm["state"]:
        case "acknowledged":
            return f"acknowledged {by}{said}"
        case "shelved":
            return f"shelved until {' or '.join(_ends(alarm))} {by}{said}"
        case "suppressed":
            return f"suppressed: {alarm['suppressed_because']}"
        case "out-of-service":
            return f"taken out of service {by}{said}"
    return None if alarm["comment"] is None else f"{by}{said}"


def _ends(alarm: Document) -> Sequence[str]:
    ends = []
    if alarm["shelved_until"] is not None:
        ends.append(local_time(alarm["shelved_until"]))
    if alarm["shelved_above"] is not None:
        ends.append(f"its level is above {percent(alarm['shelved_above'])} %")
    return ends
