"""Elements of an SVG picture. Every text in them is escaped; none can add an element or an attribute."""

from collections.abc import Iterable, Sequence
from itertools import pairwise

from lxml import etree

from core.error_words import one_line

NAMESPACE = "http://www.w3.org/2000/svg"
FONTS = "system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif"
FONT_SIZE = 12.0

LONGEST_TEXT = 120
LONGEST_DESCRIPTION = 600

Element = etree._Element  # noqa: SLF001 - the name that lxml's types have for it
Place = tuple[float, float]


class Drawing:
    """A picture of a width and a height, in pixels of a screen. x goes to the right, y down."""

    def __init__(self, width: float, height: float, *, title: str, description: str = "") -> None:
        """title: what the picture shows, for those who cannot see it.  description: what it tells."""
        self._root = etree.Element(
            f"{{{NAMESPACE}}}svg",
            {
                "width": f"{width:g}",
                "height": f"{height:g}",
                "viewBox": f"0 0 {width:g} {height:g}",
                "role": "img",
            },
            nsmap={None: NAMESPACE},
        )
        name = _shown(title)
        if description:
            name = f"{name}. {one_line(description)[:LONGEST_DESCRIPTION]}"
        self._add("title").text = name

    def rectangle(self, x: float, y: float, width: float, height: float, **look: str) -> None:
        """Add a rectangle by its upper left corner."""
        self._add("rect", {"x": _n(x), "y": _n(y), "width": _n(width), "height": _n(height)}, look)

    def line(self, x1: float, y1: float, x2: float, y2: float, **look: str) -> None:
        """Add a straight line."""
        self._add("line", {"x1": _n(x1), "y1": _n(y1), "x2": _n(x2), "y2": _n(y2)}, look)

    def path(self, points: Sequence[Place], *, closed: bool = False, **look: str) -> None:
        """Add a line through points, or the area between them."""
        if points:
            words = " L".join(f"{_n(x)} {_n(y)}" for x, y in points)
            self._add("path", {"d": f"M{words}{'Z' if closed else ''}"}, {"fill": "none"} | look)

    def steps(self, pieces: Iterable[Sequence[tuple[int, int]]], **look: str) -> None:
        """Add lines through points on whole pixels, written short: a page may have many of them."""
        words = "".join(map(_short, pieces))
        if words:
            self._add("path", {"d": words}, {"fill": "none"} | look)

    def circles(self, points: Iterable[Place], radius: float, **look: str) -> None:
        """Add a dot at each of the points."""
        for x, y in points:
            self._add("circle", {"cx": _n(x), "cy": _n(y), "r": _n(radius)}, look)

    def text(self, x: float, y: float, words: str, *, anchor: str = "start", **look: str) -> None:
        """Add a line of text. anchor: start, middle or end of it is at x."""
        if "font-family" not in self._root.attrib:
            self._root.set("font-family", FONTS)
            self._root.set("font-size", f"{FONT_SIZE:g}")
        self._add("text", {"x": _n(x), "y": _n(y), "text-anchor": anchor}, look).text = _shown(words)

    def svg(self) -> str:
        """Return the picture."""
        return etree.tostring(self._root, encoding="unicode")

    def _add(self, name: str, *attributes: dict[str, str]) -> Element:
        element = etree.SubElement(self._root, f"{{{NAMESPACE}}}{name}")
        for each in attributes:
            for key, value in each.items():
                element.set(key.replace("_", "-"), value)
        return element


def _n(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")


def _short(piece: Sequence[tuple[int, int]]) -> str:
    """Return a line as moves from each point to the next; a single point is a dot of a line's width."""
    if not piece:
        return ""
    moves = [(x - x0, y - y0) for (x0, y0), (x, y) in pairwise(piece)] or [(0, 0)]
    joined = " ".join(f"{dx}{dy}" if dy < 0 else f"{dx} {dy}" for dx, dy in moves)
    return f"M{piece[0][0]} {piece[0][1]}l{joined}"


def _shown(text: str) -> str:
    """Return a text as an element may hold it: on one line, without what XML has no room for."""
    return one_line(text)[:LONGEST_TEXT]
