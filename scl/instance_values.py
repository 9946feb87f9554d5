"""Values of DOI, SDI and DAI elements over the defaults of the data types (IEC 61850-6 clause 9.3.6)."""

from dataclasses import replace

from lxml import etree

from scl.data_model import DataAttribute, DataObject
from scl.document import Document
from scl.templates import initial_value


class InstanceValues:
    """Lays the instance values of a document over the data objects of its types.

    Relays of one make repeat the same values thousands of times: an attribute with a value is made once and
    shared by all that have it.
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        # by the identity of the type's own attribute, which the templates keep as long as they read
        self._valued: dict[tuple[int, str], DataAttribute] = {}

    def laid_over(self, node: etree._Element, objects: tuple[DataObject, ...]) -> tuple[DataObject, ...]:
        """The data objects of a logical node with its instance values; those without any stay shared."""
        instances = self._instances(node, "DOI")
        return self._objects(instances, objects, last=True) if instances else objects

    def _instances(self, element: etree._Element, *tags: str) -> dict[str, etree._Element]:
        """Instance elements by name. Elements of an array's single members have no place in the model."""
        document = self._document
        instances: dict[str, etree._Element] = {}
        for child in document.children(element, *tags):
            name = child.get("name")
            if name is None:
                document.note(child, "an instance without name: left out")
            elif child.get("ix") is not None:
                document.note(child, "values of single array elements are not read")
            elif instances.setdefault(name, child) is not child:
                document.note(child, "a second instance of this name: the first one counts")
        return instances

    def _objects(
        self, instances: dict[str, etree._Element], objects: tuple[DataObject, ...], *, last: bool
    ) -> tuple[DataObject, ...]:
        """Objects with their instances applied; what was applied is taken out of `instances`."""
        result = tuple(
            self._object(instances.pop(each.name), each) if each.name in instances else each
            for each in objects
        )
        if last:
            self._note_unknown(instances)
        return result

    def _object(self, element: etree._Element, data_object: DataObject) -> DataObject:
        instances = self._instances(element, "SDI", "DAI")
        if not instances:
            return data_object
        objects = self._objects(instances, data_object.objects, last=False)
        attributes = self._attributes(instances, data_object.attributes)
        return replace(data_object, objects=objects, attributes=attributes)

    def _attributes(
        self, instances: dict[str, etree._Element], attributes: tuple[DataAttribute, ...]
    ) -> tuple[DataAttribute, ...]:
        """Attributes with their instances applied; instances that are left over are noted."""
        result = tuple(
            self._attribute(instances.pop(each.name), each) if each.name in instances else each
            for each in attributes
        )
        self._note_unknown(instances)
        return result

    def _attribute(self, element: etree._Element, attribute: DataAttribute) -> DataAttribute:
        instances = self._instances(element, "SDI", "DAI")
        value = initial_value(self._document, element)
        valued = attribute if value is None else self._with_value(attribute, value)
        if not instances:
            return valued
        return replace(valued, attributes=self._attributes(instances, valued.attributes))

    def _with_value(self, attribute: DataAttribute, value: str) -> DataAttribute:
        key = id(attribute), value
        valued = self._valued.get(key)
        if valued is None:
            valued = self._valued[key] = replace(attribute, value=value)
        return valued

    def _note_unknown(self, instances: dict[str, etree._Element]) -> None:
        for element in instances.values():
            self._document.note(element, "the data type has nothing of this name: left out")
