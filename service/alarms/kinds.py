"""The kinds of alarms and their priorities. The words are part of the REST contract."""

from enum import StrEnum


class AlarmPriority(StrEnum):
    """How soon somebody has to act."""

    CRITICAL = "critical"
    HIGH = "high"
    MEDIUM = "medium"
    LOW = "low"


class AlarmKind(StrEnum):
    """What somebody has to look after: at a motor, a relay, a site, or the service itself."""

    CONDITION_FAULT = "condition-fault"
    CONDITION_FORECAST = "condition-forecast"
    CONDITION_WATCH = "condition-watch"
    ROTOR_FAULT = "rotor-fault"
    ROTOR_WATCH = "rotor-watch"
    SUPPLY_FAULT = "supply-fault"
    SUPPLY_WATCH = "supply-watch"
    UNEVEN_AIR_GAP = "uneven-air-gap"
    INEFFICIENT = "inefficient"
    PARAMETER_DRIFT = "parameter-drift"
    HARD_STARTS = "hard-starts"
    CHANGED_STARTS = "changed-starts"
    MOTOR_TRIPPED = "motor-tripped"
    MISSING_DATA = "missing-data"
    LINK_DOWN = "link-down"
    SITE_LOST = "site-lost"
    ALARM_FLOOD = "alarm-flood"
    CLOCK_OFF = "clock-off"
    TIME_ZONE = "time-zone"
    QUARANTINED = "quarantined"
    RELAY_DIFFERS = "relay-differs"
    FILE_REFUSED = "file-refused"
    FILE_TOO_LARGE = "file-too-large"
    FILE_UNSTEADY = "file-unsteady"
    DAILY_LIMIT = "daily-limit"
    DISK_FILLING = "disk-filling"
    CERTIFICATE_END = "certificate-end"
    BACKUP_OVERDUE = "backup-overdue"
    PASSWORD_GUESSING = "password-guessing"  # noqa: S105 - the name of an alarm
    FORGED_TOKENS = "forged-tokens"
    OWNER_LOCKED = "owner-locked"


FOLLOW_FROM_QUARANTINE = frozenset(
    {
        AlarmKind.FILE_REFUSED,
        AlarmKind.FILE_TOO_LARGE,
        AlarmKind.FILE_UNSTEADY,
        AlarmKind.DAILY_LIMIT,
        AlarmKind.RELAY_DIFFERS,
        AlarmKind.TIME_ZONE,
        AlarmKind.CLOCK_OFF,
        AlarmKind.LINK_DOWN,
        AlarmKind.MISSING_DATA,
    }
)
"""Nobody can look after these while the relay is set aside: its quarantine is the alarm then."""

FOLLOW_FROM_SITE_LOST = frozenset(
    {AlarmKind.LINK_DOWN, AlarmKind.MISSING_DATA, AlarmKind.CLOCK_OFF, AlarmKind.FILE_UNSTEADY}
)
"""Of a site that is lost, these follow: its loss is the alarm then."""
