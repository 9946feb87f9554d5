"""Variables of the environment. Processes that the service starts get none of its own but those they need."""

import os
from collections import ChainMap
from collections.abc import Collection, Mapping
from typing import Final

OURS: Final = "MCC_"
"""Settings and secrets. The settings reach each process through a pipe."""

BUCKET: Final = "AWS_"
"""Who asks an S3-compatible store, and where it is. boto3 looks for these in the environment alone."""

_withheld: dict[str, str] = {}

VARIABLES: Final[Mapping[str, str]] = ChainMap(_withheld, os.environ)
"""All that this process was started with."""


def withhold(prefix: str) -> None:
    """Keep variables out of the environment of all processes that this one starts from now on.

    They stay in VARIABLES. Call it before there are threads that read the environment.
    """
    for name in [name for name in os.environ if name.startswith(prefix)]:
        _withheld[name] = os.environ.pop(name)


def environment_with(prefixes: Collection[str]) -> dict[str, str]:
    """Return the environment of a process: what is no secret of ours, and what it needs by these prefixes."""
    needed = tuple(prefixes)
    return {
        name: value
        for name, value in VARIABLES.items()
        if name.startswith(needed) or not name.startswith((OURS, BUCKET))
    }
