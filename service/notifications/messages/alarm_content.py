"""What a message about alarms says: one of them in full, several one below the other, very many counted."""

from collections.abc import Mapping, Sequence
from urllib.parse import quote

from core.time_stamps import rfc3339
from core.time_words import clock
from service.alarms.catalogue import CATALOGUE, AlarmDescription
from service.alarms.kinds import AlarmKind
from service.configuration.notifications import NotificationSettings
from service.notifications.messages.content import Content, Section
from service.notifications.messages.told_alarm import ToldAlarm, told_alarms
from service.senders.message import Line, Severity
from service.storage.records import Notification
from service.storage.states import NotificationKind

MOST_TOLD = 20
"""So many alarms are told one by one to people; a program gets as many as are kept."""

URGENT_FIRST: Sequence[Severity] = ("critical", "high", "medium", "low")

HINT = "mcc alarms acknowledge ID says that you look after it. Do not reply."


def alarm_content(
    notification: Notification,
    settings: NotificationSettings,
    pictures: Mapping[str, bytes] | None = None,
) -> Content:
    """Return what a message about alarms says. pictures: a motor's trend, by the alarm's id."""
    document = notification.document or {}
    alarms = told_alarms(document)
    number = _number(document)
    subject = _subject(notification, alarms, number)
    shown = alarms[:MOST_TOLD]
    found = pictures or {}
    severity = _severity(alarms)
    return Content(
        subject=subject,
        severity=severity,
        intro=_intro(notification, alarms, number),
        sections=[_section(alarm, settings, alarm.id in found) for alarm in shown],
        document=_document(notification, settings, subject, severity, alarms, number),
        lines=_lines(subject, severity, alarms, number, notification),
        rest=_rest(document, number, len(shown)),
        hint=HINT if any(alarm.calls for alarm in alarms) else None,
        pictures=found,
        thread=alarms[0].id if number == 1 and alarms else None,
    )


def _number(document: Mapping[str, object]) -> int:
    number = document.get("number")
    return number if isinstance(number, int) else 0


def _severity(alarms: Sequence[ToldAlarm]) -> Severity:
    for severity in URGENT_FIRST:
        if any(alarm.calls and alarm.priority == severity for alarm in alarms):
            return severity
    return "info"


def _subject(notification: Notification, alarms: Sequence[ToldAlarm], number: int) -> str:
    severity = _severity(alarms)
    mark = "" if severity == "info" else f"[{severity}] "
    if notification.kind is NotificationKind.ESCALATION:
        mark += "Not acknowledged: "
    if number == 1 and alarms:
        alarm = alarms[0]
        told = alarm.reason if alarm.kind == AlarmKind.ALARM_FLOOD else alarm.subject
        cause = f": {told}" if told and alarm.calls else ""
        return f"{mark}{alarm.place}: {alarm.what}{cause}"
    where = notification.site or "the service"
    return f"{mark}{where}: {_counted(notification.document or {}, number)}"


def _counted(document: Mapping[str, object], number: int) -> str:
    """Return how many alarms there are of each kind: "1000 alarms (997 link down, 3 condition watch)"."""
    counts = document.get("counts")
    found = [one for one in counts if isinstance(one, dict)] if isinstance(counts, list) else []
    parts = []
    for one in found[:5]:
        over = {"cleared": " over", "acknowledged": " acknowledged"}.get(str(one["event"]), "")
        parts.append(f"{one['number']} {str(one['kind']).replace('-', ' ')}{over}")
    more = ", ..." if len(found) > 5 else ""
    return f"{number} alarms ({', '.join(parts)}{more})"


def _intro(notification: Notification, alarms: Sequence[ToldAlarm], number: int) -> str:
    if notification.kind is NotificationKind.ESCALATION:
        return (
            "Nobody has acknowledged this alarm yet."
            if number == 1
            else f"Nobody has acknowledged these {number} alarms yet."
        )
    if number == 1:
        return "" if alarms and alarms[0].calls else "For your information."
    return f"{number} alarms came together."


def _rest(document: Mapping[str, object], number: int, shown: int) -> str | None:
    if number <= shown:
        return None
    return f"And {number - shown} more; in all {_counted(document, number)}. mcc alarms lists them."


