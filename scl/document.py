"""One SCL file being read: access to its elements and attributes, and findings with their lines."""

import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

from lxml import etree

from scl.attribute_values import boolean, decimal
from scl.errors import Finding, SclError
from scl.xml_file import EXCERPT, LARGEST_FILE_BYTES, excerpt, parse

NAMESPACE = "http://www.iec.ch/61850/2003/SCL"
NAMESPACES = re.compile(r"https?://www\.iec\.ch/61850/[0-9]{4}/SCL[/#]?", re.IGNORECASE)
"""Spellings of the namespace that tools write, of other years (2006, 2007) for one."""

NAME = re.compile(r"[A-Za-z0-9_-]{1,64}")
IED_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
MOST_FINDINGS = 1000


class Document:
    """An SCL file being read: typed access to elements and attributes, and the findings collected so far.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    largest_bytes : int
        Size above which the file is refused [byte].

    Raises
    ------
    SclError
        The file is no safe XML, or its root element is no SCL.
    """

    def __init__(self, path: Path, *, largest_bytes: int = LARGEST_FILE_BYTES) -> None:
        self.path = path
        self.findings: list[Finding] = []
        self.omissions: list[Finding] = []
        parsed = parse(path, largest_bytes=largest_bytes)
        self.root = parsed.tree.getroot()
        name = etree.QName(self.root)
        self._prefix = f"{{{name.namespace}}}" if name.namespace else ""
        self._names: dict[tuple[str, ...], tuple[str, ...]] = {}
        self._names_seen: set[str] = set()  # values already checked
        if name.localname != "SCL" or not NAMESPACES.fullmatch(name.namespace or NAMESPACE):
            raise self.error(self.root, f"a root element SCL of {NAMESPACE}", str(self.root.tag))
        if name.namespace != NAMESPACE:
            self.note(self.root, f"{name.namespace or 'no'} namespace: read as {NAMESPACE}")
        for remark in parsed.remarks:
            self.note(self.root, remark)
        if parsed.first_undeclared_prefix is not None:
            self.note(self.root, f"{parsed.first_undeclared_prefix}: such names are passed over")

    def error(
        self, element: etree._Element, expected: str, found: str, kind: type[SclError] = SclError
    ) -> SclError:
        """Make an error that names the file, the line and the element.

        Parameters
        ----------
        element : lxml.etree._Element
            The element at fault.
        expected : str
            What should be there.
        found : str
            What is there.
        kind : type of SclError
            Class of the error.

        Returns
        -------
        SclError
            The error.
        """
        return kind(
            self.path,
            line=_line(element),
            element=excerpt(element),
            expected=expected,
            found=found if len(found) <= 2 * EXCERPT else found[: 2 * EXCERPT] + "...",
        )

    def note(self, element: etree._Element, message: str) -> None:
        """Add a finding. Of very many only the first are kept, and the last of those says so.

        Parameters
        ----------
        element : lxml.etree._Element
            The odd element.
        message : str
            What is odd.
        """
        self._add(self.findings, element, message, left_out=False)

    def leave_out(self, element: etree._Element, reason: str | SclError, what: str = "left out") -> None:
        """Add a finding that an element, or what belongs to it, is left out of what is read.

        Parameters
        ----------
        element : lxml.etree._Element
            The element.
        reason : str or SclError
            Why, in words, or the error that says what was expected and found, and where.
        what : str
            What is left out, in words.
        """
        if isinstance(reason, SclError):
            elsewhere = reason.element and reason.element != excerpt(element)
            where = f" at line {reason.line}, {reason.element}" if elsewhere else ""
            reason = f"expected {reason.expected}, found {reason.found}{where}"
        self._add(self.omissions, element, f"{what}: {reason}", left_out=True)

    def _add(self, findings: list[Finding], element: etree._Element, message: str, *, left_out: bool) -> None:
        if len(findings) == MOST_FINDINGS:
            message = "more is left out: not listed" if left_out else "more is odd: not listed"
        if len(findings) <= MOST_FINDINGS:
            findings.append(Finding(_line(element), excerpt(element), message, left_out))

    def is_own(self, element: etree._Element) -> bool:
        """Tell whether an element is of the SCL namespace, not a vendor's.

        Parameters
        ----------
        element : lxml.etree._Element
            The element.

        Returns
        -------
        bool
            True if it is.
        """
        tag = str(element.tag)
        return tag.startswith(self._prefix) if self._prefix else not tag.startswith("{")

    def qualified(self, tag: str) -> str:
        """Qualify a tag with the namespace, as the parser gives it in this document.

        Parameters
        ----------
        tag : str
            Tag without namespace.

        Returns
        -------
        str
            The qualified tag.
        """
        return self._prefix + tag

    def children(self, element: etree._Element | None, *tags: str) -> Iterator[etree._Element]:
        """Iterate over the children with one of the tags, in file order.

        Parameters
        ----------
        element : lxml.etree._Element or None
            The parent; None has no children.
        *tags : str
            Tags of the SCL namespace.

        Returns
        -------
        iterator of lxml.etree._Element
            The children.
        """
        if element is None:
            return iter(())
        names = self._names.get(tags)
        if names is None:
            names = self._names[tags] = tuple(map(self.qualified, tags))
        return element.iterchildren(*names)

    def grouped(self, element: etree._Element) -> defaultdict[str, list[etree._Element]]:
        """Group the children of the SCL namespace by tag, in file order.

        Parameters
        ----------
        element : lxml.etree._Element
            The parent.

        Returns
        -------
        defaultdict of str to list of lxml.etree._Element
            The children by tag.
        """
        groups: defaultdict[str, list[etree._Element]] = defaultdict(list)
        for child in element:
            if self.is_own(child):
                groups[str(child.tag)[len(self._prefix) :]].append(child)
        return groups

    def descendants(self, element: etree._Element, tag: str) -> Iterator[etree._Element]:
        """Iterate over elements of a tag at any depth, in file order, except those inside a Private element.

        Parameters
        ----------
        element : lxml.etree._Element
            The element below which to search.
        tag : str
            Tag of the SCL namespace.

        Yields
        ------
        lxml.etree._Element
            The elements.
        """
        pending = [element]
        while pending:
            current = pending.pop()
            if current is not element and current.tag == self._prefix + tag:
                yield current
            if current.tag != f"{self._prefix}Private":
                pending.extend(current.iterchildren(etree.Element, reversed=True))

    def child(self, element: etree._Element | None, tag: str) -> etree._Element | None:
        """Find the first child with a tag.

        Parameters
        ----------
        element : lxml.etree._Element or None
            The parent; None has no children.
        tag : str
            Tag of the SCL namespace.

        Returns
        -------
        lxml.etree._Element or None
            The child; None where there is none.
        """
        return next(self.children(element, tag), None)

    def add(self, parent: etree._Element, tag: str, **attributes: str) -> etree._Element:
        """Append a child of the SCL namespace.

        Parameters
        ----------
        parent : lxml.etree._Element
            The parent.
        tag : str
            Tag of the child.
        **attributes : str
            Its attributes.

        Returns
        -------
        lxml.etree._Element
            The child.
        """
        return etree.SubElement(parent, self._prefix + tag, attributes)

    def required(self, element: etree._Element, attribute: str) -> str:
        """Read an attribute that must be there.

        Parameters
        ----------
        element : lxml.etree._Element
            The element.
        attribute : str
            Name of the attribute.

        Returns
        -------
        str
            Its value.

        Raises
        ------
        SclError
            The attribute is missing.
        """
        value = element.get(attribute)
        if value is None:
            raise self.error(element, f"an attribute {attribute}", "none")
        return value

    def name(self, element: etree._Element, attribute: str, *, default: str | None = None) -> str:
        """Read an attribute that becomes part of a reference: letters, digits, _ and - only.

        Parameters
        ----------
        element : lxml.etree._Element
            The element.
        attribute : str
            Name of the attribute.
        default : str, optional
            Value where the attribute is missing. Without it a missing attribute is an error.

        Returns
        -------
        str
            The name.

        Raises
        ------
        SclError
            The attribute is missing or is no such name.
        """
        value = element.get(attribute, default)
        if value is None:
            raise self.error(element, f"an attribute {attribute}", "none")
        if value in self._names_seen:
            return value
        if value != value.strip():
            self.note(element, f"blanks around {attribute}={value!r} are passed over")
            value = value.strip()
        if value != default and not NAME.fullmatch(value):
            raise self.error(
                element, f"{attribute} of 1 to 64 letters, digits, underscores and hyphens", repr(value)
            )
        if value:
            self._names_seen.add(value)
        return value

    def usable_name(self, element: etree._Element, attribute: str) -> str | None:
        """Read a name as `name` does, with a finding in place of an error.

        Parameters
        ----------
        element : lxml.etree._Element
            The element.
        attribute : str
            Name of the attribute.

        Returns
        -------
        str or None
            The name; None where there is none that a client could use.
        """
        value = element.get(attribute, "").strip()
        if NAME.fullmatch(value):
            return value
        self.leave_out(element, f"{attribute}={value[:EXCERPT]!r} is no name of letters, digits and _")
        return None

    def integer(
        self, element: etree._Element, attribute: str, default: int, *, maximum: int = 2**32 - 1
    ) -> int:
        """Read a number, with a finding where it cannot be one.

        Parameters
        ----------
        element : lxml.etree._Element
            The element.
        attribute : str
            Name of the attribute.
        default : int
            Value where the attribute is missing or no number.
        maximum : int
            Highest number allowed; the lowest is 0.

        Returns
        -------
        int
            The number.
        """
        text = element.get(attribute)
        number = default if text is None else decimal(text)
        if number is None or not 0 <= number <= maximum:
            self.note(element, f"{attribute}={text!r} is no number from 0 to {maximum}: taken as {default}")
            return default
        return number

    def boolean(self, element: etree._Element | None, attribute: str, *, default: bool = False) -> bool:
        """Read a boolean, with a finding where it cannot be one.

        Parameters
        ----------
        element : lxml.etree._Element or None
            The element; None has no attributes.
        attribute : str
            Name of the attribute.
        default : bool
            Value where the attribute is missing or no boolean.

        Returns
        -------
        bool
            The value.
        """
        text = None if element is None else element.get(attribute)
        if element is None or text is None:
            return default
        value = boolean(text)
        if value is None:
            self.note(
                element, f"{attribute}={text!r} is neither true nor false: taken as {str(default).lower()}"
            )
            return default
        return value


def _line(element: etree._Element) -> int:
    return element.sourceline or 0
