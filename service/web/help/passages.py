"""Which passage of the documentation explains what a page shows: declared here, linked by macros.html."""

from collections.abc import Mapping
from typing import Final

from service.web.help.pages import PREFIX

PASSAGES: Final[Mapping[str, str]] = {
    "account": "how-to/users.html",
    "air gap and load": "reference/quantities.html#the-air-gap",
    "alarm": "how-to/alarms.html#2-understand-it",
    "alarms": "reference/alarms.html",
    "audit trail": "how-to/audit.html#look-something-up",
    "authenticator app": "how-to/users.html#a-second-factor",
    "certificates": "how-to/security.html#exchanging-certificates",
    "clock": "reference/relays.html#clocks-that-run-in-local-time",
    "condition history": "explanation/condition.html",
    "diagnosis": "explanation/classification.html",
    "fleet": "reference/fleet.html",
    "heat": "reference/load.html#heat",
    "hours beyond limits": "reference/load.html#hours-beyond-limits",
    "ignored files": "reference/relays.html#files",
    "link": "how-to/security.html",
    "load profile": "reference/load.html#load-profile",
    "logbook": "how-to/motor-page.html#what-you-can-do-there",
    "losses": "reference/losses.html#over-time",
    "losses of a recording": "reference/losses.html#of-a-record",
    "measured values": "reference/quantities.html",
    "motor": "how-to/motor-page.html",
    "nameplate": "reference/motor-file.html",
    "notifications": "how-to/notifications.html#what-is-told-and-when",
    "parameters": "reference/tracking.html",
    "parts and states": "reference/condition.html#parts",
    "passwords": "how-to/users.html#more-users",
    "people": "how-to/users.html#more-users",
    "pictures": "how-to/motor-page.html#the-pictures",
    "plant": "how-to/new-plant.html#3-check",
    "quality checks": "explanation/diagnosis.html#the-quality-gate",
    "recording": "how-to/recordings.html#what-the-page-shows",
    "recordings": "how-to/recordings.html#find-it",
    "records": "reference/record-life.html",
    "relay reports": "reference/relay-reports.html",
    "relays": "reference/relays.html",
    "reports": "how-to/reports.html",
    "rotor": "explanation/rotor.html#what-is-said-of-it",
    "SCL mismatches": "reference/relays.html#what-differs",
    "starts": "reference/operations.html#what-a-start-shows",
    "supply": "reference/supply.html",
    "tokens": "how-to/users.html#programs",
    "trend": "how-to/motor-page.html#the-trend",
    "upload": "how-to/recordings.html#bring-one",
    "used of the relay": "reference/relays.html#what-is-used",
    "verdict of a recording": "explanation/diagnosis.html",
    "verification": "how-to/audit.html#verify-it",
    "waveforms": "how-to/recordings.html#keys",
}
"""The page and its anchor, below /help, by what is explained."""


def passage(about: str) -> str:
    """Return the address of a passage. Raises LookupError where there is none about this."""
    if about not in PASSAGES:
        raise LookupError(f"expected a passage of service/web/help/passages.py, found {about!r}")
    return f"{PREFIX}/{PASSAGES[about]}"
