"""SCL files: what the reader says of them; the peer is lxml, which counts; their relays are served."""

from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path

import scl
from benchmarks.corpus.outcomes import Comparison, Kind, Outcome, Reading, alike
from benchmarks.corpus.scl_counts import compared
from benchmarks.corpus.scl_serving import serve_relays
from scl import Finding, SclError


def read_file(path: Path) -> Outcome:
    """How a file is read; alike warnings are one note, and those come first that leave something out."""
    try:
        document = scl.read(path)
    except SclError as refusal:
        return Outcome(Reading.REFUSED, (str(refusal),))
    warnings = sorted(document.warnings, key=lambda warning: not warning.left_out)
    return Outcome(Reading.WARNED if warnings else Reading.READ, tuple(_notes(warnings)))


def compare_file(path: Path) -> Comparison:
    """Compare the numbers of what was read with those that lxml counts."""
    return compared(scl.read(path), path)


def _notes(warnings: list[Finding]) -> Iterator[str]:
    found: dict[str, list[Finding]] = {}
    for warning in warnings:
        tag = warning.element.split(" ")[0]
        found.setdefault(alike(f"{tag} {warning.message}"), []).append(warning)
    for first, *more in found.values():
        yield f"{first} (and {len(more)} more like it)" if more else str(first)


SCL = Kind(
    name="SCL",
    suffixes=(".icd", ".cid", ".iid", ".scd", ".sed", ".ssd"),
    read=read_file,
    compare=compare_file,
    peer=f"lxml {version('lxml')}, XPath counts",
    serve=serve_relays,
)
