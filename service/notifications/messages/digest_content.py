"""What a digest says: how the motors are, what called, and what the service could not see."""

from collections.abc import Mapping

from core.condition.verdict.phase_words import kinds_in_words
from core.terms import phrase
from core.time_stamps import rfc3339
from core.time_words import clock, day
from service.configuration.notifications import NotificationSettings
from service.notifications.messages.content import Content, Section
from service.senders.message import Line, Severity
from service.storage.records import Notification

SEVERITY_OF: Mapping[str, Severity] = {"fault": "high", "watch": "medium"}


def digest_content(
    notification: Notification,
    settings: NotificationSettings,
    pictures: Mapping[str, bytes] | None = None,
) -> Content:
    """Return what a digest says. pictures: a motor's trend, by its name as `picture_key` has it."""
    facts = notification.document or {}
    motors = _table(facts, "motors")
    attention = [one for one in _list(facts, "attention") if isinstance(one, Mapping)]
    found = pictures or {}
    period, zone = str(facts["period"]), settings.time_zone
    states = ", ".join(f"{number} {state}" for state, number in motors.items()) or "no motors"
    subject = f"StatorWatch, {period} digest of {day(_number(facts, 'to_ns'), zone)}: {states}"
    sections = [_overview(facts)]
    sections += [
        _motor(one, picture_key(number) in found, number, zone) for number, one in enumerate(attention)
    ]
    times = {"from_time": rfc3339(_number(facts, "from_ns")), "to_time": rfc3339(_number(facts, "to_ns"))}
    document = {
        "id": notification.id,
        "type": "digest",
        "time": rfc3339(notification.created_ns),
        "subject": subject,
        "severity": "info",
        **{key: value for key, value in facts.items() if key not in ("from_ns", "to_ns")},
        **times,
    }
    return Content(
        subject=subject,
        severity="info",
        intro=_intro(facts, settings),
        sections=sections,
        document=document,
        lines=[Line(subject, "info", {"digest": period})],
        pictures=found,
    )


def picture_key(number: int) -> str:
    """Return the name of the picture of the n-th motor that needs attention."""
    return f"motor-{number}"


def _intro(facts: Mapping[str, object], settings: NotificationSettings) -> str:
    begin, end = (clock(_number(facts, key), settings.time_zone) for key in ("from_ns", "to_ns"))
    sites = _list(facts, "sites")
    where = f", sites {', '.join(map(str, sites))}" if sites else ""
    return f"From {begin} to {end}{where}."


def _overview(facts: Mapping[str, object]) -> Section:
    lines = [("motors", _counted(_table(facts, "motors"), "none"))]
    lines.append(("alarms raised", _counted(_table(facts, "alarms_raised"), "none")))
    lines.append(("alarms now", _counted(_table(facts, "alarms_open"), "none")))
    lines.append(("links that are not up", _named(facts.get("links_not_up"), "relays")))
    lines.append(("without a recent record", _named(facts.get("stale"), "motors")))
    given_up = _number(facts, "given_up")
    if given_up:
        lines.append(("messages given up", f"{given_up}; mcc notify list --state dead says why"))
    return Section(heading="The plant", severity="info", facts=lines)


def _motor(facts: Mapping[str, object], has_picture: bool, number: int, zone: str) -> Section:
    state = str(facts["state"])
    known, likely = facts.get("phase"), facts.get("phase_probabilities")
    told = None if known is None else str(known)
    kinds, shares = [str(facts["kind"])], likely if isinstance(likely, list) else None
    cause = str(facts.get("finding") or kinds_in_words(kinds, told, shares, phrase))
    phase = "" if told is None else f" in phase {told}"
    lines = []
    mu_f, interval = facts.get("mu_f"), facts.get("mu_f_ci95")
    if isinstance(mu_f, int | float):
        between = f" [{100 * interval[0]:.2f}..{100 * interval[1]:.2f}]" if isinstance(interval, list) else ""
        lines.append(("level", f"{100 * mu_f:.2f} %{between}"))
    since_ns = facts.get("since_ns")
    if isinstance(since_ns, int):
        lines.append(("since", day(since_ns, zone)))
    if facts.get("advice"):
        lines.append(("what to do", str(facts["advice"])))
    return Section(
        heading=f"{facts['motor']} ({facts['site']}): {state}, {cause}{phase}",
        severity=SEVERITY_OF.get(state, "info"),
        facts=lines,
        picture=picture_key(number) if has_picture else None,
    )


def _counted(counts: Mapping[str, int], none: str) -> str:
    return ", ".join(f"{number} {words.replace('-', ' ')}" for words, number in counts.items()) or none


def _named(found: object, what: str) -> str:
    if not isinstance(found, Mapping) or not found.get("number"):
        return "none"
    names = found.get(what)
    listed = [str(one) for one in names] if isinstance(names, list) else []
    more = ", ..." if int(found["number"]) > len(listed) else ""
    return f"{found['number']}: {', '.join(listed)}{more}"


def _table(facts: Mapping[str, object], key: str) -> Mapping[str, int]:
    found = facts.get(key)
    return found if isinstance(found, Mapping) else {}


def _list(facts: Mapping[str, object], key: str) -> list[object]:
    found = facts.get(key)
    return found if isinstance(found, list) else []


def _number(facts: Mapping[str, object], key: str) -> int:
    found = facts.get(key)
    return found if isinstance(found, int) else 0
