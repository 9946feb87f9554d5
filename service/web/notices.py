"""What a page says after a form was taken. Addresses name it by its key, so that no link puts words here."""

from collections.abc import Mapping
from typing import Final

NOTICES: Final[Mapping[str, str]] = {
    "recording-added": "The recording is stored, and waits for its diagnosis.",
    "recording-known": "The motor had this recording already; nothing was stored.",
    "recording-deleted": "The recording is deleted. You can undo that for ten minutes.",
    "deletion-undone": "Undone. The recording is there again, and waits for its diagnosis.",
    "diagnosis-queued": "Another diagnosis is queued; load the page again in a few seconds.",
    "logged-out": "You are logged out.",
    "password": "The password is changed. Log in with the new one.",
    "acknowledged": "Acknowledged.",
    "acknowledged-some": "Acknowledged, except those below.",
    "not-acknowledged": "Not acknowledged, and no comment kept: somebody has acknowledged it, or it is"
    " over. Below is who did what, and when.",
    "released": "The relay is released, and visited again within seconds.",
    "user-added": "The user is added.",
    "user-changed": "The changes are kept.",
    "user-unlocked": "Failed logins are forgotten.",
    "user-deleted": "The user is deleted.",
    "password-set": "The password is set. The user must change it. Sessions and tokens have ended.",
    "sessions-ended": "All sessions and tokens have ended.",
    "passkey-added": "The passkey is added. Other sessions of yours have ended.",
    "passkey-removed": "The passkey is removed. Other sessions of yours have ended.",
    "second-factor-removed": "The second factor is removed.",
    "token-revoked": "The token has ended.",
    "tokens-revoked": "All tokens have ended.",
    "test-queued": "A test is on its way; below is what becomes of it (load the page again).",
    "tried-again": "The message is tried again.",
    "shelved": "The alarm is shelved.",
    "unshelved": "The shelving has ended.",
    "out-of-service": "The alarm is out of service until somebody puts it back.",
    "back-in-service": "The alarm is back in service.",
    "recording-requested": "The relay is asked for a recording. It comes within a minute or so.",
    "diagnosis-requested": "The recording is diagnosed again. The condition follows within seconds.",
    "reference-restarted": "The motor counts as healthy as it is. Its reference is learnt anew.",
    "note-kept": "The note is kept. Where the condition rests on it, that follows within seconds.",
    "note-withdrawn": "The note counts no more.",
    "inspection-kept": "Kept. It counts in the figures of inspections; no judgement follows from it.",
    "inspection-withdrawn": "The inspection counts no more.",
    "stop-planned": "The stop is planned. The motor's page says whether it may run until then.",
    "stop-cancelled": "The plan is dropped.",
    "acknowledgement-undone": "Undone. The alarms are unacknowledged again.",
    "undone": "Undone. The condition follows within seconds.",
}


def notice(key: str | None) -> str | None:
    """Return the words of a key; None for one that is unknown."""
    return NOTICES.get(key or "")
