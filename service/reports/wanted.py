"""Which report is wanted: what of, and until when."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from service.reports.times import FleetPeriod


class ReportFormat(StrEnum):
    """As what a report is made."""

    PDF = "pdf"
    XLSX = "xlsx"

    @property
    def media_type(self) -> str:
        """Return what HTTP and mail call it."""
        return {
            ReportFormat.PDF: "application/pdf",
            ReportFormat.XLSX: "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
        }[self]


@dataclass(frozen=True, slots=True)
class FleetReport:
    """How all motors were at a time, and what happened in the day or week before. sites: None for all."""

    period: FleetPeriod
    until_ns: int
    sites: Sequence[str] | None = None


@dataclass(frozen=True, slots=True)
class MotorReport:
    """All of one motor until a time."""

    motor: str
    until_ns: int


@dataclass(frozen=True, slots=True)
class AlarmsReport:
    """All alarms of a month, such as 2026-11, in the time zone of the settings. sites: None for all.

    until_ns: nothing later is told, where the month is not over then.
    """

    month: str
    until_ns: int
    sites: Sequence[str] | None = None


WantedReport = FleetReport | MotorReport | AlarmsReport
