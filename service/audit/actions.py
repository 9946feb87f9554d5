"""What the audit trail knows of: every action that leaves an entry, in words."""

from collections.abc import Mapping
from enum import StrEnum


class AuditAction(StrEnum):
    """What was done. A test finds routes that change something without one."""

    RECORDING_REQUESTED = "recording-requested"
    RECORDING_UPLOADED = "recording-uploaded"
    REPORT_IMPORTED = "report-imported"
    RECORDING_DELETED = "recording-deleted"
    RECORDING_DELETION_UNDONE = "recording-deletion-undone"
    DIAGNOSIS_REQUESTED = "diagnosis-requested"
    BASELINE_SET = "baseline-set"
    BASELINE_DELETED = "baseline-deleted"
    NOTE_ADDED = "note-added"
    NOTE_WITHDRAWN = "note-withdrawn"
    REFERENCE_RESTARTED = "reference-restarted"
    INSPECTION_ADDED = "inspection-added"
    INSPECTION_WITHDRAWN = "inspection-withdrawn"
    STOP_PLANNED = "stop-planned"
    STOP_CANCELLED = "stop-cancelled"
    QUARANTINE_RELEASED = "quarantine-released"
    ALARM_ACKNOWLEDGED = "alarm-acknowledged"
    ALARM_ACKNOWLEDGEMENT_UNDONE = "alarm-acknowledgement-undone"
    ALARM_SHELVED = "alarm-shelved"
    ALARM_UNSHELVED = "alarm-unshelved"
    ALARM_TAKEN_OUT_OF_SERVICE = "alarm-taken-out-of-service"
    ALARM_PUT_BACK_IN_SERVICE = "alarm-put-back-in-service"
    CHANNEL_TESTED = "channel-tested"
    NOTIFICATION_RETRIED = "notification-retried"
    LOGGED_IN = "logged-in"
    LOGIN_FAILED = "login-failed"
    LOGIN_LOCKED = "login-locked"
    LOGIN_REFUSED = "login-refused"
    REQUEST_REFUSED = "request-refused"
    TOKEN_REFUSED = "token-refused"  # noqa: S105 - the name of an action
    SESSION_REFUSED = "session-refused"
    LOGIN_LINK_MADE = "login-link-made"
    LOGGED_OUT = "logged-out"
    SESSIONS_ENDED = "sessions-ended"
    USER_ADDED = "user-added"
    USER_CHANGED = "user-changed"
    USER_UNLOCKED = "user-unlocked"
    USER_DELETED = "user-deleted"
    PASSWORD_SET = "password-set"  # noqa: S105 - the name of an action
    SECOND_FACTOR_BEGUN = "second-factor-begun"
    SECOND_FACTOR_ADDED = "second-factor-added"
    SECOND_FACTOR_REMOVED = "second-factor-removed"
    SECOND_FACTOR_RESET = "second-factor-reset"
    RECOVERY_CODES_MADE = "recovery-codes-made"
    RECOVERY_CODE_USED = "recovery-code-used"
    TOKEN_ADDED = "token-added"  # noqa: S105 - the name of an action
    TOKEN_REVOKED = "token-revoked"  # noqa: S105 - the name of an action
    TOKENS_REVOKED = "tokens-revoked"
    SERVICE_STARTED = "service-started"
    SERVICE_ENDED = "service-ended"
    SETTINGS_CHANGED = "settings-changed"
    PLANT_CHANGED = "plant-changed"
    PARAMETERS_CHANGED = "parameters-changed"
    RETENTION_APPLIED = "retention-applied"
    BACKUP_MADE = "backup-made"
    BACKUP_RESTORED = "backup-restored"
    PLANT_PURGED = "plant-purged"


