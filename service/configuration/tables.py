"""The models of the tables in the settings, found by the way of keys that leads to them."""

from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

Way = tuple[str | int, ...]


def is_table(setting: str, model: type[BaseModel]) -> bool:
    """Tell whether a setting is a table, or holds tables."""
    field = model.model_fields.get(setting)
    return field is not None and bool(_models(field.annotation))


def way_and_model(way: Way, model: type[BaseModel]) -> tuple[Way, type[BaseModel] | None]:
    """Return the way without the tags that pydantic adds to it, and the model that its last key belongs to.

    A tag tells which kind of table was chosen, such as "mail"; no key of the file is called so. The model is
    None where the last key is a name that people choose, or the number of an item in a list.
    """
    kept: list[str | int] = []
    found: Any = model
    holder: type[BaseModel] | None = None
    for part in way:
        models = _models(found)
        if len(models) > 1 and (tagged := _tagged(models, part)) is not None:
            found = tagged
            continue
        kept.append(part)
        holder, found = _step(found, part)
    return tuple(kept), holder


def _step(found: Any, part: str | int) -> tuple[type[BaseModel] | None, Any]:
    """Return the model that a key belongs to, and the type of what stands there."""
    if isinstance(found, type) and issubclass(found, BaseModel):
        field = next((one for name, one in found.model_fields.items() if part in (name, one.alias)), None)
        return found, None if field is None else _plain(field)
    arguments = get_args(found)
    if get_origin(found) is dict and len(arguments) == 2:
        return None, arguments[1]
    if get_origin(found) in (tuple, list) and arguments:
        return None, arguments[0]
    for one in arguments if get_origin(found) in (Union, UnionType, Annotated) else ():
        holder, inside = _step(one, part)
        if holder is not None or inside is not None:
            return holder, inside
    return None, None


def _plain(field: FieldInfo) -> Any:
    return field.annotation


def _models(annotation: Any) -> list[type[BaseModel]]:
    """Return the models of which a value of this type may consist."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) is Literal:
        return []
    return [model for one in get_args(annotation) for model in _models(one)]


def _tagged(models: list[type[BaseModel]], tag: str | int) -> type[BaseModel] | None:
    """Return the model that has a field whose only value is the tag."""
    for model in models:
        for field in model.model_fields.values():
            if get_origin(field.annotation) is Literal and get_args(field.annotation) == (tag,):
                return model
    return None
