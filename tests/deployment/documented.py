"""The lines docs/how-to/deploy.md tells a person to type."""

import re

from tests.deployment.composing import ROOT


def blocks(heading: str) -> list[str]:
    """The indented blocks under a heading, as shell lines. AssertionError when there is no such heading."""
    page = (ROOT / "docs" / "how-to" / "deploy.md").read_text(encoding="utf-8")
    section = re.search(rf"^#+ {re.escape(heading)}$(.*?)(?=^#|\Z)", page, re.MULTILINE | re.DOTALL)
    assert section, f"docs/how-to/deploy.md: no heading {heading!r}"
    found = re.findall(r"(?:^ {4}\S.*\n)+", section[1], re.MULTILINE)
    return [re.sub(r"^ {4}", "", block, flags=re.MULTILINE) for block in found]
