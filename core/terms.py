"""Terms of the API and of files, such as shorted-turns, as people write them."""


def phrase(term: str) -> str:
    """Return a term in words.

    Parameters
    ----------
    term : str
        The term, with hyphens or underscores between its words.

    Returns
    -------
    str
        The same with spaces.
    """
    return str(term).replace("-", " ").replace("_", " ")
