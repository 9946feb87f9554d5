"""Values of DOI, SDI and DAI elements over the defaults of the data types (IEC 61850-6 clause 9.3.6)."""

from dataclasses import replace

from lxml import etree

from scl.data_model import DataAttribute, DataObject
from scl.document import Document
from scl.templates import initial_value


def with_instance_values(
    document: Document, node: etree._Element, objects: tuple[DataObject, ...]
) -> tuple[DataObject, ...]:
    """The data objects of a logical node with its instance values; those without any stay shared."""
    instances = _instances(document, node, "DOI")
    if not instances:
        return objects
    result = _objects(document, instances, objects)
    _note_unknown(document, instances)
    return result


def _instances(document: Document, element: etree._Element, *tags: str) -> dict[str, etree._Element]:
    """Instance elements by name. Elements of an array's single members have no place in the data model."""
    instances: dict[str, etree._Element] = {}
    for child in document.children(element, *tags):
        name = document.required(child, "name")
        if child.get("ix") is not None:
            document.note(child, "values of single array elements are not read")
        elif instances.setdefault(name, child) is not child:
            document.note(child, "a second instance of this name: the first one counts")
    return instances


def _note_unknown(document: Document, instances: dict[str, etree._Element]) -> None:
    for element in instances.values():
        document.note(element, "the data type has nothing of this name: left out")


def _objects(
    document: Document, instances: dict[str, etree._Element], objects: tuple[DataObject, ...]
) -> tuple[DataObject, ...]:
    """Objects with their instances applied; what was applied is taken out of `instances`."""
    return tuple(
        _object(document, instances.pop(each.name), each) if each.name in instances else each
        for each in objects
    )


def _attributes(
    document: Document, instances: dict[str, etree._Element], attributes: tuple[DataAttribute, ...]
) -> tuple[DataAttribute, ...]:
    return tuple(
        _attribute(document, instances.pop(each.name), each) if each.name in instances else each
        for each in attributes
    )


def _object(document: Document, element: etree._Element, data_object: DataObject) -> DataObject:
    instances = _instances(document, element, "SDI", "DAI")
    if not instances:
        return data_object
    result = replace(
        data_object,
        objects=_objects(document, instances, data_object.objects),
        attributes=_attributes(document, instances, data_object.attributes),
    )
    _note_unknown(document, instances)
    return result


def _attribute(document: Document, element: etree._Element, attribute: DataAttribute) -> DataAttribute:
    instances = _instances(document, element, "SDI", "DAI")
    value = initial_value(document, element)
    result = replace(
        attribute,
        value=attribute.value if value is None else value,
        attributes=_attributes(document, instances, attribute.attributes),
    )
    _note_unknown(document, instances)
    return result
