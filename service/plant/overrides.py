"""The table [motor.relay] of the motors file, which overrides what is recognised in a relay."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import StrEnum
from typing import TypeVar

from core.error_words import nearest
from core.relay_reports.clock_times import DateOrder
from service.plant.quantities import PowerUnit

NONE = "none"
"""This word in place of a reference means: use none, whatever the relay offers."""

_REFERENCES = {
    "trigger": 'a control such as "A1_SEL710CON/RBGGIO1.SPCSO01", or "none"',
    "report_control": 'a report control block such as "A1_SEL710CFG/LLN0.BR.BRep01", or "none"',
}
_FOLDERS = {
    "events_directory": 'a folder of the relay such as "COMTRADE"',
    "reports_directory": 'a folder of the relay such as "REPORTS", or "none"',
}
_LONGEST = 200
_Word = TypeVar("_Word", bound=StrEnum)


class TriggerAction(StrEnum):
    """How a trigger is operated.

    SET_RESET: to true, and to false a moment later (a remote bit).
    PULSE: to true alone; it goes back by itself.
    """

    SET_RESET = "set-reset"
    PULSE = "pulse"


@dataclass(frozen=True, slots=True)
class Overrides:
    """What to use of a relay. None: what is recognised.

    `NONE` in place of a reference, or of the folder of text reports: nothing.

    report_date_order: of its text reports; None: as their headings show it.
    report_power_unit: of P and Q in its load profiles; None: they are left out.
    """

    trigger: str | None = None
    trigger_action: TriggerAction | None = None
    report_control: str | None = None
    events_directory: str | None = None
    reports_directory: str | None = None
    report_date_order: DateOrder | None = None
    report_power_unit: PowerUnit | None = None


AS_RECOGNISED = Overrides()


class OverrideError(ValueError):
    """A key of the table cannot be used; it says which one, what was expected and what was found."""

    def __init__(self, field: str, *, expected: str, found: str, nearest: str | None = None) -> None:
        super().__init__(f"{field}: expected {expected}, found {found}")
        self.field = field
        self.expected = expected
        self.found = found
        self.nearest = nearest


def overrides_from_table(table: object) -> Overrides:
    """Read the table. Raises OverrideError for an unknown key or a value that cannot be used."""
    if not isinstance(table, Mapping):
        raise OverrideError("relay", expected="a table", found=repr(table))
    given = dict(table)
    action = _word("trigger_action", given.pop("trigger_action", None), TriggerAction)
    trigger, report_control = (
        _reference(name, given.pop(name, None), expected) for name, expected in _REFERENCES.items()
    )
    directory, reports = (
        _folder(name, given.pop(name, None), expected) for name, expected in _FOLDERS.items()
    )
    order = _word("report_date_order", given.pop("report_date_order", None), DateOrder)
    unit = _word("report_power_unit", given.pop("report_power_unit", None), PowerUnit)
    if given:
        known = [field.name for field in fields(Overrides)] + ["name"]
        unknown = next(iter(given))
        raise OverrideError(
            f"relay.{unknown}",
            expected=f"one of {', '.join(known)}",
            found="another name",
            nearest=nearest(unknown, known),
        )
    return Overrides(
        trigger=trigger,
        trigger_action=action,
        report_control=report_control,
        events_directory=directory,
        reports_directory=reports,
        report_date_order=order,
        report_power_unit=unit,
    )


def _folder(name: str, value: object, expected: str) -> str | None:
    if value is None:
        return None
    if not (isinstance(value, str) and _printable(value)):
        raise OverrideError(f"relay.{name}", expected=expected, found=repr(value))
    return value


def _word(name: str, value: object, words: type[_Word]) -> _Word | None:
    if value is None:
        return None
    if value not in tuple(words):
        expected = " or ".join(repr(word.value) for word in words)
        raise OverrideError(f"relay.{name}", expected=expected, found=repr(value))
    return words(str(value))


def _reference(name: str, value: object, expected: str) -> str | None:
    if value is None or value == NONE:
        return NONE if value == NONE else None
    blocks = (".BR.", ".RP.") if name == "report_control" else (".",)
    usable = isinstance(value, str) and _printable(value) and "/" in value
    if not usable or not any(block in str(value) for block in blocks):
        raise OverrideError(f"relay.{name}", expected=expected, found=repr(value))
    return str(value)


def _printable(text: str) -> bool:
    return text.isascii() and text.isprintable() and 0 < len(text) <= _LONGEST
