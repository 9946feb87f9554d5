"""`mcc token`: secrets for programs."""

import time
from collections.abc import Callable, Collection, Mapping
from pathlib import Path

from rich.text import Text

from core.error_words import one_line
from core.time_stamps import rfc3339
from core.units import NANOSECONDS_PER_DAY
from service.cli.access.directory import directory
from service.cli.output import failing_clearly, print_document, progress, results
from service.cli.rows import print_rows
from service.client.credentials import write_secret
from service.client.rest_client import Document
from service.client.verdicts import local_time

FIELDS = ("id", "user", "label", "scope", "sites", "created_time", "expires_time", "used_time")


def _scope(token: Document) -> str:
    scope = token["scope"]
    return " ".join(map(str, scope)) if isinstance(scope, list) else "all of the user"


def _time(key: str) -> Callable[[Document], str]:
    return lambda token: "never" if token[key] is None else local_time(token[key])


COLUMNS: Mapping[str, Callable[[Document], str | Text]] = {
    "label": lambda token: one_line(str(token["label"])),
    "user": lambda token: one_line(str(token["user"])),
    "scope": _scope,
    "expires": _time("expires_time"),
    "last used": _time("used_time"),
    "id": lambda token: str(token["id"]),
}


def list_tokens(url: str, config: Path | None, *, local: bool, as_csv: bool, as_json: bool) -> None:
    """Print the tokens, without their secrets. Raises CommandError."""
    with directory(url, config, local=local) as users:
        found = users.tokens()
    print_rows("tokens", found, FIELDS, COLUMNS, as_csv=as_csv, as_json=as_json, whole=("id",))


def add_token(
    url: str,
    config: Path | None,
    label: str,
    *,
    user: str | None,
    scope: Collection[str] | None,
    sites: Collection[str] | None,
    days: float | None,
    output: Path | None,
    local: bool,
    as_json: bool,
) -> None:
    """Make a token; print its secret, or write it into a file that only its owner may read.

    Raises CommandError.
    """
    expires = None if days is None else rfc3339(time.time_ns() + round(days * NANOSECONDS_PER_DAY))
    with directory(url, config, local=local) as users:
        token = users.add_token(user, label, scope, sites, expires)
    secret = str(token["token"])
    if output is not None:
        with failing_clearly(OSError):
            write_secret(output, secret)
        token = {**token, "token": str(output)}
    if as_json:
        print_document(token)
        return
    progress().print(
        Text(f"token {token['id']} of {token['user']}: {_scope(token)}; expires {COLUMNS['expires'](token)}"),
        soft_wrap=True,
    )
    results().print(Text(f"written to {output}" if output is not None else secret), soft_wrap=True)


def revoke_token(url: str, config: Path | None, token_id: str, *, local: bool, as_json: bool) -> None:
    """End a token, and those that were made with it. Raises CommandError."""
    with directory(url, config, local=local) as users:
        users.revoke_token(token_id)
    if as_json:
        print_document({})
    else:
        results().print(Text(one_line(f"token {token_id}: revoked")), soft_wrap=True)


def revoke_tokens(url: str, config: Path | None, *, user: str | None, local: bool, as_json: bool) -> None:
    """End all tokens of a user, by default the own ones. Raises CommandError."""
    with directory(url, config, local=local) as users:
        users.revoke_tokens(user)
    if as_json:
        print_document({})
    else:
        whose = "your" if user is None else f"user {user}: all"
        results().print(Text(one_line(f"{whose} tokens have ended")), soft_wrap=True)
