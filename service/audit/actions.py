"""What the audit trail knows of: every action that leaves an entry, in words."""

from collections.abc import Mapping
from enum import StrEnum


class AuditAction(StrEnum):
    """What was done. A test finds routes that change something without one."""

    RECORDING_REQUESTED = "recording-requested"
    RECORDING_UPLOADED = "recording-uploaded"
    REPORT_IMPORTED = "report-imported"
    RECORDING_DELETED = "recording-deleted"
    DIAGNOSIS_REQUESTED = "diagnosis-requested"
    BASELINE_SET = "baseline-set"
    BASELINE_DELETED = "baseline-deleted"
    NOTE_ADDED = "note-added"
    NOTE_WITHDRAWN = "note-withdrawn"
    REFERENCE_RESTARTED = "reference-restarted"
    QUARANTINE_RELEASED = "quarantine-released"
    ALARM_ACKNOWLEDGED = "alarm-acknowledged"
    ALARM_SHELVED = "alarm-shelved"
    ALARM_UNSHELVED = "alarm-unshelved"
    ALARM_TAKEN_OUT_OF_SERVICE = "alarm-taken-out-of-service"
    ALARM_PUT_BACK_IN_SERVICE = "alarm-put-back-in-service"
    CHANNEL_TESTED = "channel-tested"
    NOTIFICATION_RETRIED = "notification-retried"
    LOGGED_IN = "logged-in"
    LOGIN_FAILED = "login-failed"
    LOGIN_LOCKED = "login-locked"
    LOGIN_LINK_MADE = "login-link-made"
    LOGGED_OUT = "logged-out"
    SESSIONS_ENDED = "sessions-ended"
    USER_ADDED = "user-added"
    USER_CHANGED = "user-changed"
    USER_UNLOCKED = "user-unlocked"
    USER_DELETED = "user-deleted"
    PASSWORD_SET = "password-set"  # noqa: S105 - the name of an action
    TOKEN_ADDED = "token-added"  # noqa: S105 - the name of an action
    TOKEN_REVOKED = "token-revoked"  # noqa: S105 - the name of an action
    PLANT_CHANGED = "plant-changed"
    PARAMETERS_CHANGED = "parameters-changed"
    RETENTION_APPLIED = "retention-applied"
    BACKUP_MADE = "backup-made"
    BACKUP_RESTORED = "backup-restored"


MEANINGS: Mapping[AuditAction, str] = {
    AuditAction.RECORDING_REQUESTED: "Somebody had a motor recorded (`mcc trigger`).",
    AuditAction.RECORDING_UPLOADED: "Somebody gave the service a recording.",
    AuditAction.REPORT_IMPORTED: "Somebody brought a relay's text report; `after` tells which, and counts.",
    AuditAction.RECORDING_DELETED: "Somebody deleted a recording; `before` is what it was.",
    AuditAction.DIAGNOSIS_REQUESTED: "Somebody had a recording diagnosed again.",
    AuditAction.BASELINE_SET: "Somebody chose the healthy recordings of a motor, in place of others.",
    AuditAction.BASELINE_DELETED: "Somebody dropped a motor's baseline.",
    AuditAction.NOTE_ADDED: "Somebody wrote into a motor's logbook.",
    AuditAction.NOTE_WITHDRAWN: "Somebody let a note count no more.",
    AuditAction.REFERENCE_RESTARTED: "Somebody took a motor for healthy as it is.",
    AuditAction.QUARANTINE_RELEASED: "Somebody had a relay visited again; `before` is why it was set aside.",
    AuditAction.ALARM_ACKNOWLEDGED: "Somebody took notice of an alarm, with the comment in `after`.",
    AuditAction.ALARM_SHELVED: "Somebody set an alarm aside; `after` says until when, or until which value.",
    AuditAction.ALARM_UNSHELVED: "Somebody ended the shelving of an alarm.",
    AuditAction.ALARM_TAKEN_OUT_OF_SERVICE: "Somebody set an alarm aside without an end.",
    AuditAction.ALARM_PUT_BACK_IN_SERVICE: "Somebody put an alarm back in service.",
    AuditAction.CHANNEL_TESTED: "Somebody had a test message sent through a channel.",
    AuditAction.NOTIFICATION_RETRIED: "Somebody had a message tried again that was given up.",
    AuditAction.LOGGED_IN: "Somebody logged in; `after` says how.",
    AuditAction.LOGIN_FAILED: "Somebody tried to log in under this name and was refused; `after` says why.",
    AuditAction.LOGIN_LOCKED: "So many logins failed that none is tried for a while; `after` has from where.",
    AuditAction.LOGIN_LINK_MADE: "A link was made that logs a user in once; `after` says until when.",
    AuditAction.LOGGED_OUT: "Somebody ended their session.",
    AuditAction.SESSIONS_ENDED: "Somebody ended all sessions of a user.",
    AuditAction.USER_ADDED: "Somebody made a user.",
    AuditAction.USER_CHANGED: "Somebody changed a user's roles or name, or disabled or enabled them.",
    AuditAction.USER_UNLOCKED: "Somebody had a user's failed logins forgotten.",
    AuditAction.USER_DELETED: "Somebody deleted a user; `before` is who it was.",
    AuditAction.PASSWORD_SET: "Somebody gave a user another password, which is not kept here.",
    AuditAction.TOKEN_ADDED: "Somebody made a token for programs, which is not kept here.",
    AuditAction.TOKEN_REVOKED: "Somebody ended a token.",
    AuditAction.PLANT_CHANGED: (
        "The service started with other plant files: a site, relay or motor came (no `before`), left (no "
        "`after`) or is told otherwise."
    ),
    AuditAction.PARAMETERS_CHANGED: "The service started with other figures of a motor in its motors file.",
    AuditAction.RETENTION_APPLIED: "Rules of `[retention]` deleted what they say; how much of what.",
    AuditAction.BACKUP_MADE: "Somebody made a back-up (`mcc backup`); not those of `[backup]`.",
    AuditAction.BACKUP_RESTORED: (
        "Somebody put this database in place from a back-up (`mcc restore`); `after` says which one."
    ),
}
"""What each action means, for the reference page."""
