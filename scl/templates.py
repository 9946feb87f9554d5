"""Data type templates (IEC 61850-6 clause 9.5), resolved: types become trees of data objects and attributes.

A type is resolved once and its tree is shared by all that use it. So a large substation costs little memory,
and types that multiply (a type of ten members of a type of ten members ...) cannot fill it.

What is wrong costs the smallest part that it spoils: a member whose type is missing, or a data object whose
types have no end, is left out with a finding.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from lxml import etree

from scl.attribute_values import decimal
from scl.data_model import DataAttribute, DataObject, Enumeration, FunctionalConstraint, TriggerOptions
from scl.document import Document
from scl.errors import SclError
from scl.trigger_options import trigger_options
from scl.type_extents import DEEPEST_NESTING, Extent, UnboundedTypeError, check_extent
from scl.xml_file import content

MOST_MEMBERS = 2_000
"""Of one type, as the file writes them."""
MOST_ELEMENTS = 10_000
"""Of an array."""
MOST_COPIES = 1_000_000
BASIC_TYPES = frozenset(
    (
        *("BOOLEAN", "INT8", "INT16", "INT24", "INT32", "INT64", "INT128", "INT8U", "INT16U", "INT24U"),
        *("INT32U", "FLOAT32", "FLOAT64", "Enum", "Dbpos", "Tcmd", "Quality", "Timestamp", "Struct"),
        *("VisString32", "VisString64", "VisString65", "VisString129", "VisString255", "Unicode255"),
        *("Octet6", "Octet16", "Octet64", "EntryTime", "EntryID", "Check", "ObjRef", "Currency"),
        *("PhyComAddr", "TrgOps", "OptFlds", "SvOptFlds", "LogOptFlds"),
    )
)


@dataclass(frozen=True, slots=True)
class _Resolved:
    """A type's members, and how many, how deep and how long they are when written out."""

    common_data_class: str
    objects: tuple[DataObject, ...]
    attributes: tuple[DataAttribute, ...]
    extent: Extent


@dataclass(frozen=True, slots=True)
class NodeType:
    """A resolved LNodeType.

    Parameters
    ----------
    data_objects : tuple of DataObject
        Its data objects.
    extents : tuple of tuple of int and int
        For each of them the characters of the longest path below the node, as in references and as in lists
        of MMS names.
    attributes : int
        Number of their attributes, those of every array element counted.
    characters : int
        The longest of all paths.
    """

    data_objects: tuple[DataObject, ...] = ()
    extents: tuple[tuple[int, int], ...] = ()
    attributes: int = 0
    characters: int = 0


