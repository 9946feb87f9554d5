"""What people type into forms, as the documents that the API takes."""

from collections.abc import Mapping
from typing import TypeVar

from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, ValidationError

Wanted = TypeVar("Wanted", bound=BaseModel)


def document_of_form(document: type[Wanted], fields: Mapping[str, object]) -> Wanted:
    """Return what a form says as a document of the API. Fields that are empty were not filled in.

    Browsers end lines with two characters, of which one is kept. Raises RequestValidationError.
    """
    given = {name: _plain(value) for name, value in fields.items() if value is not None and value != ""}
    try:
        return document.model_validate(given)
    except ValidationError as error:
        found = [{**each, "loc": ("body", *each["loc"])} for each in error.errors()]
        raise RequestValidationError(found) from error


def _plain(value: object) -> object:
    return value.replace("\r\n", "\n") if isinstance(value, str) else value
