"""What the documents of the API have in common. Fields that are null are not known (yet)."""

from typing import Annotated, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    StringConstraints,
    model_validator,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from core.units import NANOSECONDS_PER_SECOND

Name = Annotated[str, StringConstraints(min_length=1, max_length=200, pattern=r"^[^\x00/]+$")]
"""This is the name of a site, IED or motor in a path."""


def _seconds(value: object) -> object:
    return value / NANOSECONDS_PER_SECOND if isinstance(value, int) else value


Seconds = Annotated[float, BeforeValidator(_seconds)]
"""Seconds are made from an integer of nanoseconds."""


LONGEST_LIST = 1000
"""No list of an answer is longer; those that could be are cut off there, or come in pages."""


def _begin(found: object) -> object:
    if isinstance(found, set | frozenset):
        found = sorted(found, key=str)  # a set has another order in each process
    return found[:LONGEST_LIST] if isinstance(found, list | tuple) else found


Item = TypeVar("Item")
Listed = Annotated[list[Item], BeforeValidator(_begin), Field(max_length=LONGEST_LIST)]
"""This is a list in an answer; what is a set inside comes sorted."""


class _BoundedLists:
    """Says in the document of a core's dataclass that no list of it is longer."""

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        document = handler(schema)
        for field in handler.resolve_ref_schema(document)["properties"].values():
            for one in (field, *field.get("anyOf", ())):
                if one.get("type") == "array":
                    one.setdefault("maxItems", LONGEST_LIST)
        return document


def _begin_each(found: object) -> object:
    return {name: _begin(value) for name, value in found.items()} if isinstance(found, dict) else found


Found = Annotated[Item, BeforeValidator(_begin_each), _BoundedLists()]
"""This is a dataclass of the core in an answer, as it was found and stored."""


class Document(BaseModel):
    model_config = ConfigDict(from_attributes=True, validate_by_name=True)


Reason = Annotated[
    str, StringConstraints(min_length=1, max_length=500, strip_whitespace=True, pattern=r"^[^\x00]+$")
]
"""These are a person's words for why something is done."""

Person = Annotated[
    str,
    StringConstraints(min_length=1, max_length=100, strip_whitespace=True, pattern=r"^[^\x00-\x1f\x7f]+$"),
]
"""This is who says it: a name, in one line."""

MOST_FIELDS = 20


class RequestDocument(BaseModel):
    """A document that comes from a client. One of too many fields is refused before each of them is named."""

    model_config = ConfigDict(json_schema_extra={"maxProperties": MOST_FIELDS})

    @model_validator(mode="before")
    @classmethod
    def _few_fields(cls, found: object) -> object:
        if isinstance(found, dict) and len(found) > MOST_FIELDS:
            raise ValueError(f"expected at most {MOST_FIELDS} fields, found {len(found)}")
        return found


class RequestForSomebody(RequestDocument):
    """A document in which who asks may name another person.

    on_behalf_of: whom they ask for. It is shown beside the account that asks, never in its place.
    """

    on_behalf_of: Person | None = None

    @model_validator(mode="before")
    @classmethod
    def _no_author(cls, found: object) -> object:
        if isinstance(found, dict) and "by" in found:
            raise ValueError("expected on_behalf_of for a name, found by, which is the account that asks")
        return found
