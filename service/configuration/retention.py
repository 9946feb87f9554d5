"""How long recordings and what belongs to them are kept: the table [retention] of the settings."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from core.operation import Operation

MOST_DAYS = 36_500
"""A hundred years: in nanoseconds this fits into the integers of the database."""

Days = Annotated[float, Field(ge=1, le=MOST_DAYS)] | None
"""So long something is kept; None for ever."""


class RetentionSettings(BaseModel):
    """What is deleted when it is older than so many days; by default nothing.

    The age of a recording counts from when the service first saw it: a relay's clock may be wrong. What the
    settings `keep_...` say stays, whatever its age.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    keep_newest: int = Field(default=100, ge=1, le=1_000_000)
    keep_starts: int = Field(default=10, ge=1, le=1_000)
    keep_first_days: Days = None
    keep_changes: bool = False
    keep_operations: tuple[Operation, ...] = ()
    keep_one_in_days: Days = None
    healthy_days: Days = None
    watch_days: Days = None
    fault_days: Days = None
    undiagnosable_days: Days = None
    not_running_days: Days = None
    rejected_days: Days = None
    failed_days: Days = None
    superseded_diagnoses_days: Days = None
    failed_jobs_days: Days = None
    event_reports_days: Days = None
    deletions_days: Days = None
