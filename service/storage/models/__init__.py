"""Tables. Times are UTC, integer nanoseconds since 1970 (columns ..._ns); ids are random UUIDs as text.

The code says relay; the tables, their columns and the REST API say IED, as IEC 61850 does.
"""

from service.storage.models.access import (
    ApiTokenRow,
    FailedLoginRow,
    LoginLinkRow,
    PasskeyRow,
    RecoveryCodeRow,
    UsedOnceRow,
    UserRow,
    UserSessionRow,
)
from service.storage.models.alarms import AlarmChangeRow, AlarmRow
from service.storage.models.audit import AuditEntryRow, AuditForwardingRow, AuditHeadRow
from service.storage.models.backups import BackupRow
from service.storage.models.base import Base
from service.storage.models.conditions import (
    ConditionChangeRow,
    ConditionCheckpointRow,
    ConditionDayRow,
    ConditionEventRow,
    ConditionRow,
    FoldMarkRow,
    MotorVersionRow,
    ObservationRow,
)
from service.storage.models.counts import StandingAlarmCountRow, StateCountRow
from service.storage.models.deletions import DeletedRemoteRecordRow, DeletionRow, DiscardedFolderRow
from service.storage.models.diagnoses import DiagnosisRow, JobRow, JobRunnerRow
from service.storage.models.inspections import InspectionPictureRow, InspectionRow
from service.storage.models.measurements import MeasurementRow
from service.storage.models.notifications import NotificationAlarmRow, NotificationRow
from service.storage.models.plant import IedRow, MotorRow, SiteRow
from service.storage.models.record_figures import DETAILS, FIGURE_SUBJECTS, RecordFiguresRow, details_of
from service.storage.models.recordings import (
    BaselineRecordingRow,
    BaselineRow,
    OutlineRow,
    RecordingFileRow,
    RecordingRequestRow,
    RecordingRow,
    RemoteRecordRow,
)
from service.storage.models.relay_reports import RelayEventRow, RelayStatisticsRow
from service.storage.models.relays import (
    GatewayRow,
    LeaseRow,
    LinkChangeRow,
    LinkFiguresRow,
    QuarantineRow,
    RelayFindingsRow,
)
from service.storage.models.rotor import RotorFindingRow
from service.storage.models.starts import StartRow

__all__ = [
    "DETAILS",
    "FIGURE_SUBJECTS",
    "AlarmChangeRow",
    "AlarmRow",
    "ApiTokenRow",
    "AuditEntryRow",
    "AuditForwardingRow",
    "AuditHeadRow",
    "BackupRow",
    "Base",
    "BaselineRecordingRow",
    "BaselineRow",
    "ConditionChangeRow",
    "ConditionCheckpointRow",
    "ConditionDayRow",
    "ConditionEventRow",
    "ConditionRow",
    "DeletedRemoteRecordRow",
    "DeletionRow",
    "DiagnosisRow",
    "DiscardedFolderRow",
    "FailedLoginRow",
    "FoldMarkRow",
    "GatewayRow",
    "IedRow",
    "InspectionPictureRow",
    "InspectionRow",
    "JobRow",
    "JobRunnerRow",
    "LeaseRow",
    "LinkChangeRow",
    "LinkFiguresRow",
    "LoginLinkRow",
    "MeasurementRow",
    "MotorRow",
    "MotorVersionRow",
    "NotificationAlarmRow",
    "NotificationRow",
    "ObservationRow",
    "OutlineRow",
    "PasskeyRow",
    "QuarantineRow",
    "RecordFiguresRow",
    "RecordingFileRow",
    "RecordingRequestRow",
    "RecordingRow",
    "RecoveryCodeRow",
    "RelayEventRow",
    "RelayFindingsRow",
    "RelayStatisticsRow",
    "RemoteRecordRow",
    "RotorFindingRow",
    "SiteRow",
    "StandingAlarmCountRow",
    "StartRow",
    "StateCountRow",
    "UsedOnceRow",
    "UserRow",
    "UserSessionRow",
    "details_of",
]
