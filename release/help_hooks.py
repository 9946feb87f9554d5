"""The hooks of mkdocs.yml: what the help pages have otherwise than MkDocs and its theme would make them.

They have to work without the Internet, and under the policy of the service's pages: no script within a page.
"""

import hashlib
import posixpath
import re
from collections.abc import Iterator
from importlib.metadata import distribution
from pathlib import Path
from typing import Final

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import Files
from mkdocs.structure.pages import Page
from mkdocs.utils import get_relative_url

INDEX: Final = "README.md"
"""The page that names all others: their order and their names in the menu are its own."""

LINK: Final = re.compile(r"\[([^\]]+)\]\(([^)\s]+)\)")
INLINE_SCRIPT: Final = re.compile(r"<script>(.+?)</script>", re.DOTALL)
UNUSED: Final = re.compile(r"\.map$|/lunr/|^404\.html$|^sitemap\.xml$")
"""Files of the theme: for its developers, for languages that are not ours, with addresses of a site's own."""
LICENCES: Final = ("mkdocs-material", "Pygments")
"""Packages of which scripts or styles are in the site."""

SEARCH: Final = 'data-md-component="search" role="dialog"'
"""The theme gives it no name, which screen readers need."""

_scripts: Final[dict[str, str]] = {}
"""What stood within pages, by the file that it goes to."""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Take the menu from the index, and the anchors of headings as code hosts make them."""
    _scripts.clear()
    config.nav = list(menu(Path(config.docs_dir, INDEX).read_text(encoding="utf-8")))
    config.mdx_configs["toc"]["slugify"] = anchor
    config.theme.static_templates.clear()
    return config


def menu(index: str) -> Iterator[dict[str, object]]:
    """Yield the index itself, and each of its sections with the pages that it links to."""
    yield {"Contents": INDEX}
    for section in re.split(r"^## ", index, flags=re.MULTILINE)[1:]:
        title, _, text = section.partition("\n")
        pages = [{_title(words): page} for words, page in LINK.findall(text) if page.endswith(".md")]
        if pages:
            yield {title: pages}


def _title(words: str) -> str:
    words = " ".join(words.split())
    return words[0].upper() + words[1:]


def anchor(heading: str, separator: str) -> str:
    """Return the anchor of a heading, which links between pages name on code hosts too."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", separator)


def on_files(files: Files, **_others: object) -> Files:
    """Leave out what the site does not use."""
    for file in list(files):
        if not file.src_uri.endswith(".md") and UNUSED.search(file.src_uri):
            files.remove(file)
    return files


def on_page_markdown(markdown: str, page: Page, **_others: object) -> str:
    """Keep the words alone of a link to a file of the source tree, which is not at hand."""
    folder = posixpath.dirname(page.file.src_uri)

    def linked(found: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(folder, found[2]))
        return found[1] if target.startswith("../") else found[0]

    return LINK.sub(linked, markdown)


def on_post_page(output: str, page: Page, **_others: object) -> str:
    """Put the scripts within a page into files, for the service lets no others run; name the search."""

    def moved(found: re.Match[str]) -> str:
        file = f"assets/javascripts/{hashlib.sha256(found[1].encode()).hexdigest()[:12]}.js"
        _scripts[file] = found[1]
        return f'<script src="{get_relative_url(file, page.url)}"></script>'

    return INLINE_SCRIPT.sub(moved, output).replace(SEARCH, f'{SEARCH} aria-label="Search"')


def on_post_build(config: MkDocsConfig) -> None:
    """Write those scripts, and the licences of what others wrote."""
    site = Path(config.site_dir)
    for file, script in _scripts.items():
        (site / file).write_text(script, encoding="utf-8")
    for name in LICENCES:
        (site / f"assets/LICENSE.{name}.txt").write_text(_licence(name), encoding="utf-8")


def _licence(package: str) -> str:
    files = distribution(package).files or []
    return next(file for file in files if "LICENSE" in file.name).read_text(encoding="utf-8")
