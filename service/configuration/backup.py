"""When the service backs itself up, and where: the table [backup] of the settings."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from service.configuration.relay_access import AbsolutePath

CLOCK_TIME = r"^([01][0-9]|2[0-3]):[0-5][0-9]$"


class BackupSettings(BaseModel):
    """Where and when back-ups are made; without a directory the service makes none by itself.

    daily_at: the hour and minute of each day, UTC.  keep: so many back-ups stay, the newest.
    overdue_days: without a verified back-up for so long, one is overdue.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    directory: AbsolutePath | None = None
    daily_at: Annotated[str, Field(pattern=CLOCK_TIME)] = "02:00"
    keep: int = Field(default=14, ge=1, le=10_000)
    overdue_days: float = Field(default=2.0, ge=0.01, le=3650)
