"""Who is told what, through which channel, and when: the table [notifications] of the settings."""

import re
from datetime import time
from typing import Annotated, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PlainSerializer,
    model_validator,
)

from core.error_words import nearest, shown
from service.configuration.channels import Channel, ChannelName, variable_part
from service.configuration.time_zones import is_time_zone, nearest_time_zone

Day = Literal["mon", "tue", "wed", "thu", "fri", "sat", "sun"]
DAYS: tuple[Day, ...] = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")
Priority = Literal["critical", "high", "medium", "low"]
Event = Literal["raised", "reopened", "cleared", "acknowledged"]

MOST_CHANNELS = 50
MOST_ROUTES = 200
MINUTES_PER_DAY = 1440


def _zone(name: str) -> str:
    if not is_time_zone(name):
        near = nearest_time_zone(name)
        meant = "" if near is None else f" (did you mean {near}?)"
        raise ValueError(f"a time zone of the IANA such as Europe/Berlin{meant}")
    return name


def _clock(value: object) -> object:
    """Return a time of day; TOML has such values of its own, with seconds."""
    if isinstance(value, time) and (value.second, value.microsecond, value.tzinfo) == (0, 0, None):
        return value
    found = re.fullmatch(r"(\d\d):(\d\d)", value) if isinstance(value, str) else None
    if found is None or int(found[1]) > 23 or int(found[2]) > 59:
        raise ValueError('a time of day such as "18:00"')
    return time(int(found[1]), int(found[2]))


def _address(url: str) -> str:
    if re.fullmatch(r"https?://[^\s/@?#]+(/[^\s?#]*)?", url) is None:
        raise ValueError("an address such as https://mcc.plant.example")
    return url.rstrip("/")


TimeZone = Annotated[str, AfterValidator(_zone)]
Clock = Annotated[
    time,
    BeforeValidator(_clock),
    # A gateway process gets the settings as JSON, and reads what this writes.
    PlainSerializer(lambda clock: f"{clock:%H:%M}", return_type=str, when_used="json"),
]
Address = Annotated[str, Field(max_length=500), AfterValidator(_address)]
Names = Annotated[tuple[ChannelName, ...], Field(min_length=1, max_length=MOST_CHANNELS)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, populate_by_name=True)


class Escalation(_Table):
    """Who is told besides when nobody has acknowledged an alarm for so long."""

    after_min: float = Field(ge=0.01, le=7 * MINUTES_PER_DAY)
    channels: Names


class Hours(_Table):
    """Days of the week, and times of day in the plant's zone.

    The hours go over midnight where they end before they begin; they then belong to the day they began on.
    """

    days: tuple[Day, ...] = Field(default=DAYS, min_length=1, max_length=7)
    begin: Clock = Field(default=time(0, 0), alias="from")
    end: Clock = Field(default=time(0, 0), alias="until")


class Route(Hours):
    """Which alarms go through which channels. What is not given is not asked for.

    outside_hours: what becomes of an alarm at other times: it is not told by this route, or it is told when
    the hours begin, if nobody has acknowledged it and its cause stands then.
    """

    name: str | None = Field(default=None, max_length=100)
    channels: Names
    sites: tuple[str, ...] | None = Field(default=None, min_length=1, max_length=1000)
    priorities: tuple[Priority, ...] | None = Field(default=None, min_length=1)
    kinds: tuple[str, ...] | None = Field(default=None, min_length=1, max_length=100)
    events: tuple[Event, ...] = Field(default=("raised", "reopened"), min_length=1)
    outside_hours: Literal["skip", "wait"] = "skip"
    escalations: tuple[Escalation, ...] = Field(default=(), max_length=10)


class Digest(_Table):
    """A summary at a time of day: every day, or once a week."""

    period: Literal["daily", "weekly"]
    channels: Names
    at: Clock
    day: Day = "mon"
    sites: tuple[str, ...] | None = Field(default=None, min_length=1, max_length=1000)


class NotificationSettings(_Table):
    """All of the table. Without channels nobody is told anything."""

    time_zone: TimeZone = "UTC"
    address: Address | None = None
    gather_s: float = Field(default=10.0, ge=0, le=600)
    pause_s: float = Field(default=60.0, ge=0, le=3600)
    attempts: int = Field(default=30, ge=1, le=1000)
    retry_delay_s: float = Field(default=10.0, ge=0.01, le=3600)
    keep_days: float = Field(default=90.0, ge=1, le=36_500)
    channels: dict[ChannelName, Channel] = Field(default_factory=dict, max_length=MOST_CHANNELS)
    routes: tuple[Route, ...] = Field(default=(), max_length=MOST_ROUTES)
    digests: tuple[Digest, ...] = Field(default=(), max_length=MOST_CHANNELS)

    @model_validator(mode="after")
    def _channels_are_known(self) -> Self:
        """Raise ValueError where a route or a digest names a channel that there is not."""
        named = [
            *(
                (f"routes.{number}", name)
                for number, route in enumerate(self.routes)
                for name in route.channels
            ),
            *(
                (f"routes.{number}.escalations", name)
                for number, route in enumerate(self.routes)
                for escalation in route.escalations
                for name in escalation.channels
            ),
            *(
                (f"digests.{number}", name)
                for number, one in enumerate(self.digests)
                for name in one.channels
            ),
        ]
        for where, name in named:
            if name not in self.channels:
                near = nearest(name, self.channels)
                meant = "" if near is None else f" (did you mean {near}?)"
                known = ", ".join(self.channels) or "none is there"
                raise ValueError(
                    f"in {where} channels that [notifications.channels.NAME] defines ({known}), "
                    f"found {shown(name)}{meant}"
                )
        return self

    @model_validator(mode="after")
    def _variables_differ(self) -> Self:
        """Raise ValueError where two channels would have the same variables in the environment."""
        parts: dict[str, str] = {}
        for name in self.channels:
            other = parts.setdefault(variable_part(name), name)
            if other != name:
                raise ValueError(
                    f"channels whose names differ by more than capitals and dashes, found {other} and {name}"
                )
        return self
