"""Alarms: raised and cleared by their causes, looked after by people, listed, and forgotten at last."""

from service.storage.repository.alarms.calls import AlarmCallRows
from service.storage.repository.alarms.causes import AlarmCauseRows
from service.storage.repository.alarms.conditions import ConditionAlarmRows
from service.storage.repository.alarms.figures import AlarmFigureRows
from service.storage.repository.alarms.groups import AlarmGroupRows
from service.storage.repository.alarms.lists import AlarmLists
from service.storage.repository.alarms.people import AlarmPeopleRows
from service.storage.repository.alarms.sources import AlarmSourceRows
from service.storage.repository.alarms.starts import StartAlarmRows
from service.storage.repository.alarms.suppression import AlarmSuppressionRows


class AlarmRows(
    AlarmLists,
    AlarmCauseRows,
    AlarmPeopleRows,
    AlarmSuppressionRows,
    ConditionAlarmRows,
    StartAlarmRows,
    AlarmFigureRows,
    AlarmCallRows,
    AlarmSourceRows,
    AlarmGroupRows,
):
    """All there is to ask of and tell the database about alarms."""


__all__ = ["AlarmRows"]
