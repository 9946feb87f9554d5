"""The table [motor.relay] of the motors file, which overrides what is recognised in a relay."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from core.error_words import nearest

NONE = "none"
"""This word in place of a reference means: use none, whatever the relay offers."""

_REFERENCES = {
    "trigger": 'a control such as "A1_SEL710CON/RBGGIO1.SPCSO01", or "none"',
    "report_control": 'a report control block such as "A1_SEL710CFG/LLN0.BR.BRep01", or "none"',
}
_LONGEST = 200


class TriggerAction(StrEnum):
    """How a trigger is operated.

    SET_RESET: to true, and to false a moment later (a remote bit).
    PULSE: to true alone; it goes back by itself.
    """

    SET_RESET = "set-reset"
    PULSE = "pulse"


@dataclass(frozen=True, slots=True)
class Overrides:
    """What to use of a relay. None: what is recognised; `NONE` in place of a reference: nothing."""

    trigger: str | None = None
    trigger_action: TriggerAction | None = None
    report_control: str | None = None
    events_directory: str | None = None


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
    action = given.pop("trigger_action", None)
    if action is not None and action not in tuple(TriggerAction):
        raise OverrideError(
            "relay.trigger_action",
            expected=" or ".join(map(repr, map(str, TriggerAction))),
            found=repr(action),
        )
    trigger, report_control = (
        _reference(name, given.pop(name, None), expected) for name, expected in _REFERENCES.items()
    )
    directory = given.pop("events_directory", None)
    if directory is not None and not (isinstance(directory, str) and _printable(directory)):
        raise OverrideError(
            "relay.events_directory",
            expected='a folder of the relay such as "COMTRADE"',
            found=repr(directory),
        )
    if given:
        known = [*_REFERENCES, "trigger_action", "events_directory", "name"]
        unknown = next(iter(given))
        raise OverrideError(
            f"relay.{unknown}",
            expected=f"one of {', '.join(known)}",
            found="another name",
            nearest=nearest(unknown, known),
        )
    return Overrides(
        trigger=trigger,
        trigger_action=None if action is None else TriggerAction(action),
        report_control=report_control,
        events_directory=directory,
    )


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
