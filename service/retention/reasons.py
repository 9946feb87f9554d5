"""Why a recording that is old enough stays, in words, with the setting behind it."""

from collections.abc import Mapping
from types import MappingProxyType

from service.storage.states import StayReason

WORDS: Mapping[StayReason, str] = MappingProxyType(
    {
        StayReason.RUNNING: "a diagnosis of it is running",
        StayReason.BASELINE: "it is part of the motor's baseline",
        StayReason.ALARM: "an alarm of the motor rests on it that is not over",
        StayReason.NOTE: "it is next to what somebody told of the motor",
        StayReason.CHECKPOINT: "the motor's condition is folded up to it",
        StayReason.NEWEST: "one of the newest of the motor (retention.keep_newest)",
        StayReason.STARTS: "one of the newest usable starts (retention.keep_starts)",
        StayReason.FIRST: "of the motor's first days (retention.keep_first_days)",
        StayReason.CHANGE: "next to a change of verdict or condition (retention.keep_changes)",
        StayReason.OPERATION: "of what the motor does in it (retention.keep_operations)",
        StayReason.ONE_IN: "the first of its days (retention.keep_one_in_days)",
    }
)
