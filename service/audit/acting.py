"""Who did something, in words: always the account that acted, and beside it whom somebody named."""

from collections.abc import Mapping


def in_words(account: str, on_behalf_of: str | None) -> str:
    """Return who did something. account: that acted. on_behalf_of: free text."""
    return account if on_behalf_of is None else f"{account}, on behalf of {on_behalf_of}"


def who_of(document: Mapping[str, object], which: str = "") -> str:
    """Return who did something, as a document of the API has it. which: begins the names of its fields."""
    account, named = document[f"{which}by"], document[f"{which}on_behalf_of"]
    return in_words(str(account), None if named is None else str(named))
