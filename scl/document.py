"""One XML file of the Substation Configuration Language: safe parsing, and places in it for messages.

The file is hostile until proven otherwise: no document type, no entities, no network, bounded size and depth.
"""

import re
from collections import defaultdict
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

from lxml import etree

from scl.errors import Finding, SclError

NAMESPACE = "http://www.iec.ch/61850/2003/SCL"
LARGEST_FILE_BYTES = 256 * 1024 * 1024
NAME = re.compile(r"[A-Za-z0-9_-]{1,64}")
IED_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
IDENTITY = ("name", "id", "inst", "iedName", "apName", "prefix", "lnClass", "lnType", "type", "doName")
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
EXCERPT = 60
MOST_FINDINGS = 1000


def parse(path: Path, *, largest_bytes: int = LARGEST_FILE_BYTES) -> etree._ElementTree:
    """The XML tree of a file, without comments; SclError when it is no well-formed and safe XML."""
    try:
        with path.open("rb") as file:
            data = file.read(largest_bytes + 1)
    except OSError as error:
        raise SclError(path, expected="a readable file", found=error.strerror or str(error)) from error
    except ValueError as error:  # a NUL in the path
        raise SclError(path, expected="a file name", found=str(error)) from error
    if len(data) > largest_bytes:
        raise SclError(path, expected=f"at most {largest_bytes} bytes", found="a larger file")
    parser = etree.XMLParser(
        resolve_entities=False,
        load_dtd=False,
        no_network=True,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        root = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise SclError(path, line=error.lineno, expected="well-formed XML", found=str(error.msg)) from error
    tree = root.getroottree()
    if tree.docinfo.doctype:
        raise SclError(
            path, expected="no document type declaration (it can define entities)", found=tree.docinfo.doctype
        )
    return tree


def excerpt(element: etree._Element) -> str:
    """The start tag for a message: its name and the attributes that identify it, shortened."""
    name = etree.QName(element).localname
    identity = [f'{key}="{element.get(key)}"' for key in IDENTITY if element.get(key) is not None]
    text = " ".join([name, *identity])
    return f"<{text if len(text) <= EXCERPT else text[:EXCERPT] + '...'}>"


class Document:
    """An SCL file being read: typed access to elements and attributes, and the findings collected so far."""

    def __init__(self, path: Path, *, largest_bytes: int = LARGEST_FILE_BYTES) -> None:
        self.path = path
        self.findings: list[Finding] = []
        self.root = parse(path, largest_bytes=largest_bytes).getroot()
        name = etree.QName(self.root)
        self._prefix = f"{{{NAMESPACE}}}" if name.namespace else ""
        self._names: dict[tuple[str, ...], tuple[str, ...]] = {}
        self._names_seen: set[str] = set()  # found to be names
        if name.localname != "SCL" or name.namespace not in (NAMESPACE, None):
            raise self.error(self.root, f"a root element SCL of {NAMESPACE}", str(self.root.tag))
        if not name.namespace:
            self.note(self.root, f"no namespace: read as {NAMESPACE}")

    def error(self, element: etree._Element, expected: str, found: str) -> SclError:
        return SclError(
            self.path,
            line=_line(element),
            element=excerpt(element),
            expected=expected,
            found=found if len(found) <= 2 * EXCERPT else found[: 2 * EXCERPT] + "...",
        )

    def note(self, element: etree._Element, message: str) -> None:
        """Add a finding; of very many only the first are kept, and the last of those says so."""
        if len(self.findings) < MOST_FINDINGS:
            self.findings.append(Finding(_line(element), excerpt(element), message))
        elif len(self.findings) == MOST_FINDINGS:
            self.findings.append(Finding(_line(element), excerpt(element), "more is odd: not listed"))

    def is_own(self, element: etree._Element) -> bool:
        """Whether an element is of the SCL namespace, not a vendor's."""
        tag = str(element.tag)
        return tag.startswith(self._prefix) if self._prefix else not tag.startswith("{")

    def qualified(self, tag: str) -> str:
        """A tag as the parser gives it in this document, with its namespace."""
        return self._prefix + tag

    def children(self, element: etree._Element | None, *tags: str) -> Iterator[etree._Element]:
        """Children of the SCL namespace with one of the tags, in file order."""
        if element is None:
            return iter(())
        names = self._names.get(tags)
        if names is None:
            names = self._names[tags] = tuple(map(self.qualified, tags))
        return element.iterchildren(*names)

    def grouped(self, element: etree._Element) -> defaultdict[str, list[etree._Element]]:
        """Children of the SCL namespace by tag, in file order."""
        groups: defaultdict[str, list[etree._Element]] = defaultdict(list)
        for child in element:
            if self.is_own(child):
                groups[str(child.tag)[len(self._prefix) :]].append(child)
        return groups

    def descendants(self, element: etree._Element, tag: str) -> Iterator[etree._Element]:
        """Elements of a tag at any depth, in file order, but for those inside a Private element."""
        pending = [element]
        while pending:
            current = pending.pop()
            if current is not element and current.tag == self._prefix + tag:
                yield current
            if current.tag != f"{self._prefix}Private":
                pending.extend(current.iterchildren(etree.Element, reversed=True))

    def child(self, element: etree._Element | None, tag: str) -> etree._Element | None:
        return next(self.children(element, tag), None)

    def add(self, parent: etree._Element, tag: str, **attributes: str) -> etree._Element:
        """Append a child of the SCL namespace."""
        return etree.SubElement(parent, self._prefix + tag, attributes)

    def required(self, element: etree._Element, attribute: str) -> str:
        value = element.get(attribute)
        if value is None:
            raise self.error(element, f"an attribute {attribute}", "none")
        return value

    def name(self, element: etree._Element, attribute: str, *, default: str | None = None) -> str:
        """An attribute that becomes part of a reference: letters, digits, _ and - only."""
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
        """A name as `name` gives it; None, with a finding, where there is none a client could use."""
        value = element.get(attribute, "").strip()
        if NAME.fullmatch(value):
            return value
        self.note(element, f"{attribute}={value[:EXCERPT]!r} is no name of letters, digits and _: left out")
        return None

    def integer(
        self, element: etree._Element, attribute: str, default: int, *, maximum: int = 2**32 - 1
    ) -> int:
        """A number from 0 to maximum; the default, with a finding, where it cannot be one."""
        text = element.get(attribute)
        number = default if text is None else decimal(text)
        if number is None or not 0 <= number <= maximum:
            self.note(element, f"{attribute}={text!r} is no number from 0 to {maximum}: taken as {default}")
            return default
        return number

    def boolean(self, element: etree._Element | None, attribute: str, *, default: bool = False) -> bool:
        text = None if element is None else element.get(attribute)
        if element is None or text is None:
            return default
        value = _BOOLEANS.get(text)
        if value is None:
            value = _BOOLEANS.get(text.strip().lower())
        if value is None:
            self.note(
                element, f"{attribute}={text!r} is neither true nor false: taken as {str(default).lower()}"
            )
            return default
        return value


def node_name(document: Document, element: etree._Element, inst: str) -> tuple[str, str, str]:
    """Prefix, class and instance number of an LN, LN0, LNode or FCDA; `inst` is the number's attribute."""
    is_node_zero = etree.QName(element).localname == "LN0"
    return (
        document.name(element, "prefix", default=""),
        document.name(element, "lnClass", default="LLN0" if is_node_zero else None),
        document.name(element, inst, default=""),
    )


@lru_cache(maxsize=8192)
def decimal(text: str) -> int | None:
    """A decimal number of at most 19 digits; None for anything else."""
    stripped = text.strip()
    return int(stripped) if re.fullmatch(r"[0-9]{1,19}", stripped) else None


def content(element: etree._Element) -> str:
    """Text of an element, without surrounding blanks."""
    return (element.text or "").strip()


def _line(element: etree._Element) -> int:
    return element.sourceline or 0
