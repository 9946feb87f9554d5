"""The only code that touches the tables, one module a subject."""

from service.storage.repository.access.failed_logins import FailedLoginRows
from service.storage.repository.access.login_links import LoginLinkRows
from service.storage.repository.access.passkeys import PasskeyRows
from service.storage.repository.access.second_factors import SecondFactorRows
from service.storage.repository.access.tokens import TokenRows
from service.storage.repository.access.user_sessions import UserSessionRows
from service.storage.repository.access.users import UserRows
from service.storage.repository.alarms import AlarmRows
from service.storage.repository.audit.trail import AuditRows
from service.storage.repository.backups import BackupRows
from service.storage.repository.conditions.conditions import ConditionRows
from service.storage.repository.conditions.events import ConditionEventRows
from service.storage.repository.conditions.folding import FoldingRows
from service.storage.repository.conditions.motor_conditions import MotorConditionRows
from service.storage.repository.conditions.observations import ObservationRows
from service.storage.repository.conditions.tracking import TrackingRows
from service.storage.repository.history.condition_days import ConditionDayRows
from service.storage.repository.history.conditions import PastConditionRows
from service.storage.repository.history.figure_trends import FigureTrendRows
from service.storage.repository.history.journal import JournalRows
from service.storage.repository.history.metered import MeteredRows
from service.storage.repository.history.neighbours import NeighbourRows
from service.storage.repository.history.record_figures import RecordFigureRows
from service.storage.repository.history.rotor import RotorRows
from service.storage.repository.history.seen_records import SeenRecordRows
from service.storage.repository.history.start_reference import StartReferenceRows
from service.storage.repository.history.start_reports import StartReportRows
from service.storage.repository.history.starts import StartRows
from service.storage.repository.history.thinned_trend import ThinnedTrendRows
from service.storage.repository.inspections import InspectionRows
from service.storage.repository.jobs.notices import JobNoticeRows
from service.storage.repository.jobs.queue import JobRows
from service.storage.repository.jobs.repetitions import RepetitionRows
from service.storage.repository.jobs.runners import JobRunnerRows
from service.storage.repository.load_profiles import LoadProfileRows
from service.storage.repository.measurement_partitions import MeasurementPartitionRows
from service.storage.repository.measurements import MeasurementRows
from service.storage.repository.motor_health import MotorHealthRows
from service.storage.repository.motor_versions import MotorVersionRows
from service.storage.repository.notifications import NotificationRows
from service.storage.repository.overviews import OverviewRows
from service.storage.repository.planned_stops import PlannedStopRows
from service.storage.repository.plant import PlantRows
from service.storage.repository.recordings.baselines import BaselineRows
from service.storage.repository.recordings.copies import CopyRows
from service.storage.repository.recordings.deletions import DeletionRows
from service.storage.repository.recordings.folders import FolderRows
from service.storage.repository.recordings.recordings import RecordingRows
from service.storage.repository.recordings.requests import RecordingRequestRows
from service.storage.repository.recordings.retention import RetentionRows
from service.storage.repository.recordings.series import SeriesRows
from service.storage.repository.recordings.undone_deletions import UndoneDeletionRows
from service.storage.repository.relays.findings import FindingsRows
from service.storage.repository.relays.leases import LeaseRows
from service.storage.repository.relays.links import LinkRows
from service.storage.repository.relays.quarantines import QuarantineRows
from service.storage.repository.relays.remote_records import RemoteRecordRows
from service.storage.repository.relays.reports import RelayReportRows
from service.storage.repository.sites import SiteRows
from service.storage.repository.state_counts import StateCounts


class Repository(
    PlantRows,
    PlannedStopRows,
    SiteRows,
    LinkRows,
    FindingsRows,
    LeaseRows,
    AlarmRows,
    QuarantineRows,
    RecordingRequestRows,
    RecordingRows,
    SeriesRows,
    RemoteRecordRows,
    JobRows,
    RepetitionRows,
    JobRunnerRows,
    JobNoticeRows,
    MotorHealthRows,
    MotorVersionRows,
    SeenRecordRows,
    MeteredRows,
    StartRows,
    StartReferenceRows,
    StartReportRows,
    RotorRows,
    RecordFigureRows,
    FigureTrendRows,
    ThinnedTrendRows,
    NeighbourRows,
    PastConditionRows,
    JournalRows,
    ObservationRows,
    ConditionDayRows,
    ConditionEventRows,
    InspectionRows,
    ConditionRows,
    FoldingRows,
    MotorConditionRows,
    TrackingRows,
    StateCounts,
    MeasurementRows,
    MeasurementPartitionRows,
    LoadProfileRows,
    RelayReportRows,
    BaselineRows,
    CopyRows,
    DeletionRows,
    UndoneDeletionRows,
    FolderRows,
    RetentionRows,
    BackupRows,
    AuditRows,
    NotificationRows,
    UserRows,
    UserSessionRows,
    PasskeyRows,
    SecondFactorRows,
    LoginLinkRows,
    TokenRows,
    FailedLoginRows,
    OverviewRows,
):
    """All there is to ask of and tell the database; every method is one transaction.

    Safe to share between threads: each call takes its own connection. Two processes may each have one.
    """


__all__ = ["Repository"]
