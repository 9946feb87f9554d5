"""The help pages: the whole documentation, read as on a code host, and nothing of it from elsewhere."""

import posixpath
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from urllib.parse import unquote, urlsplit

import lxml.html
import pytest
from lxml.html import HtmlElement
from markdown_it import MarkdownIt

from release.help_site import HelpSiteError, build
from service.web.help.passages import PASSAGES, passage
from tests.docs.pages import ROOT

DOCS = ROOT / "docs"
TEMPLATES = ROOT / "service" / "web" / "templates"
LOADED = ".//script[@src] | .//img[@src] | .//iframe[@src] | .//source[@src] | .//link[@href]"
COUNTED = ("li", "tr", "pre", "img", "blockquote", "h2", "h3")
"""What a page would have more or fewer of, were its Markdown read otherwise."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the whole site."""
    folder = tmp_path_factory.mktemp("help")
    build(ROOT, folder)
    return folder


@pytest.fixture(scope="module")
def pages(site: Path) -> Mapping[str, HtmlElement]:
    """Its pages by their ways."""
    return {
        path.relative_to(site).as_posix(): lxml.html.document_fromstring(path.read_bytes())
        for path in sorted(site.rglob("*.html"))
    }


def address(page: Path) -> str:
    """Where the site has a page of docs."""
    way = page.relative_to(DOCS).with_suffix(".html")
    return (way.parent / "index.html" if page.name == "README.md" else way).as_posix()


def test_every_page_is_there_and_in_the_menu(site: Path, pages: Mapping[str, HtmlElement]) -> None:
    assert set(pages) == {address(page) for page in DOCS.rglob("*.md")}
    listed = {
        posixpath.normpath(posixpath.join(posixpath.dirname(way), link))
        for way, page in pages.items()
        for link in page.xpath("//nav[contains(@class, 'md-nav--primary')]//a/@href")
    }
    assert set(pages) <= listed


def test_nothing_is_loaded_from_elsewhere(site: Path, pages: Mapping[str, HtmlElement]) -> None:
    loaded = {
        value: way
        for way, page in pages.items()
        for one in page.xpath(LOADED)
        for value in (one.get("src"), one.get("href"))
        if value
    }
    assert len(loaded) > len(COUNTED)
    assert {value: way for value, way in loaded.items() if urlsplit(value).netloc} == {}
    for style in site.rglob("*.css"):
        outside = r"url\((?!\s*[\"']?(?:data:|#))[^)]*|@import"
        assert re.findall(outside, style.read_text(encoding="utf-8")) == []


def test_a_page_has_markup_alone(pages: Mapping[str, HtmlElement]) -> None:
    """The policy of the service lets no script and no style run that a page has within itself."""
    own = ".//script[not(@src)][not(@type='application/json')] | .//style | .//*[@style]"
    found = [(way, one.tag) for way, page in pages.items() for one in page.xpath(own)]
    found += [
        (way, name) for way, page in pages.items() for one in page.iter("*") for name in one.attrib
        if name.startswith("on")
    ]  # fmt: skip
    assert found == []


def test_every_link_leads_to_a_file_and_an_anchor(site: Path, pages: Mapping[str, HtmlElement]) -> None:
    anchors = {way: set(page.xpath("//@id")) for way, page in pages.items()}
    broken = []
    for way, page in pages.items():
        for link in page.xpath("//a/@href | //img/@src"):
            parts = urlsplit(link)
            if parts.netloc or parts.scheme or parts.path.startswith("/"):
                continue
            target = (site / way).parent / unquote(parts.path) if parts.path else site / way
            target = target.resolve()
            if target.is_dir():
                target /= "index.html"
            known = anchors.get(target.relative_to(site.resolve()).as_posix(), set())
            if not target.is_file() or (parts.fragment and unquote(parts.fragment) not in known):
                broken.append((way, link))
    assert broken == []


@pytest.mark.parametrize("page", sorted(DOCS.rglob("*.md")), ids=lambda page: str(page.relative_to(DOCS)))
def test_a_page_reads_as_on_a_code_host(page: Path, pages: Mapping[str, HtmlElement]) -> None:
    text = MarkdownIt("commonmark").enable("table").render(page.read_text(encoding="utf-8"))
    (article,) = pages[address(page)].xpath("//article")
    there, here = (
        Counter(one.tag for one in tree.iter(*COUNTED))
        for tree in (lxml.html.fragment_fromstring(text, create_parent="div"), article)
    )
    assert here == there, "a list or a block within an item of a list: four spaces before it"


@pytest.mark.parametrize("about", PASSAGES)
def test_a_passage_that_pages_name_is_there(about: str, pages: Mapping[str, HtmlElement]) -> None:
    way, _, anchor = PASSAGES[about].partition("#")
    assert way in pages
    assert not anchor or pages[way].xpath("//*[@id=$anchor]", anchor=anchor)


def named_passages() -> Iterator[str]:
    for template in TEMPLATES.rglob("*.html"):
        yield from re.findall(r"\bhelp\(\"([^\"]+)\"\)", template.read_text(encoding="utf-8"))


def test_the_pages_of_the_product_name_each_passage_and_no_other() -> None:
    assert set(named_passages()) == set(PASSAGES)
    with pytest.raises(LookupError, match=r"expected a passage of .*, found 'ghosts'"):
        passage("ghosts")


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A tree of two pages."""
    for file in ("mkdocs.yml", "release/help_hooks.py"):
        (tmp_path / file).parent.mkdir(exist_ok=True)
        (tmp_path / file).write_bytes((ROOT / file).read_bytes())
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "README.md").write_text("# Contents\n\n## Guides\n\n- [the first](first.md)\n")
    (tmp_path / "docs" / "first.md").write_text(
        "# First\n\nSee [the licence](../LICENSE), [here](#a-b).\n\n## A: b\n"
    )
    return tmp_path


def test_the_same_pages_give_the_same_bytes(small: Path) -> None:
    made = []
    for folder in (small / "one", small / "two"):
        build(small, folder)
        made.append({one.relative_to(folder): one.read_bytes() for one in folder.rglob("*") if one.is_file()})
    assert made[0] == made[1]
    page = made[0][Path("first.html")].decode()
    assert "See the licence" in page, "a file of the source tree is not at hand"
    assert 'href="#a-b"' in page
    assert Path("assets/LICENSE.mkdocs-material.txt") in made[0]


@pytest.mark.parametrize("wrong", ["[none](none.md)", "[none](#none)", "[none](first.md#none)"])
def test_a_link_that_leads_nowhere_is_an_error(small: Path, wrong: str) -> None:
    with (small / "docs" / "first.md").open("a") as page:
        page.write(f"\n{wrong}\n")
    with pytest.raises(HelpSiteError, match=r"docs: expected pages of which a site can be made, found:"):
        build(small, small / "site")


def test_a_page_that_the_contents_do_not_name_is_an_error(small: Path) -> None:
    (small / "docs" / "second.md").write_text("# Second\n")
    with pytest.raises(HelpSiteError, match=r"second\.md"):
        build(small, small / "site")