MEANINGS: Mapping[AuditAction, str] = {
    AuditAction.RECORDING_REQUESTED: "Somebody had a motor recorded (`mcc trigger`).",
    AuditAction.RECORDING_UPLOADED: "Somebody gave the service a recording.",
    AuditAction.REPORT_IMPORTED: "Somebody brought a relay's text report; `after` tells which, and counts.",
    AuditAction.RECORDING_DELETED: "Somebody deleted a recording; `before` is what it was.",
    AuditAction.RECORDING_DELETION_UNDONE: "Who deleted a recording undid it within ten minutes.",
    AuditAction.DIAGNOSIS_REQUESTED: "Somebody had a recording diagnosed again.",
    AuditAction.BASELINE_SET: "Somebody chose the healthy recordings of a motor, in place of others.",
    AuditAction.BASELINE_DELETED: "Somebody dropped a motor's baseline.",
    AuditAction.NOTE_ADDED: "Somebody wrote into a motor's logbook.",
    AuditAction.NOTE_WITHDRAWN: "Somebody let a note count no more.",
    AuditAction.REFERENCE_RESTARTED: "Somebody took a motor for healthy as it is.",
    AuditAction.INSPECTION_ADDED: "Somebody told what an inspection of a motor found, or gave a picture.",
    AuditAction.INSPECTION_WITHDRAWN: "Somebody let an inspection count no more.",
    AuditAction.STOP_PLANNED: "Somebody planned when a motor or a site stops; `after` says when.",
    AuditAction.STOP_CANCELLED: "Somebody dropped the plan of a stop.",
    AuditAction.QUARANTINE_RELEASED: "Somebody had a relay visited again; `before` is why it was set aside.",
    AuditAction.ALARM_ACKNOWLEDGED: "Somebody took notice of an alarm, with the comment in `after`.",
    AuditAction.ALARM_ACKNOWLEDGEMENT_UNDONE: "Who acknowledged an alarm undid it within ten minutes.",
    AuditAction.ALARM_SHELVED: "Somebody set an alarm aside; `after` says until when, or until which value.",
    AuditAction.ALARM_UNSHELVED: "Somebody ended the shelving of an alarm.",
    AuditAction.ALARM_TAKEN_OUT_OF_SERVICE: "Somebody set an alarm aside without an end.",
    AuditAction.ALARM_PUT_BACK_IN_SERVICE: "Somebody put an alarm back in service.",
    AuditAction.CHANNEL_TESTED: "Somebody had a test message sent through a channel.",
    AuditAction.NOTIFICATION_RETRIED: "Somebody had a message tried again that was given up.",
    AuditAction.LOGGED_IN: "Somebody logged in; `after` says how.",
    AuditAction.LOGIN_FAILED: "Somebody tried to log in under this name and was refused; `after` says why.",
    AuditAction.LOGIN_LOCKED: "So many logins failed that none is tried for a while; `after` has from where.",
    AuditAction.LOGIN_REFUSED: (
        "Somebody tried to log in during the pause that follows failed logins; `after` counts the `requests`."
    ),
    AuditAction.REQUEST_REFUSED: (
        "Somebody asked for what their roles, or the scope of their token, do not allow; `after` counts the "
        "`requests`."
    ),
    AuditAction.TOKEN_REFUSED: (
        "Somebody showed a token that is unknown, revoked or expired; `after` counts the `requests`."
    ),
    AuditAction.SESSION_REFUSED: (
        "Somebody showed a session that has ended, or never was; `after` counts the `requests`."
    ),
    AuditAction.LOGIN_LINK_MADE: "A link was made that logs a user in once; `after` says until when.",
    AuditAction.LOGGED_OUT: "Somebody ended their session.",
    AuditAction.SESSIONS_ENDED: "Somebody ended all sessions of a user.",
    AuditAction.USER_ADDED: "Somebody made a user.",
    AuditAction.USER_CHANGED: "Somebody changed a user's roles or name, or disabled or enabled them.",
    AuditAction.USER_UNLOCKED: "Somebody had a user's failed logins forgotten.",
    AuditAction.USER_DELETED: "Somebody deleted a user; `before` is who it was.",
    AuditAction.PASSWORD_SET: (
        "Somebody changed a user's password, not kept here; `after` says whether they must change it."
    ),
    AuditAction.SECOND_FACTOR_BEGUN: "Somebody began to set up a second factor.",
    AuditAction.SECOND_FACTOR_ADDED: "Somebody set up a second factor of their own; `after` says which kind.",
    AuditAction.SECOND_FACTOR_REMOVED: "Somebody removed their own second factor, or one passkey (`before`).",
    AuditAction.SECOND_FACTOR_RESET: "Somebody removed a user's second factor; a code lets them in once.",
    AuditAction.RECOVERY_CODES_MADE: "Somebody made other recovery codes of their own.",
    AuditAction.RECOVERY_CODE_USED: "A recovery code was used to log in; `after` says how many are left.",
    AuditAction.TOKEN_ADDED: "Somebody made a token for programs, which is not kept here.",
    AuditAction.TOKEN_REVOKED: "Somebody ended a token, or the one that it was made with.",
    AuditAction.TOKENS_REVOKED: (
        "All tokens of a user ended: on request, or with password, sessions or account; `before` has them."
    ),
    AuditAction.SERVICE_STARTED: "The service started; `after` has its version, host and process.",
    AuditAction.SERVICE_ENDED: "The service ended in order. There is no entry where it was killed.",
    AuditAction.SETTINGS_CHANGED: (
        "The service started with other settings than before. A setting that has its default is null."
    ),
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
    AuditAction.PLANT_PURGED: (
        "Somebody had all of the plant deleted (`mcc purge`): the last entry, in the file that it exported."
    ),
}
"""What each action means, for the reference page."""
