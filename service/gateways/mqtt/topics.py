"""Names of the plant as levels of topics."""

from urllib.parse import quote

SEPARATORS = frozenset("%/+#")


def level(name: str) -> str:
    """Return a name as one level of a topic, or as an identifier of Sparkplug.

    What has a meaning there or cannot be printed is written as in addresses of the web, %2F for a slash.
    Letters of any language stay. Two names never have the same level.
    """
    return "".join(map(_safe, name))


def _safe(character: str) -> str:
    if character.isprintable() and character not in SEPARATORS:
        return character
    return quote(character, safe="", errors="surrogatepass")
