"""Changes to the report control block of a model text, for relays whose block clients cannot use fully."""

import re


def without_data_set(model: str, block: str) -> str:
    """Return the model text with the block "BRep01" of LLN0 naming no data set."""
    return _changed(model, block, data_set="-")


def with_optional_fields(model: str, block: str, fields: int) -> str:
    """Return the model text with the block "BRep01" of LLN0 sending these optional fields (OptFlds)."""
    return _changed(model, block, fields=str(fields))


def _changed(model: str, block: str, *, data_set: str = r"\g<data_set>", fields: str = r"\g<fields>") -> str:
    pattern = (
        rf"^(?P<head>RC\({re.escape(block)} \S+ \d )(?P<data_set>\S+)"
        r"(?P<middle> \d+ \d+ )(?P<fields>\d+)(?= )"
    )
    return re.sub(pattern, rf"\g<head>{data_set}\g<middle>{fields}", model, flags=re.MULTILINE)
