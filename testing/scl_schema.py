"""The schema of IEC 61850-6 for SCL (2007B4, edition 2.1), as RTE's scl_loader brings it."""

from importlib import resources
from pathlib import Path

from lxml import etree

EDITION_2_1 = {"version": "2007", "revision": "B", "release": "4"}


def schema_errors(file: Path) -> list[str]:
    """What of a file the schema refuses, with its lines.

    The schema takes no other edition than its own: a file of edition 2 is taken for one of edition 2.1.
    """
    path = resources.files("scl_loader") / "resources" / "SCL_Schema" / "SCL.xsd"
    schema = etree.XMLSchema(etree.parse(str(path)))
    document = etree.parse(file)
    document.getroot().attrib.update(EDITION_2_1)
    schema.validate(document)
    return [f"line {error.line}: {error.message}" for error in schema.error_log]