class Templates:
    """The DataTypeTemplates of one document; types are resolved when an IED first uses them.

    Parameters
    ----------
    document : Document
        The document.
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        self._elements: dict[tuple[str, str], etree._Element] = {}
        self._resolved: dict[tuple[str, str], _Resolved] = {}
        self._node_types: dict[str, list[etree._Element]] = {}
        self._unbounded: dict[tuple[str, str], UnboundedTypeError] = {}
        self._nodes: dict[etree._Element, NodeType] = {}
        self._inherited: dict[
            tuple[str, FunctionalConstraint, TriggerOptions], tuple[DataAttribute, ...]
        ] = {}
        self._copies = 0
        self._enumerations: dict[str, Enumeration] = {}
        for section in document.children(document.root, "DataTypeTemplates"):
            for element in document.children(section, "LNodeType"):
                of_this_id = self._node_types.setdefault(element.get("id", ""), [])
                if any(
                    all(element.get(of) == each.get(of) for of in ("lnClass", "iedType"))
                    for each in of_this_id
                ):
                    document.note(element, "a second type of this id: the first one counts")
                of_this_id.append(element)
            for element in document.children(section, "DOType", "DAType", "EnumType"):
                key = etree.QName(element).localname, element.get("id", "")
                if key in self._elements:
                    document.note(element, "a second type of this id: the first one counts")
                else:
                    self._elements[key] = element

    def node_type(self, node: etree._Element, ln_class: str, ied_type: str) -> NodeType:
        """Resolve the data objects of a logical node as its LNodeType defines them.

        Parameters
        ----------
        node : lxml.etree._Element
            The LN or LN0 element.
        ln_class : str
            Class of the node.
        ied_type : str
            Type of the IED.

        Returns
        -------
        NodeType
            The data objects and their extent.

        Raises
        ------
        SclError
            The node names no LNodeType of the document.
        """
        definition = self._definition(node, ln_class, ied_type)
        if definition not in self._nodes:
            self._nodes[definition] = self._node(definition)
        return self._nodes[definition]

    def _node(self, definition: etree._Element) -> NodeType:
        objects: list[DataObject] = []
        extents: list[Extent] = []
        for name, member in self._named(definition, "DO"):
            try:
                part = self._resolve("DOType", member, ())
                extent = Extent().plus(name, 0, part.extent)
                check_extent(self._document, member, extent)
            except SclError as error:
                self._document.leave_out(member, error)
                continue
            extents.append(extent)
            objects.append(self._data_object(name, 0, member, part))
        return NodeType(
            data_objects=tuple(objects),
            extents=tuple((extent.characters, extent.listed) for extent in extents),
            attributes=sum(extent.attributes for extent in extents),
            characters=max((extent.characters for extent in extents), default=0),
        )

    def _definition(self, node: etree._Element, ln_class: str, ied_type: str) -> etree._Element:
        """Return the LNodeType that a node names. Types of several classes and IED types may share an id."""
        type_id = self._document.required(node, "lnType")
        found = self._node_types.get(type_id)
        if not found:
            raise self._document.error(node, f'a LNodeType with id="{type_id}" in DataTypeTemplates', "none")
        if len(found) == 1:
            return found[0]
        return max(
            found,
            key=lambda each: (each.get("lnClass") == ln_class, each.get("iedType", "") in ("", ied_type)),
        )

    def _find(self, kind: str, type_id: str, user: etree._Element) -> etree._Element:
        element = self._elements.get((kind, type_id))
        if element is None:
            raise self._document.error(user, f'a {kind} with id="{type_id}" in DataTypeTemplates', "none")
        return element

    def _named(self, element: etree._Element, *tags: str) -> Iterator[tuple[str, etree._Element]]:
        """Iterate over members of a type with their names; a name that comes twice counts once."""
        seen: set[str] = set()
        for member in self._document.children(element, *tags):
            try:
                name = self._document.name(member, "name")
            except SclError as error:
                self._document.leave_out(member, error)
                continue
            if name in seen:
                self._document.leave_out(member, "a second member of this name, the first one counts")
                continue
            seen.add(name)
            yield name, member

    def _resolve(self, kind: str, user: etree._Element, path: tuple[tuple[str, str], ...]) -> _Resolved:
        """Resolve the type that a member names.

        `path` holds the types being resolved around it, so that a type inside itself is found.
        """
        key = kind, self._document.required(user, "type")
        if key in path:
            circle = " > ".join(" ".join(each) for each in (*path, key))
            raise self._document.error(
                user, "types that do not contain themselves", circle, UnboundedTypeError
            )
        if len(path) > DEEPEST_NESTING:
            expected = f"types nested at most {DEEPEST_NESTING} deep"
            raise self._document.error(user, expected, "deeper ones", UnboundedTypeError)
        if key in self._unbounded:
            raise self._unbounded[key]
        if key not in self._resolved:
            definition = self._find(*key, user)
            try:
                self._resolved[key] = self._members(definition, (*path, key))
            except UnboundedTypeError as error:
                self._unbounded[key] = error
                raise
        resolved = self._resolved[key]
        if not resolved.objects and not resolved.attributes:
            raise self._document.error(user, f"{kind} {key[1]!r} with members", "none that can be used")
        return resolved

    def _members(self, definition: etree._Element, path: tuple[tuple[str, str], ...]) -> _Resolved:
        """Resolve the members of a DOType or DAType; one whose type cannot be used is left out.

        Components (BDA) get their constraint where the struct is used.
        """
        objects: list[DataObject] = []
        attributes: list[DataAttribute] = []
        extent = Extent()
        for number, (name, member) in enumerate(self._named(definition, "SDO", "DA", "BDA"), 1):
            if number > MOST_MEMBERS:
                expected = f"at most {MOST_MEMBERS} members of a type"
                raise self._document.error(definition, expected, "more", UnboundedTypeError)
            try:
                part = self._member(name, member, path)
            except UnboundedTypeError:
                raise
            except SclError as error:
                self._document.leave_out(member, error)
                continue
            made, size = part
            extent = extent.plus(name, made.count, size)
            check_extent(self._document, definition, extent)
            if isinstance(made, DataObject):
                objects.append(made)
            else:
                attributes.append(made)
        return _Resolved(definition.get("cdc", ""), tuple(objects), tuple(attributes), extent)

    def _member(
        self, name: str, member: etree._Element, path: tuple[tuple[str, str], ...]
    ) -> tuple[DataObject | DataAttribute, Extent | None]:
        """Return a member of a type, and the extent of its own type."""
        tag, count = etree.QName(member).localname, self._count(member)
        if tag == "SDO":
            part = self._resolve("DOType", member, path)
            return self._data_object(name, count, member, part), part.extent
        struct = self._resolve("DAType", member, path) if member.get("bType") == "Struct" else None
        constraint = self._constraint(member) if tag == "DA" else FunctionalConstraint.ST
        attribute = self._attribute(name, count, member, constraint, struct)
        return attribute, None if struct is None else struct.extent

    def _data_object(self, name: str, count: int, element: etree._Element, resolved: _Resolved) -> DataObject:
        return DataObject(
            name=name,
            common_data_class=resolved.common_data_class,
            objects=resolved.objects,
            attributes=resolved.attributes,
            count=count,
            transient=self._document.boolean(element, "transient"),
        )

    def _attribute(
        self,
        name: str,
        count: int,
        element: etree._Element,
        constraint: FunctionalConstraint,
        struct: _Resolved | None,
    ) -> DataAttribute:
        document = self._document
        basic_type = document.required(element, "bType")
        if basic_type not in BASIC_TYPES:
            raise document.error(element, "bType, a basic type of IEC 61850-6", repr(basic_type))
        triggers = trigger_options(document, element, general_interrogation=False)
        return DataAttribute(
            name=name,
            fc=constraint,
            basic_type=basic_type,
            trigger_options=triggers,
            value=initial_value(document, element),
            enumeration=self._enumeration(element) if basic_type == "Enum" else None,
            attributes=() if struct is None else self._components(element, struct, constraint, triggers),
            count=count,
        )

    def _components(
        self,
        element: etree._Element,
        struct: _Resolved,
        constraint: FunctionalConstraint,
        triggers: TriggerOptions,
    ) -> tuple[DataAttribute, ...]:
        """Return a struct's components with the constraint and triggers of the attribute that uses it."""
        struct_id = self._document.required(element, "type")
        key = struct_id, constraint, triggers
        if key not in self._inherited:
            if self._copies + struct.extent.written > MOST_COPIES:
                raise self._document.error(
                    element, f"types of at most {MOST_COPIES} attributes in all", f"more, at {struct_id!r}"
                )
            self._copies += struct.extent.written
            self._inherited[key] = tuple(_inherit(part, constraint, triggers) for part in struct.attributes)
        return self._inherited[key]

    def _constraint(self, element: etree._Element) -> FunctionalConstraint:
        text = self._document.required(element, "fc")
        try:
            return FunctionalConstraint(text)
        except ValueError:
            raise self._document.error(
                element, f"fc, one of {', '.join(FunctionalConstraint)}", repr(text)
            ) from None

    def _count(self, element: etree._Element) -> int:
        text = element.get("count")
        if text is None:
            return 0
        number = decimal(text)
        if number is None or number > MOST_ELEMENTS:
            # In edition 2 another attribute may hold the count; the model then has no fixed array.
            self._document.note(element, f"array count {text!r} is no number: taken as no array")
            return 0
        return number

    def _enumeration(self, element: etree._Element) -> Enumeration | None:
        type_id = element.get("type", "")
        if type_id not in self._enumerations:
            definition = self._elements.get(("EnumType", type_id))
            if definition is None:
                self._document.note(element, f"no EnumType {type_id!r}: its initial value must be a number")
            literals: list[tuple[int, str]] = []
            for value in self._document.children(definition, "EnumVal"):
                try:
                    literals.append((int(value.get("ord", "")), content(value)))
                except ValueError:
                    self._document.note(value, f"ord={value.get('ord')!r} is no number: literal left out")
            self._enumerations[type_id] = Enumeration(type_id, tuple(literals))
        return self._enumerations[type_id]


def initial_value(document: Document, element: etree._Element) -> str | None:
    """Read the text of Val; of values by setting group, the first group's.

    Parameters
    ----------
    document : Document
        The document.
    element : lxml.etree._Element
        The element that holds Val.

    Returns
    -------
    str or None
        The text; None without Val.
    """
    chosen: etree._Element | None = None
    for value in document.children(element, "Val"):
        if value.get("sGroup") is None:
            return content(value)
        chosen = value if chosen is None else chosen
    return None if chosen is None else content(chosen)


def _inherit(
    attribute: DataAttribute, constraint: FunctionalConstraint, triggers: TriggerOptions
) -> DataAttribute:
    return replace(
        attribute,
        fc=constraint,
        trigger_options=triggers,
        attributes=tuple(_inherit(part, constraint, triggers) for part in attribute.attributes),
    )
