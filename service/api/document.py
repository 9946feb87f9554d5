"""What the documents of the API have in common. Fields that are null are not known (yet)."""

from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, StringConstraints

Name = Annotated[str, StringConstraints(min_length=1, max_length=200, pattern=r"^[^\x00/]+$")]
"""Name of a site, IED or motor in a path."""

Seconds = Annotated[float, BeforeValidator(lambda value: value / 1e9 if isinstance(value, int) else value)]
"""Kept as nanoseconds inside."""


class Document(BaseModel):
    model_config = ConfigDict(from_attributes=True, validate_by_name=True)
