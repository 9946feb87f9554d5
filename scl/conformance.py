"""Departures of a document from the SCL schema: findings with lines, never a refusal."""

from collections.abc import Iterator

from lxml import etree

from scl.document import MOST_FINDINGS, Document
from scl.schema import RULES, UNDESCRIBED, VALUES, Rule

_Tag = str | bytes | bytearray | etree.QName
_Shape = tuple[_Tag, tuple[_Tag, ...]]
"""An element's tag, and the tags of its children or the names of its attributes."""


def check_conformance(document: Document) -> None:
    """Note what is missing, misplaced or unknown in the SCL namespace, and values the schema does not allow.

    Other namespaces and Private elements belong to vendors and are passed over.

    Parameters
    ----------
    document : Document
        The document; it collects the findings.
    """
    _Checker(document).check()


class _Checker:
    def __init__(self, document: Document) -> None:
        self._document = document
        self._rules = {document.qualified(tag): (tag, rule) for tag, rule in RULES.items()}
        self._undescribed = {document.qualified(tag): tag for tag in UNDESCRIBED}
        self._tags = {**{qualified: tag for qualified, (tag, _) in self._rules.items()}, **self._undescribed}
        self._sound: set[_Shape] = set()
        # By tag and names of attributes: what is wrong with them, and which have a value to check.
        self._known_attributes: dict[_Shape, tuple[tuple[str, ...], tuple[str, ...]]] = {}
        self._known_values: dict[tuple[str, str, str], str | None] = {}

    def check(self) -> None:
        pending = [self._document.root]
        while pending:
            element = pending.pop()
            tag = element.tag
            children = list(element)
            # The same few shapes come by the hundred thousand, so a sound one is checked once.
            shape = tag, tuple([child.tag for child in children])
            if shape not in self._sound:
                known = self._rules.get(str(tag))
                if known is None:
                    continue
                children = self._checked_children(element, known[1], shape)
            self._check_attributes(element)
            children.reverse()
            pending.extend(children)

    def _checked_children(self, element: etree._Element, rule: Rule, shape: _Shape) -> list[etree._Element]:
        """Check the children and return those of a known tag.

        The shape counts as sound if there was nothing to note or to leave out.
        """
        noted = len(self._document.findings)
        children = self._children(element)
        self._check_children(element, rule, children)
        if len(self._document.findings) == noted and len(children) == len(element) and noted < MOST_FINDINGS:
            self._sound.add(shape)
        return [child for child, _ in children]

    def _children(self, element: etree._Element) -> list[tuple[etree._Element, str]]:
        """Return the children of known tags with their tags.

        Unknown ones of the SCL namespace are noted and left out.
        """
        found = []
        for child in element:
            tag = self._tags.get(str(child.tag))
            if tag is not None:
                found.append((child, tag))
            elif self._document.is_own(child):
                self._document.note(child, "the SCL schema has no such element: passed over")
        return found

    def _check_children(
        self, element: etree._Element, rule: Rule, children: list[tuple[etree._Element, str]]
    ) -> None:
        place, before = 0, ""
        seen: set[str] = set()
        for child, tag in children:
            here = rule.order.get(tag)
            if here is None:
                self._document.note(child, f"stands in {_name(element)}, where the SCL schema has none")
                continue
            if here < place:
                self._document.note(child, f"stands after {before}, which it precedes in the SCL schema")
            else:
                place, before = here, tag
            if tag in rule.most and tag in seen:
                self._document.note(child, f"a second {tag} in {_name(element)}: the SCL schema has one")
            seen.add(tag)
        self._note_missing(element, (tag for tag in rule.least if tag not in seen))

    def _note_missing(self, element: etree._Element, tags: Iterator[str] | tuple[str, ...]) -> None:
        for tag in tags:
            self._document.note(element, f"no {tag}, which the SCL schema requires")

    def _check_attributes(self, element: etree._Element) -> None:
        qualified, names = element.tag, tuple(element.keys())
        known = self._known_attributes.get((qualified, names))
        if known is None:
            tag, rule = self._rules[str(qualified)]
            valued = tuple(name for name in names if (tag, name) in VALUES)
            known = tuple(_attribute_faults(rule, names)), valued
            self._known_attributes[qualified, names] = known
        for fault in known[0]:
            self._document.note(element, fault)
        for name in known[1]:
            wrong = self._value_fault(self._rules[str(qualified)][0], name, str(element.get(name)))
            if wrong is not None:
                self._document.note(element, wrong)

    def _value_fault(self, tag: str, name: str, value: str) -> str | None:
        key = tag, name, value
        if key not in self._known_values:
            rule = VALUES[tag, name]
            right = rule.pattern.fullmatch(value.strip())
            self._known_values[key] = None if right else f"{name}={value[:60]!r} is not {rule.expected}"
        return self._known_values[key]


def _attribute_faults(rule: Rule, names: tuple[str, ...]) -> Iterator[str]:
    for name in rule.required:
        if name not in names:
            yield f"no {name}, which the SCL schema requires"
    for name in names:
        if name not in rule.attributes and not name.startswith("{") and ":" not in name:
            yield f"the SCL schema has no attribute {name} here: passed over"


def _name(element: etree._Element) -> str:
    return etree.QName(element).localname
