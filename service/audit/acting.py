"""Who did something, in words: always the account that acted, and beside it whom somebody named."""

from collections.abc import Mapping
from typing import Final

UNRECORDED: Final = "account not recorded"
"""Entries of before accounts were kept have none. The name beside it is what somebody wrote."""


def in_words(account: str | None, on_behalf_of: str | None) -> str:
    """Return who did something. account: that acted; None where it was not kept. on_behalf_of: free text."""
    if account is None:
        return UNRECORDED if on_behalf_of is None else f"{on_behalf_of} ({UNRECORDED})"
    return account if on_behalf_of is None else f"{account}, on behalf of {on_behalf_of}"


def who_of(document: Mapping[str, object], which: str = "") -> str:
    """Return who did something, as a document of the API has it. which: begins the names of its fields."""
    account, named = document[f"{which}by"], document[f"{which}on_behalf_of"]
    return in_words(None if account is None else str(account), None if named is None else str(named))
