"""What no template, script or style of ours has: it needs a weaker policy, or runs what others wrote."""

import re
from pathlib import Path

import pytest

import service.web
from service.web.rendering import environment
from service.web.static_files import static_tree

ROOT = Path(service.web.__file__).parent
TEMPLATES = sorted((ROOT / "templates").rglob("*.html"))
SCRIPTS = sorted((ROOT / "static" / "js").rglob("*.js"))
STYLES = sorted((ROOT / "static" / "css").rglob("*.css"))
PICTURES = sorted((ROOT / "static" / "icons").rglob("*.svg"))

IN_TEMPLATES = {
    "an htmx event handler": r"\bhx-on\b|\bdata-hx-on\b",
    "an htmx expression": r"\bjs:|\bjavascript:|hx-vars|hx-trigger=\"[^\"]*\[",
    "an event handler": r"\son[a-z]+\s*=",
    "a style attribute": r"\sstyle\s*=",
    "a style of its own": r"<style\b",
    "a script of its own": r"<script(?![^>]*\bsrc=)(?![^>]*type=\"application/json\")",
    "a value that is not escaped": r"\|\s*safe\b|autoescape\s+false|Markup\(",
    "an address of another host": r"(?:href|src|action)\s*=\s*[\"'](?:https?:)?//",
}
ANOTHER_HOST = r"(?:https?:)?//(?!www\.w3\.org/2000/svg\b)[a-z0-9.-]+\.[a-z]{2,}"
IN_SCRIPTS = {
    "evaluation": r"\beval\s*\(|new Function\b|setTimeout\(\s*[\"'`]",
    "markup from a string": r"\.innerHTML\s*=|\.outerHTML\s*=|insertAdjacentHTML|document\.write",
    "an address of another host": ANOTHER_HOST,
    "an import of another host": r"import[^;]*[\"'](?:https?:)?//",
}
IN_STYLES = {
    "an address of another host": ANOTHER_HOST,
    "something to load from another host": r"url\(\s*[\"']?(?:https?:)?//|@import",
}
IN_PICTURES = {**IN_TEMPLATES, "an address of another host": ANOTHER_HOST}


def marks(text: str, patterns: dict[str, str]) -> list[str]:
    """What of the patterns is in a text, with its line."""
    bare = re.sub(r"\{#.*?#\}", "", text, flags=re.DOTALL)
    return [
        f"line {bare[: found.start()].count(chr(10)) + 1}: {what}: {found[0].strip()}"
        for what, pattern in patterns.items()
        for found in re.finditer(pattern, bare)
    ]


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_template_has_markup_alone(path: Path) -> None:
    assert marks(path.read_text(encoding="utf-8"), IN_TEMPLATES) == []


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_script_makes_no_markup_of_texts(path: Path) -> None:
    assert marks(path.read_text(encoding="utf-8"), IN_SCRIPTS) == []


@pytest.mark.parametrize("path", STYLES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_style_loads_nothing_from_elsewhere(path: Path) -> None:
    assert marks(path.read_text(encoding="utf-8"), IN_STYLES) == []


@pytest.mark.parametrize("path", PICTURES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_picture_runs_and_loads_nothing(path: Path) -> None:
    assert marks(path.read_text(encoding="utf-8"), IN_PICTURES) == []


def test_every_file_of_ours_is_looked_at() -> None:
    looked_at = {str(path.relative_to(ROOT / "static")) for path in (*SCRIPTS, *STYLES, *PICTURES)}
    assert looked_at == {way for way in static_tree().files if not way.startswith("vendor/")}
    assert TEMPLATES


@pytest.mark.parametrize(
    "text",
    [
        '<p hx-on:click="x()">', "<a href='javascript:x'>", '<p onclick="x">', '<p style="x">',
        "<style>x</style>", "<script>x</script>", "{{ x | safe }}", '<img src="//x/y.png">',
        '<div hx-trigger="click[x()]">', "<p hx-vals='js:{x: y()}'>", '<p hx-vals="js:{x: y()}">',
    ],
)  # fmt: skip
def test_what_is_looked_for_is_found(text: str) -> None:
    assert len(marks(text, IN_TEMPLATES)) == 1


@pytest.mark.parametrize("value", [None, True, object(), [], {"level": 1}, ("a",)])
def test_what_people_cannot_read_is_an_error_and_not_printed(value: object) -> None:
    with pytest.raises(TypeError, match="a template prints text, numbers and paths, found"):
        environment().from_string("{{ value }}").render(value=value)


def test_text_numbers_and_paths_are_printed() -> None:
    shown = (
        environment()
        .from_string("{{ a }} {{ b }} {{ c }} {{ d }}")
        .render(a="<b>", b=2, c=0.5, d=Path("plant") / "mcc.toml")
    )
    assert shown == "&lt;b&gt; 2 0.5 plant/mcc.toml"
