"""What energy costs: the table [energy] of the settings."""

from pydantic import BaseModel, ConfigDict, Field


class EnergySettings(BaseModel):
    """price_per_kWh: None where costs are told in energy alone. currency: as people write it, such as EUR."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    price_per_kWh: float | None = Field(default=None, ge=0, le=1e6)
    currency: str = Field(default="", max_length=10, pattern=r"^[^\x00-\x1f\x7f]*$")
