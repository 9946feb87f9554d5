"""Texts that spreadsheets take for formulas. Names and reasons come from relays, files and people."""

FIRST_OF_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""With these a formula begins (OWASP, CSV injection); the last four are the wide letters of East Asia."""


def begins_a_formula(text: str) -> bool:
    """Tell whether a spreadsheet takes a text for a formula, also behind spaces and quotation marks."""
    return text.lstrip(" \"'\u00a0\u3000").startswith(FIRST_OF_FORMULA) or text.startswith(FIRST_OF_FORMULA)
