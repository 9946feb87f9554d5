"""`mcc relay`: what a running service uses of one relay, and where that differs from its SCL."""

from collections.abc import Iterator, Mapping

from rich.text import Text

from core.error_words import one_line
from core.quantity_text import plain
from service.cli.output import failing_clearly, print_document, results
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.tables import FittedTable

_USED = (
    ("trigger", "trigger"),
    ("trigger_action", "operated as"),
    ("control_model", "control model"),
    ("record_made", "record made"),
    ("records_told_by", "records announced by"),
    ("report_control", "report control"),
    ("events_directory", "events directory"),
    ("text_reports", "text reports"),
)
NOT_VISITED = "not visited yet"
NONE = "none"


def show_relay(url: str, relay: str, *, as_json: bool) -> None:
    """Print what is used of a relay, what differs from its SCL, what is ignored. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        ied = service.get_ied(relay)
    if as_json:
        print_document(ied)
        return
    table = FittedTable(title=Text(relay), title_justify="left", show_header=False)
    for name, value in _lines(ied):
        table.add_row(name, Text(one_line(value)))
    results().print(table)


def _value(value: object) -> str:
    return ", ".join(map(str, value)) if isinstance(value, list) and value else str(value or NONE)


def _lines(ied: Document) -> list[tuple[str, str]]:
    reason = f": {ied['link_reason']}" if ied["link_reason"] else ""
    lines = [("link", f"{ied['link_state']}{reason}")]
    used = ied["acquisition"]
    if isinstance(used, Mapping):
        lines.extend((words, _value(used.get(key))) for key, words in _USED)
        lines.extend(("decided by the motors file", str(name)) for name in used["overridden"])
        lines.extend(("remark", str(remark)) for remark in used["remarks"])
    else:
        lines.append(("used", NOT_VISITED))
    lines.extend(_length_lines(ied["report_length"]))
    lines.extend(
        (
            f"SCL mismatch: {each['kind']}",
            f"expected {each['expected'] or NONE}, found {each['found'] or NONE}",
        )
        for each in _items(ied, "differences")
    )
    lines.extend(
        ("ignored file", f"{each['name']}: {each['reason']}") for each in _items(ied, "ignored_files")
    )
    lines.extend(("alarm", f"{each['kind']}: {each['reason']}") for each in _items(ied, "alarms"))
    return lines


def _length_lines(length: object) -> Iterator[tuple[str, str]]:
    """Yield how long its records are, and what to set for longer ones."""
    if not isinstance(length, Mapping):
        return
    duration_s, before_s = plain(length["duration_s"]), plain(length["pre_trigger_s"])
    cycles = f"{length['cycles']:.0f} cycles"
    yield "records last", f"{duration_s} s ({cycles}), {before_s} s of it before the trigger"
    for advice in length["advice"]:
        yield "for longer records", str(advice)


def _items(document: Document, name: str) -> list[Mapping[str, object]]:
    items = document[name]
    return [each for each in items if isinstance(each, Mapping)] if isinstance(items, list) else []
