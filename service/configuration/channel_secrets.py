"""The secrets of channels: a mail password, a signing key, an address that must not be known.

They are read from files that only their owner can read, or from the environment, each time they are used, and
are handed to the sender alone.
"""

import base64
import binascii
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Final, Literal

from mms import CredentialFileError, read_secret
from service.configuration.channels import (
    AppriseChannel,
    Channel,
    MailChannel,
    WebhookChannel,
    variable_part,
)
from service.configuration.environment import VARIABLES

VARIABLE: Final = "MCC_NOTIFY_"
"""Followed by what the secret is, _ and the channel's name in capitals with _ for -; wins over the file."""

Secret = Literal["PASSWORD", "SECRET", "URL", "URLS"]
KINDS: Final[tuple[Secret, ...]] = ("PASSWORD", "SECRET", "URL", "URLS")

SIGNING_PREFIX: Final = "whsec_"
LEAST_SIGNING_BYTES: Final = 24
LONGEST_LINE: Final = 4000


class ChannelSecretError(ValueError):
    """A secret of a channel is missing or cannot be used. The message does not show it."""


def password(name: str, channel: MailChannel) -> str | None:
    """Return the password for the mail server. Raises ChannelSecretError."""
    found = _line(name, "PASSWORD", channel.password_file)
    if channel.user is not None and found is None:
        raise ChannelSecretError(_missing(name, "PASSWORD", "password_file"))
    return found


def signing_key(name: str, channel: WebhookChannel) -> bytes | None:
    """Return the key that signs the channel's messages; None where it has none. Raises ChannelSecretError."""
    found = _line(name, "SECRET", channel.secret_file)
    if found is None:
        return None
    key = found.encode()
    if found.startswith(SIGNING_PREFIX):
        try:
            key = base64.b64decode(found.removeprefix(SIGNING_PREFIX), validate=True)
        except binascii.Error:
            raise ChannelSecretError(
                f"channel {name}: expected {SIGNING_PREFIX} and a key in base64, found something else"
            ) from None
    if len(key) < LEAST_SIGNING_BYTES:
        raise ChannelSecretError(
            f"channel {name}: expected a key of at least {LEAST_SIGNING_BYTES} bytes, found {len(key)}"
        )
    return key


def url(name: str, channel: WebhookChannel) -> str:
    """Return the address that the channel posts to. Raises ChannelSecretError."""
    found = _line(name, "URL", channel.url_file)
    if found is None and channel.url is None:
        raise ChannelSecretError(_missing(name, "URL", "url or url_file"))
    if found is not None:
        _require_url(name, found)
    return found or str(channel.url)


def urls(name: str, channel: AppriseChannel) -> tuple[str, ...]:
    """Return the channel's addresses of Apprise. Raises ChannelSecretError."""
    text = _text(name, "URLS", channel.urls_file)
    lines = tuple(
        line.strip() for line in (text or "").splitlines() if line.strip() and not line.startswith("#")
    )
    if not lines:
        raise ChannelSecretError(_missing(name, "URLS", "urls_file"))
    return lines


def require_secrets(name: str, channel: Channel) -> None:
    """Raise ChannelSecretError where a secret of the channel is missing or cannot be used."""
    match channel:
        case MailChannel():
            password(name, channel)
        case WebhookChannel():
            url(name, channel)
            signing_key(name, channel)
        case AppriseChannel():
            urls(name, channel)


def is_variable(variable: str) -> bool:
    """Tell whether a variable of the environment is named like a channel's secret."""
    return any(variable.startswith(f"{VARIABLE}{kind}_") for kind in KINDS)


def unknown_channels(channels: Iterable[str], variables: Mapping[str, str]) -> Iterator[str]:
    """Yield the variables that are named like the secret of a channel that there is not."""
    known = {f"{VARIABLE}{kind}_{variable_part(name)}" for name in channels for kind in KINDS}
    for variable in sorted(variables):
        if is_variable(variable) and variable not in known:
            yield variable


def _require_url(name: str, found: str) -> None:
    if re.fullmatch(r"https?://[!-~]+", found) is None:
        raise ChannelSecretError(f"channel {name}: expected an address https://..., found something else")


def _line(name: str, kind: Secret, path: Path | None) -> str | None:
    """Return the one line of a secret; None where none is given."""
    text = _text(name, kind, path)
    if text is None:
        return None
    line = text.removesuffix("\n").removesuffix("\r")
    if not line or len(line) > LONGEST_LINE or not line.isprintable():
        where = _source(name, kind, path)
        raise ChannelSecretError(
            f"channel {name}: {where}: expected a secret on one line, found something else"
        )
    return line


def _text(name: str, kind: Secret, path: Path | None) -> str | None:
    given = VARIABLES.get(_variable(name, kind))
    if given:
        return given
    if path is None:
        return None
    try:
        return read_secret(path).decode("utf-8")
    except CredentialFileError as error:
        raise ChannelSecretError(f"channel {name}: {error}") from error
    except UnicodeDecodeError:
        raise ChannelSecretError(f"channel {name}: {path}: expected text in UTF-8") from None


def _variable(name: str, kind: Secret) -> str:
    return f"{VARIABLE}{kind}_{variable_part(name)}"


def _source(name: str, kind: Secret, path: Path | None) -> str:
    variable = _variable(name, kind)
    return f"variable {variable}" if VARIABLES.get(variable) else str(path)


def _missing(name: str, kind: Secret, key: str) -> str:
    return f"channel {name}: expected {key}, or the variable {_variable(name, kind)}, found neither"
