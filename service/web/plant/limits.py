"""The limits and periods that are in force, from the settings. None of them is a secret."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from service.configuration.alarms import AlarmSettings
from service.configuration.settings import Settings
from service.web.words import duration, figure, size

ALARM_RULES: Final[Mapping[str, str]] = {
    "watch_records": "so many of the latest records have to be at least “watch” before it is told",
    "watch_of_records": "of so many latest records",
    "fault_records": "so many of the latest records have to be “fault” before it is told",
    "fault_of_records": "of so many latest records",
    "healthy_records": "so many healthy records in a row end an alarm",
    "growth_share": "a level that grew by this share calls again",
    "forecast_days": "a motor that likely reaches its limit within this time is told",
    "link_down_s": "a relay that does not answer for so long is told",
    "link_up_s": "it has to answer for so long to be back",
    "site_lost_s": "the relays of a site are away for so long before it is lost",
    "site_lost_share": "this share of its relays has to be away",
    "site_lost_relays": "and at least so many of them",
    "flood_alarms": "more alarms of one priority within a minute become one line",
    "clock_off_s": "a relay’s clock that is surely off by more is told",
    "disk_free_share": "a disk with a smaller free share is told",
    "disk_full_days": "a disk that will be full within this time is told",
    "certificate_days": "a certificate that ends within this time is told",
}
"""What each setting of [alarms] is for."""

COLLECTING: Final[Mapping[str, str]] = {
    "poll_period_s": "how often the directory of a relay is listed",
    "metering_period_s": "how often measured values are read; 0 for never",
    "text_report_period_s": "how often text reports of relays are looked for; 0 for never",
    "record_timeout_s": "how long a requested record may take",
    "request_timeout_s": "how long a relay may take to answer",
    "quarantine_s": "how long a relay is set aside the first time",
    "max_file_bytes": "largest file of a record",
    "max_relay_bytes_per_day": "most that one relay may send in a day (UTC)",
    "max_upload_bytes": "largest upload",
    "max_open_requests": "recording requests of a motor that may wait",
    "max_queued_diagnoses": "diagnoses of a motor that may wait",
    "max_notes": "notes that a motor may have",
}
"""Settings of collecting and storing."""


@dataclass(frozen=True, slots=True)
class LimitLine:
    """A setting with its value and what it is for."""

    setting: str
    value: str
    meaning: str


@dataclass(frozen=True, slots=True)
class LimitGroup:
    """Settings that belong together."""

    words: str
    lines: Sequence[LimitLine]


def limit_groups(settings: Settings) -> Sequence[LimitGroup]:
    """Return the limits that are in force."""
    rules = settings.alarms
    alarms = [
        LimitLine(f"alarms.{name}", in_words(name, getattr(rules, name)), ALARM_RULES[name])
        for name in AlarmSettings.model_fields
    ]
    collecting = [
        LimitLine(name, in_words(name, getattr(settings, name)), meaning)
        for name, meaning in COLLECTING.items()
    ]
    stale = settings.stale_after_days
    freshness = LimitLine(
        "stale_after_days",
        "2.5 pauses of the motor’s schedule, a week without one"
        if stale is None
        else in_words("stale_after_days", stale),
        "a condition without a valid record for longer is not called recent",
    )
    return [LimitGroup("When alarms are raised", [freshness, *alarms]), LimitGroup("Collecting", collecting)]


def in_words(name: str, value: float) -> str:
    """Return a value with the unit that the setting's name has."""
    if name.endswith("_s"):
        return duration(value) if value >= 1 else figure(value, "s")
    if name.endswith("_days"):
        return f"{value:g} days"
    if name.endswith("_share"):
        return f"{100 * value:g} %"
    if "bytes" in name:
        return size(int(value))
    return f"{value:g}"
