"""Values of DOI, SDI and DAI elements over the defaults of the data types (IEC 61850-6 clause 9.3.6)."""

from lxml import etree

from scl.data_model import DataAttribute, DataObject
from scl.document import Document
from scl.xml_file import content


class InstanceValues:
    """Sets the instance values of a document over the data objects of its types.

    Relays of one make repeat the same values thousands of times. An attribute with a value is made once and
    shared by all that have it.

    Parameters
    ----------
    document : Document
        The document.
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        self._instance_tags = frozenset(document.qualified(tag) for tag in ("DOI", "SDI", "DAI"))
        self._value_tag = document.qualified("Val")
        # The key holds the identity of the type's attribute, which the templates keep alive while they read.
        self._valued: dict[tuple[int, str], DataAttribute] = {}

    def apply(self, node: etree._Element, objects: tuple[DataObject, ...]) -> tuple[DataObject, ...]:
        """Set the instance values of a logical node over its data objects.

        Parameters
        ----------
        node : lxml.etree._Element
            The LN or LN0 element.
        objects : tuple of DataObject
            Data objects of the node's type.

        Returns
        -------
        tuple of DataObject
            The objects with their values; those without any stay shared.
        """
        instances, _ = self._content(node)
        return self._objects(instances, objects, last=True) if instances else objects

    def _content(self, element: etree._Element) -> tuple[dict[str, etree._Element], str | None]:
        """Return the instances within an instance by name, and its value.

        Of values by setting group, the first group's counts. The children are passed once: a large substation
        has hundreds of thousands of these elements.
        """
        instances: dict[str, etree._Element] = {}
        value: etree._Element | None = None
        for child in element:
            tag = child.tag
            if tag == self._value_tag:
                if value is None or (value.get("sGroup") is not None and child.get("sGroup") is None):
                    value = child
            elif tag in self._instance_tags:
                self._add(instances, child)
        return instances, None if value is None else content(value)

    def _add(self, instances: dict[str, etree._Element], child: etree._Element) -> None:
        """Add an instance. Elements of an array's single members have no place in the data model."""
        name = child.get("name")
        if name is None:
            self._document.note(child, "an instance without name: left out")
        elif child.get("ix") is not None:
            self._document.note(child, "values of single array elements are not read")
        elif instances.setdefault(name, child) is not child:
            self._document.note(child, "a second instance of this name: the first one counts")

    def _objects(
        self, instances: dict[str, etree._Element], objects: tuple[DataObject, ...], *, last: bool
    ) -> tuple[DataObject, ...]:
        """Apply the instances to the objects; what was applied is taken out of `instances`."""
        result = tuple(
            self._object(instances.pop(each.name), each) if each.name in instances else each
            for each in objects
        )
        if last:
            self._note_unknown(instances)
        return result

    def _object(self, element: etree._Element, data_object: DataObject) -> DataObject:
        instances, _ = self._content(element)
        if not instances:
            return data_object
        objects = self._objects(instances, data_object.objects, last=False)
        attributes = self._attributes(instances, data_object.attributes)
        return DataObject(
            data_object.name,
            data_object.common_data_class,
            objects,
            attributes,
            data_object.count,
            data_object.transient,
        )

    def _attributes(
        self, instances: dict[str, etree._Element], attributes: tuple[DataAttribute, ...]
    ) -> tuple[DataAttribute, ...]:
        """Apply the instances to the attributes; instances that are left over are noted."""
        result = tuple(
            self._attribute(instances.pop(each.name), each) if each.name in instances else each
            for each in attributes
        )
        self._note_unknown(instances)
        return result

    def _attribute(self, element: etree._Element, attribute: DataAttribute) -> DataAttribute:
        instances, value = self._content(element)
        valued = attribute if value is None else self._with_value(attribute, value)
        if not instances:
            return valued
        return _changed(valued, valued.value, self._attributes(instances, valued.attributes))

    def _with_value(self, attribute: DataAttribute, value: str) -> DataAttribute:
        key = id(attribute), value
        valued = self._valued.get(key)
        if valued is None:
            valued = self._valued[key] = _changed(attribute, value, attribute.attributes)
        return valued

    def _note_unknown(self, instances: dict[str, etree._Element]) -> None:
        for element in instances.values():
            self._document.note(element, "the data type has nothing of this name: left out")


def _changed(
    attribute: DataAttribute, value: str | None, components: tuple[DataAttribute, ...]
) -> DataAttribute:
    """Copy an attribute with another value and other components.

    It does what dataclasses.replace does in a third of the time: a large file has hundreds of thousands of
    values.
    """
    return DataAttribute(
        attribute.name,
        attribute.fc,
        attribute.basic_type,
        attribute.trigger_options,
        value,
        attribute.enumeration,
        components,
        attribute.count,
    )
