"""What raises alarms, and from when on: the table [alarms] of the settings."""

from typing import Self

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from service.alarms.condition_rules import ConditionRules
from service.alarms.confirmation import Confirmation

MOST_RECORDS = 100


class AlarmSettings(BaseModel):
    """From when on alarms are raised, and when they are over. Times are in seconds or days, as the names say.

    watch_records of the latest watch_of_records have to be `watch` or worse, fault_records of
    fault_of_records `fault`; healthy_records in a row end an alarm.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    watch_records: int = Field(default=2, ge=1, le=MOST_RECORDS)
    watch_of_records: int = Field(default=3, ge=1, le=MOST_RECORDS)
    fault_records: int = Field(default=1, ge=1, le=MOST_RECORDS)
    fault_of_records: int = Field(default=1, ge=1, le=MOST_RECORDS)
    healthy_records: int = Field(default=2, ge=1, le=MOST_RECORDS)
    growth_share: float = Field(default=0.1, ge=0, le=10)
    forecast_days: float = Field(default=30.0, ge=0, le=3650)
    link_down_s: float = Field(default=600.0, ge=0, le=604_800)
    link_up_s: float = Field(default=60.0, ge=0, le=86_400)
    site_lost_s: float = Field(default=30.0, ge=0, le=86_400)
    site_lost_share: float = Field(default=0.8, ge=0.1, le=1)
    site_lost_relays: int = Field(default=3, ge=2, le=10_000)
    flood_alarms: int = Field(default=10, ge=2, le=10_000)
    clock_off_s: float = Field(default=5.0, ge=0.001, le=86_400)
    disk_free_share: float = Field(default=0.1, ge=0, le=0.9)
    disk_full_days: float = Field(default=7.0, ge=0, le=3650)
    certificate_days: float = Field(default=30.0, ge=0, le=3650)

    @model_validator(mode="after")
    def _agree(self) -> Self:
        """Refuse figures that contradict each other."""
        for name in ("watch", "fault"):
            needed, of = getattr(self, f"{name}_records"), getattr(self, f"{name}_of_records")
            if needed > of:
                raise _contradiction(f"{name}_records of at most {of} ({name}_of_records)")
            least = Confirmation.least_good(needed, of)
            if self.healthy_records < least:
                raise _contradiction(
                    f"healthy_records of at least {least}, so that {needed} of {of} records do not raise an "
                    "alarm again that is just over"
                )
        return self

    @property
    def condition_rules(self) -> ConditionRules:
        """Return when a motor's condition is told."""
        return ConditionRules(self.watch, self.fault, self.growth_share, self.forecast_days)

    @property
    def watch(self) -> Confirmation:
        """Return what confirms that a motor is to be watched."""
        return Confirmation(self.watch_records, self.watch_of_records, self.healthy_records)

    @property
    def fault(self) -> Confirmation:
        """Return what confirms a fault."""
        return Confirmation(self.fault_records, self.fault_of_records, self.healthy_records)


def _contradiction(expected: str) -> PydanticCustomError:
    return PydanticCustomError("contradiction", "{expected}", {"expected": expected})
