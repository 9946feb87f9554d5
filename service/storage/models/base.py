"""What all tables share: how names, times and states are stored."""

from collections.abc import Mapping
from enum import StrEnum
from typing import Any

from sqlalchemy import JSON, BigInteger, Dialect, Enum, MetaData, String, TypeDecorator
from sqlalchemy.orm import DeclarativeBase

from core.condition.events import EventKind
from core.condition.kinds import Kind, State
from core.condition.observation import VoltageChannels
from core.diagnosis.verdict import Verdict
from core.machines.parameters import ParametersSource
from core.operation import Operation
from core.rotor.finding import RotorState
from core.signals.sequence import PhaseSequence
from service.storage.states import (
    AlarmEvent,
    AlarmKind,
    AlarmPriority,
    AlarmState,
    BackupState,
    ClockQuality,
    DeletedBy,
    InspectionOutcome,
    JobState,
    LinkState,
    MeasurementSource,
    NotificationKind,
    NotificationState,
    NotifiedEvent,
    RecordingRequestOrigin,
    RecordingRequestState,
    RecordingSource,
    RecordingState,
    RelayEventKind,
    StartSource,
)


def _words(enum: type[StrEnum], length: int = 16) -> Enum:
    """Return a column of the enum's values as text.

    Any database tool can read it, and a new value needs no migration.
    """
    return Enum(
        enum,
        values_callable=lambda members: [member.value for member in members],
        native_enum=False,
        create_constraint=False,
        length=length,
    )


class _Kinds(TypeDecorator[tuple[Kind, ...]]):
    """Kinds in their order, as their values with spaces between; null where there are none."""

    impl = String
    cache_ok = True

    def process_bind_param(self, value: tuple[Kind, ...] | None, _dialect: Dialect) -> str | None:
        return " ".join(value) if value else None

    def process_result_value(self, value: str | None, _dialect: Dialect) -> tuple[Kind, ...]:
        return tuple(map(Kind, value.split())) if value else ()


class _Items(TypeDecorator[tuple[Any, ...]]):
    """Numbers or texts in their order, as a list of JSON."""

    impl = JSON(none_as_null=True)
    cache_ok = True

    def process_bind_param(self, value: tuple[Any, ...] | None, _dialect: Dialect) -> list[Any] | None:
        return None if value is None else list(value)

    def process_result_value(self, value: list[Any] | None, _dialect: Dialect) -> tuple[Any, ...] | None:
        return None if value is None else tuple(value)


class Base(DeclarativeBase):
    metadata = MetaData(
        naming_convention={
            "ix": "ix_%(table_name)s_%(column_0_N_name)s",
            "uq": "uq_%(table_name)s_%(column_0_N_name)s",
            "ck": "ck_%(table_name)s_%(constraint_name)s",
            "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map = {  # noqa: RUF012  # SQLAlchemy's own declaration style
        int: BigInteger,
        LinkState: _words(LinkState),
        BackupState: _words(BackupState),
        AlarmKind: _words(AlarmKind, 32),
        AlarmPriority: _words(AlarmPriority),
        AlarmState: _words(AlarmState, 32),
        AlarmEvent: _words(AlarmEvent, 32),
        ClockQuality: _words(ClockQuality),
        RecordingRequestOrigin: _words(RecordingRequestOrigin),
        RecordingRequestState: _words(RecordingRequestState),
        RecordingState: _words(RecordingState),
        RecordingSource: _words(RecordingSource),
        MeasurementSource: _words(MeasurementSource),
        RelayEventKind: _words(RelayEventKind),
        StartSource: _words(StartSource),
        DeletedBy: _words(DeletedBy),
        InspectionOutcome: _words(InspectionOutcome),
        JobState: _words(JobState),
        NotificationKind: _words(NotificationKind),
        NotificationState: _words(NotificationState),
        NotifiedEvent: _words(NotifiedEvent),
        Operation: _words(Operation),
        Verdict: _words(Verdict),
        ParametersSource: _words(ParametersSource),
        State: _words(State),
        Kind: _words(Kind),
        tuple[Kind, ...]: _Kinds,
        EventKind: _words(EventKind, 32),
        RotorState: _words(RotorState),
        PhaseSequence: _words(PhaseSequence),
        VoltageChannels: _words(VoltageChannels),
        tuple[float, ...]: _Items,
        tuple[str, ...]: _Items,
        Mapping[str, object]: JSON,
        list[Mapping[str, object]]: JSON,
    }
