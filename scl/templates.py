"""Data type templates (IEC 61850-6 clause 9.5), resolved: types become trees of data objects and attributes.

A type is resolved once and its tree is shared by all that use it. So a large substation costs little memory,
and types that multiply (a type of ten members of a type of ten members ...) cannot fill it.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from lxml import etree

from scl.data_model import DataAttribute, DataObject, Enumeration, FunctionalConstraint, TriggerOptions
from scl.document import Document, decimal
from scl.xml_file import content

DEEPEST_NESTING = 16
MOST_ATTRIBUTES = 2_000
MOST_COPIES = 1_000_000
LONGEST_PATH = 128
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
class _Extent:
    """Size of a type: its number of attributes, its levels, and the characters of its longest path."""

    attributes: int = 0
    depth: int = 1
    characters: int = 0

    def plus(self, name: str, count: int, part: "_Extent | None") -> "_Extent":
        """Return the extent with one more member: a name, its array elements, and the extent of its type."""
        elements = max(count, 1)
        if part is None:
            return replace(
                self, attributes=self.attributes + elements, characters=max(self.characters, len(name))
            )
        return _Extent(
            attributes=self.attributes + elements * (1 + part.attributes),
            depth=max(self.depth, 1 + part.depth),
            characters=max(self.characters, len(name) + 1 + part.characters),
        )


@dataclass(frozen=True, slots=True)
class _Resolved:
    """A type's members, and how many, how deep and how long they are when written out."""

    common_data_class: str
    objects: tuple[DataObject, ...]
    attributes: tuple[DataAttribute, ...]
    extent: _Extent


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
        self._nodes: dict[etree._Element, tuple[DataObject, ...]] = {}
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

    def data_objects(self, node: etree._Element, ln_class: str, ied_type: str) -> tuple[DataObject, ...]:
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
        tuple of DataObject
            The data objects.

        Raises
        ------
        SclError
            A type is missing, contains itself, or is too large.
        """
        definition = self._node_type(node, ln_class, ied_type)
        if definition not in self._nodes:
            objects: list[DataObject] = []
            for name, member in self._named(definition, "DO"):
                part = self._resolve("DOType", member, ())
                self._check(member, _Extent().plus(name, 0, part.extent))
                objects.append(self._data_object(name, 0, member, part))
            self._nodes[definition] = tuple(objects)
        return self._nodes[definition]

    def _node_type(self, node: etree._Element, ln_class: str, ied_type: str) -> etree._Element:
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
            name = self._document.name(member, "name")
            if name in seen:
                self._document.note(member, "a second member of this name: the first one counts")
                continue
            seen.add(name)
            yield name, member

    def _resolve(self, kind: str, user: etree._Element, path: tuple[str, ...]) -> _Resolved:
        """Resolve the type that a member names.

        `path` holds the types being resolved around it, so that a type inside itself is found.
        """
        type_id = self._document.required(user, "type")
        name = f"{kind} {type_id}"
        if name in path:
            raise self._document.error(
                user, "types that do not contain themselves", " > ".join([*path, name])
            )
        if len(path) > DEEPEST_NESTING:
            raise self._document.error(user, f"types nested at most {DEEPEST_NESTING} deep", "deeper ones")
        if (kind, type_id) not in self._resolved:
            definition = self._find(kind, type_id, user)
            self._resolved[kind, type_id] = self._members(definition, (*path, name))
        return self._resolved[kind, type_id]

    def _members(self, definition: etree._Element, path: tuple[str, ...]) -> _Resolved:
        """Resolve the members of a DOType or DAType.

        Components (BDA) get their constraint where the struct is used.
        """
        objects: list[DataObject] = []
        attributes: list[DataAttribute] = []
        extent = _Extent()
        for name, member in self._named(definition, "SDO", "DA", "BDA"):
            tag, count = etree.QName(member).localname, self._count(member)
            if tag == "SDO":
                part = self._resolve("DOType", member, path)
                extent = extent.plus(name, count, part.extent)
                self._check(definition, extent)
                objects.append(self._data_object(name, count, member, part))
                continue
            struct = self._resolve("DAType", member, path) if member.get("bType") == "Struct" else None
            extent = extent.plus(name, count, None if struct is None else struct.extent)
            self._check(definition, extent)
            constraint = self._constraint(member) if tag == "DA" else FunctionalConstraint.ST
            attributes.append(self._attribute(name, count, member, constraint, struct))
        return _Resolved(definition.get("cdc", ""), tuple(objects), tuple(attributes), extent)

    def _check(self, definition: etree._Element, extent: _Extent) -> None:
        if (
            extent.attributes > MOST_ATTRIBUTES
            or extent.depth > DEEPEST_NESTING
            or extent.characters > LONGEST_PATH
        ):
            raise self._document.error(
                definition,
                f"at most {MOST_ATTRIBUTES} attributes, {DEEPEST_NESTING} levels, {LONGEST_PATH} characters",
                f"{extent.attributes} attributes, {extent.depth} levels, {extent.characters} characters",
            )

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
            document.note(element, f"bType {basic_type!r} is no basic type of IEC 61850-6")
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
            self._copies += struct.extent.attributes
            if self._copies > MOST_COPIES:
                raise self._document.error(
                    element, f"types of at most {MOST_COPIES} attributes in all", f"more, at {struct_id!r}"
                )
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
        if number is None or number > MOST_ATTRIBUTES:
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


def trigger_options(
    document: Document, element: etree._Element | None, *, general_interrogation: bool
) -> TriggerOptions:
    """Read dchg, qchg, dupd, period and gi of a DA or TrgOps element.

    Parameters
    ----------
    document : Document
        The document.
    element : lxml.etree._Element or None
        The element; None has the defaults.
    general_interrogation : bool
        Whether to read gi, which is set by default in TrgOps.

    Returns
    -------
    TriggerOptions
        The options.
    """
    options = 0
    for attribute, option in (
        ("dchg", TriggerOptions.DATA_CHANGE),
        ("qchg", TriggerOptions.QUALITY_CHANGE),
        ("dupd", TriggerOptions.DATA_UPDATE),
        ("period", TriggerOptions.INTEGRITY),
    ):
        if document.boolean(element, attribute):
            options |= option.value
    if general_interrogation and document.boolean(element, "gi", default=True):
        options |= TriggerOptions.GENERAL_INTERROGATION.value
    return TriggerOptions(options)


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
