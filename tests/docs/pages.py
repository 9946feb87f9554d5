"""Finds the pages of the documentation and the text files that may name them."""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
TEXT = {".cfg", ".ini", ".md", ".mako", ".py", ".toml", ".yaml", ".yml", ""}
"""Suffixes of files that may name a page. The Makefile, the Dockerfile and scripts have none."""
GENERATED = {".coverage", "__pycache__", "build", "dist", "fuzz-findings", "node_modules"}


def text_files() -> Iterator[Path]:
    """Yield every text file of the repository, without caches and the virtual environment."""
    folders = [ROOT]
    while folders:
        for path in sorted(folders.pop().iterdir()):
            hidden = path.name.startswith(".") and path.name not in {".ci", ".github"}
            if path.is_dir() and not path.is_symlink() and not hidden and path.name not in GENERATED:
                folders.append(path)
            elif path.is_file() and path.suffix in TEXT and path.name not in GENERATED:
                yield path


def pages() -> list[Path]:
    """Return every Markdown page of the repository."""
    return [path for path in text_files() if path.suffix == ".md"]


def anchors(page: Path) -> set[str]:
    """Return the anchors that code hosts make of a page's headings."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def between_markers(page: str, name: str, lines: Iterable[str]) -> str:
    """Return the page with `lines` in place of what is between the markers of that name.

    Raises
    ------
    ValueError
        The page does not have both markers.
    """
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->"
    before, _, rest = page.partition(begin)
    _, found, after = rest.partition(end)
    if not found:
        raise ValueError(f"expected the markers of {name}, found none")
    return before + begin + "\n" + "\n".join(lines).strip() + "\n\n" + end + after
