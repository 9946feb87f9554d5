"""What a test message says."""

from core.time_stamps import rfc3339
from core.time_words import clock
from service.notifications.messages.content import Content, Section
from service.senders.message import Line
from service.storage.records import Notification

SUBJECT = "StatorWatch: a test of notifications"


def trial_content(notification: Notification, zone: str) -> Content:
    """Return what a test says: who asked for it, and that nothing is wrong."""
    facts = notification.document or {}
    by = str(facts.get("by", ""))
    document = {
        "id": notification.id,
        "type": "test",
        "time": rfc3339(notification.created_ns),
        "subject": SUBJECT,
        "severity": "info",
        "by": by,
        "channel": notification.channel,
    }
    section = Section(
        heading="This is a test. Nothing is wrong.",
        severity="info",
        facts=[
            ("channel", notification.channel),
            ("asked for by", by),
            ("at", clock(notification.created_ns, zone, seconds=True)),
        ],
    )
    return Content(
        subject=SUBJECT,
        severity="info",
        intro="",
        sections=[section],
        document=document,
        lines=[Line(f"{SUBJECT}, asked for by {by}", "info", {"test": "true"})],
    )
