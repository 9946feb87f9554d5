"""Moments in a scenario file, in seconds or in days since its beginning."""

from typing import Self

from pydantic import model_validator

from core.units import SECONDS_PER_DAY
from ied_sim.toml_tables import Table


class MomentTable(Table):
    """A table that says when: by `at_s` or by `at_days`."""

    at_s: float | None = None
    at_days: float | None = None

    @model_validator(mode="after")
    def _is_one_moment(self) -> Self:
        if (self.at_s is None) == (self.at_days is None):
            raise ValueError("give either at_s or at_days")
        return self

    @property
    def time_s(self) -> float:
        """Time since the scenario's beginning [s]."""
        return self.at_s if self.at_s is not None else (self.at_days or 0.0) * SECONDS_PER_DAY


def require_rising(times: list[float], field: str) -> None:
    """Raise ValueError where the times do not rise."""
    if times != sorted(set(times)):
        raise ValueError(f"the times must rise from each point of {field} to the next")
