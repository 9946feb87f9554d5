"""Which reports are sent by mail, when, and to whom: the table [reports] of the settings."""

from typing import Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from service.configuration.notifications import Clock, Day, Names

MOST_MAILS = 50
MOST_NAMES = 1000
PERIODS_OF = {
    "fleet": ("daily", "weekly"),
    "motor": ("daily", "weekly", "monthly"),
    "alarms": ("monthly",),
}


class ReportMail(BaseModel):
    """A report that is sent at a time of day: daily, on a day of the week, or on the first of the month.

    motors: of which the report `motor` is made, one mail each.  sites: of the other two; None for all.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    report: Literal["fleet", "motor", "alarms"]
    period: Literal["daily", "weekly", "monthly"]
    channels: Names
    at: Clock
    day: Day = "mon"
    format: Literal["pdf", "xlsx"] = "pdf"
    sites: tuple[str, ...] | None = Field(default=None, min_length=1, max_length=MOST_NAMES)
    motors: tuple[str, ...] | None = Field(default=None, min_length=1, max_length=MOST_NAMES)

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        """Raise ValueError where a key does not fit the kind of report."""
        periods = PERIODS_OF[self.report]
        if self.period not in periods:
            raise ValueError(
                f"period {' or '.join(periods)} of the report {self.report}, found {self.period}"
            )
        if self.report == "motor" and self.motors is None:
            raise ValueError('motors, such as ["PUMP-A1"], with the report motor, found none')
        if self.report != "motor" and self.motors is not None:
            raise ValueError(f"motors with the report motor only, found them with {self.report}")
        if self.report == "motor" and self.sites is not None:
            raise ValueError("sites with the reports fleet and alarms only, found them with motor")
        return self


class ReportSettings(BaseModel):
    """All of the table. Without mails reports are made when somebody asks for them."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    mails: tuple[ReportMail, ...] = Field(default=(), max_length=MOST_MAILS)
