"""How soon somebody has to act on each kind of alarm."""

from collections.abc import Mapping

from service.storage.states import AlarmKind, AlarmPriority

PRIORITY_OF: Mapping[AlarmKind, AlarmPriority] = {
    AlarmKind.FILE_REFUSED: AlarmPriority.LOW,
    AlarmKind.FILE_TOO_LARGE: AlarmPriority.LOW,
    AlarmKind.FILE_UNSTEADY: AlarmPriority.LOW,
    AlarmKind.DAILY_LIMIT: AlarmPriority.LOW,
    AlarmKind.QUARANTINED: AlarmPriority.MEDIUM,
    AlarmKind.RELAY_DIFFERS: AlarmPriority.LOW,
    AlarmKind.TIME_ZONE: AlarmPriority.LOW,
    AlarmKind.CONDITION_WATCH: AlarmPriority.MEDIUM,
    AlarmKind.CONDITION_FAULT: AlarmPriority.HIGH,
}