def _section(alarm: ToldAlarm, settings: NotificationSettings, has_picture: bool) -> Section:
    known = _description(alarm.kind)
    facts = [("priority", alarm.priority)] if alarm.calls else []
    facts.append(("since", _clock(alarm.raised_ns, settings)))
    if alarm.event in ("cleared", "acknowledged"):
        facts.append((alarm.event, _clock(alarm.time_ns, settings)))
    elif not alarm.standing:
        facts.append(("now", "its cause is gone, and nobody has acknowledged it"))
    if alarm.raises > 1:
        facts.append(("raised", f"{alarm.raises} times"))
    if alarm.motor is not None:
        facts.append(("motor, relay, site", ", ".join(filter(None, (alarm.motor, alarm.ied, alarm.site)))))
    elif alarm.ied is not None:
        facts.append(("relay, site", ", ".join(filter(None, (alarm.ied, alarm.site)))))
    facts += _why(alarm, known)
    if alarm.comment and alarm.event in ("acknowledged", "reopened", "cleared"):
        facts.append(("comment", alarm.comment))
    facts.append(("alarm", alarm.id))
    return Section(
        heading=f"{alarm.place}: {alarm.what}",
        severity=_severity([alarm]),
        facts=facts,
        links=_links(alarm, settings.address),
        picture=alarm.id if has_picture else None,
    )


def _why(alarm: ToldAlarm, known: AlarmDescription | None) -> list[tuple[str, str]]:
    """Return what was found, what that means, and what to do."""
    is_repeated = alarm.reason.startswith(alarm.subject)
    facts = [("about", alarm.subject)] if alarm.subject and not is_repeated else []
    facts += [("found", alarm.reason)] if alarm.reason else []
    if not alarm.calls:
        return facts
    if known is not None:
        facts += [("cause", known.cause), ("consequence", known.consequence)]
    action = alarm.advice or (None if known is None else known.action)
    return facts + ([("what to do", action)] if action else [])


def _description(kind: str) -> AlarmDescription | None:
    """Return what a kind of alarm means; None for one of another version."""
    return next((told for known, told in CATALOGUE.items() if known.value == kind), None)


def _clock(time_ns: int, settings: NotificationSettings) -> str:
    return clock(time_ns, settings.time_zone, seconds=True)


def _links(alarm: ToldAlarm, address: str | None, *, of_motor: str = "") -> list[tuple[str, str]]:
    """Return the addresses of what the alarm is about, below the one by which the service is reached.

    of_motor: what follows the name of a motor.
    """
    if address is None:
        return []
    found = [("alarm", f"{address}/alarms/{quote(alarm.id, safe='')}")]
    if alarm.motor is not None:
        found.append(("motor", f"{address}/motors/{quote(alarm.motor, safe='')}{of_motor}"))
    if alarm.recording_id is not None:
        found.append(("recording", f"{address}/recordings/{quote(alarm.recording_id, safe='')}"))
    return found


def _api_links(alarm: ToldAlarm, address: str | None) -> list[tuple[str, str]]:
    """Return the same for programs."""
    return _links(alarm, None if address is None else f"{address}/api/v1", of_motor="/health")


def _lines(
    subject: str,
    severity: Severity,
    alarms: Sequence[ToldAlarm],
    number: int,
    notification: Notification,
) -> list[Line]:
    if number > MOST_TOLD:
        return [Line(subject, severity, {"alarms": str(number), "site": notification.site or ""})]
    escalated = "not acknowledged: " if notification.kind is NotificationKind.ESCALATION else ""
    return [
        Line(
            f"{escalated}{alarm.place}: {alarm.what}: {alarm.subject or alarm.reason}",
            _severity([alarm]),
            {
                "alarm": alarm.id,
                "event": alarm.event,
                "kind": alarm.kind,
                "priority": alarm.priority,
                **{
                    name: found
                    for name, found in (("site", alarm.site), ("relay", alarm.ied), ("motor", alarm.motor))
                    if found is not None
                },
            },
        )
        for alarm in alarms
    ]


def _document(
    notification: Notification,
    settings: NotificationSettings,
    subject: str,
    severity: Severity,
    alarms: Sequence[ToldAlarm],
    number: int,
) -> Mapping[str, object]:
    """Return the document for programs: times are RFC 3339 in UTC."""
    return {
        "id": notification.id,
        "type": notification.kind.value,
        "time": rfc3339(notification.created_ns),
        "subject": subject,
        "severity": severity,
        "site": notification.site,
        "number": number,
        "counts": (notification.document or {}).get("counts", []),
        "alarms": [_alarm_document(alarm, settings.address) for alarm in alarms],
    }


def _alarm_document(alarm: ToldAlarm, address: str | None) -> Mapping[str, object]:
    known = _description(alarm.kind)
    return {
        "id": alarm.id,
        "event": alarm.event,
        "time": rfc3339(alarm.time_ns),
        "by": alarm.by,
        "comment": alarm.comment,
        "kind": alarm.kind,
        "priority": alarm.priority,
        "site": alarm.site,
        "ied": alarm.ied,
        "motor": alarm.motor,
        "subject": alarm.subject,
        "reason": alarm.reason,
        "cause": None if known is None else known.cause,
        "consequence": None if known is None else known.consequence,
        "action": alarm.advice or (None if known is None else known.action),
        "recording": alarm.recording_id,
        "state": alarm.state,
        "standing": alarm.standing,
        "raised_time": rfc3339(alarm.raised_ns),
        "links": dict(_api_links(alarm, address)),
    }
