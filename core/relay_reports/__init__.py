"""Reads text reports of motor relays: starts, load profile, statistics, sequence of events."""

from core.relay_reports.error import ReportError
from core.relay_reports.heading import clock_of_report
from core.relay_reports.kinds import ReportKind, kind_of_report
from core.relay_reports.load_profile import LoadRows, read_load_profile
from core.relay_reports.motor_starts import StartReport, read_motor_starts
from core.relay_reports.motor_statistics import MotorStatistics, read_motor_statistics
from core.relay_reports.sequence_of_events import StateChange, read_sequence_of_events

__all__ = [
    "LoadRows",
    "MotorStatistics",
    "ReportError",
    "ReportKind",
    "StartReport",
    "StateChange",
    "clock_of_report",
    "kind_of_report",
    "read_load_profile",
    "read_motor_starts",
    "read_motor_statistics",
    "read_sequence_of_events",
]
