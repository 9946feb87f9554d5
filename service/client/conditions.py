"""A motor's condition as text for people, the same in every command."""

from collections.abc import Mapping, Sequence

from rich.text import Text

from core.condition.verdict.phase_words import kinds_in_words
from core.motor_condition.parts import findings_beside_stator, parts_of
from core.quantity_text import plain
from core.terms import phrase
from service.client.rest_client import Document, ServiceError
from service.client.until_stop import answer_of
from service.client.verdicts import level, local_time, percent

STATE_COLOURS = {"healthy": "green", "watch": "yellow", "fault": "red"}


def condition_of(health: Document) -> Document:
    """Return the condition in a motor's health. Raises ServiceError where there is none."""
    condition = health.get("condition")
    if not isinstance(condition, Mapping):
        raise ServiceError("there is no condition in the answer: is the service older than this command?")
    return condition


def state_text(condition: Document) -> Text:
    """Return the state in its colour, with the cause: "fault: shorted turns b"."""
    state = str(condition["state"])
    words = cause(condition)
    return Text(f"{state}: {words}" if words else state, style=STATE_COLOURS.get(state, ""))


def cause(condition: Document) -> str:
    """Return what has changed, with its phase: "shorted turns b"; of what is open, what it may be.

    Where the phase of shorted turns is not sure: "shorted turns in phase a (72 %) or c (28 %)".
    """
    kind = str(condition["kind"])
    beside = findings_beside_stator(parts_of(condition))
    if beside or kind == "none":
        return beside
    candidates = condition.get("candidates")
    kinds = [str(one) for one in candidates] if isinstance(candidates, Sequence) else []
    phase, likely = condition["phase"], condition.get("phase_probabilities")
    told = None if phase is None else str(phase)
    words = kinds_in_words(kinds or [kind], told, likely if isinstance(likely, Sequence) else None, phrase)
    return f"{words} {told or ''}".strip()


def as_of(condition: Document) -> Text:
    """Return the time of the latest record that counts, to the minute, and whether it is too old."""
    if condition["as_of"] is None:
        return Text("-")
    when = local_time(condition["as_of"], seconds=False)
    return Text(f"{when} stale", style="yellow") if condition["stale"] else Text(when)


def since_day(condition: Document) -> str:
    """Return the date of the first record that shows a change; "-" where there is none."""
    return "-" if condition["since"] is None or stands(condition) else local_time(condition["since"])[:10]


def stands(condition: Document) -> bool:
    """Return whether what is told was there with the first record: when it began is not known."""
    since, reference = condition["since"], condition["reference"]
    return since is not None and isinstance(reference, Mapping) and since == reference.get("since")


def condition_lines(condition: Document) -> list[tuple[str, Text]]:
    """Return what is to be done about a motor, then why, as lines of a name and a text."""
    lines = [("condition", state_text(condition)), ("what to do", Text(str(condition["advice"])))]
    if condition["mu_f"] is not None:
        lines.append(("fault level", Text(level(condition["mu_f"], condition["mu_f_ci95"]))))
    if condition["since"] is not None:
        lines.append(("since", Text(_since(condition))))
    if condition["change_ci95"] is not None:
        lines.append(("change of the level", Text(level(condition["change"], condition["change_ci95"]))))
        lines.append(("growth", Text(_growth(condition))))
    elif condition["size"] is not None and not stands(condition):
        lines.append(("size of the change", Text(level(condition["size"], condition.get("size_ci95")))))
    for number, reason in enumerate(_texts(condition["reasons"])):
        lines.append(("why" if number == 0 else "", Text(reason)))
    ahead = condition.get("until_stop")
    if isinstance(ahead, Mapping):
        lines.append(("planned stop", Text(_until_stop(ahead))))
    lines.append(("reference", Text(_reference(condition["reference"]))))
    when = condition["as_of"]
    if when is None:
        lines.append(("as of", Text("no record yet")))
    else:
        stale = "; stale: no newer record counts" if condition["stale"] else ""
        lines.append(("as of", Text(f"{local_time(when)}{stale}", style="yellow" if stale else "")))
    return lines


def _since(condition: Document) -> str:
    since = local_time(condition["since"])
    return f"unknown: there since the first record, of {since}" if stands(condition) else since


def _growth(condition: Document) -> str:
    growth, forecast = condition["growth_per_day"], condition["forecast"]
    if not isinstance(growth, int | float):
        return "no trend"
    words = f"{plain(100 * growth)} % a day"
    if not isinstance(forecast, Mapping):
        return words
    days = forecast["days"]
    if not isinstance(days, Sequence):
        return f"not certain, {words} at best guess; it may never reach {percent(forecast['limit'])} %"
    low, middle, high = days
    return (
        f"{words}; {percent(forecast['limit'])} % in about {plain(middle)} days, "
        f"in eight of ten cases {plain(low)} to {plain(high)}"
    )


def _until_stop(ahead: Document) -> str:
    reasons = _texts(ahead["reasons"])
    probability = ahead["probability"]
    answer = answer_of(probability if isinstance(probability, int | float) else None, reasons)
    of = " (of the site)" if ahead["of"] == "site" else ""
    return f"{local_time(ahead['stop'])}{of}: {answer}" + "".join(f"; {one}" for one in reasons[1:])


def _reference(reference: object) -> str:
    if not isinstance(reference, Mapping) or not reference["records"]:
        return "none yet"
    records = f"learnt from {reference['records']} records"
    if not reference["complete"]:
        return f"{records} so far; no change can be seen before it is complete"
    detectable = reference.get("detectable")
    seen = "" if detectable is None else f"; detection limit {percent(detectable)} % within ten records"
    return f"{records}{seen}"


def _texts(found: object) -> list[str]:
    return [str(one) for one in found] if isinstance(found, list) else []
