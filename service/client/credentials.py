"""What a client shows to a service: from the environment, or from the file that `mcc login` writes.

The variables are MCC_TOKEN, a token, and MCC_TOKEN_FILE, a file with one. The file of mcc login holds a
session or a token for each service, by its address, so that none is sent to another service.
"""

import fcntl
import json
import os
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Final
from urllib.parse import urlsplit

TOKEN_VARIABLE: Final = "MCC_TOKEN"  # noqa: S105 - the name of a variable
TOKEN_FILE_VARIABLE: Final = "MCC_TOKEN_FILE"  # noqa: S105 - the name of a variable

COOKIES: Final = {"http": "statorwatch_session", "https": "__Host-statorwatch_session"}
LARGEST_BYTES: Final = 1 << 20
OWNER_ONLY: Final = 0o600


class CredentialsError(Exception):
    """What is to be shown to a service cannot be read or kept. The message shows no secret."""


def credentials_file() -> Path:
    """Return the file in which `mcc login` keeps sessions."""
    configured = os.environ.get("XDG_CONFIG_HOME", "")
    folder = Path(configured) if Path(configured).is_absolute() else Path.home() / ".config"
    return folder / "statorwatch" / "credentials.json"


def headers_for(url: str) -> dict[str, str]:
    """Return the headers that tell a service who asks; none where nothing is known for it.

    Raises CredentialsError.
    """
    token = os.environ.get(TOKEN_VARIABLE, "").strip()
    file = os.environ.get(TOKEN_FILE_VARIABLE, "")
    if not token and file:
        token = _secret_in(Path(file))
    if token:
        return bearer(token)
    kept = _read(credentials_file()).get(_origin(url), {})
    if "token" in kept:
        return bearer(kept["token"])
    if "session" in kept:
        return session_cookie(url, kept["session"])
    return {}


def bearer(token: str) -> dict[str, str]:
    """Return the header that shows a token. Raises CredentialsError for what no header can hold."""
    return {"Authorization": f"Bearer {_fit(token)}"}


def session_cookie(url: str, secret: str) -> dict[str, str]:
    """Return the header that shows a session."""
    return {"Cookie": f"{COOKIES.get(urlsplit(url).scheme, COOKIES['http'])}={_fit(secret)}"}


def remember(url: str, *, session: str | None = None, token: str | None = None) -> Path:
    """Keep what to show to a service, in place of what was kept for it; return the file.

    Raises CredentialsError.
    """
    secrets = {"session": session, "token": token}
    path = credentials_file()
    with _changing(path) as kept:
        kept[_origin(url)] = {name: secret for name, secret in secrets.items() if secret is not None}
    return path


def forget(url: str) -> None:
    """Keep nothing for a service any more. Raises CredentialsError."""
    path = credentials_file()
    if path.exists():
        with _changing(path) as kept:
            kept.pop(_origin(url), None)


def write_secret(path: Path, secret: str) -> None:
    """Write a file that only its owner may read. Raises OSError."""
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_NOFOLLOW, OWNER_ONLY)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        os.fchmod(descriptor, OWNER_ONLY)
        file.write(f"{secret}\n")


def _origin(url: str) -> str:
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc.rpartition('@')[2].lower()}"


def _fit(secret: str) -> str:
    if not secret.isascii() or not secret.isprintable() or any(mark in secret for mark in ' ";,\\'):
        raise CredentialsError("expected a token of letters, digits, - and _, found something else")
    return secret


def _secret_in(path: Path) -> str:
    try:
        with path.open(encoding="utf-8") as file:
            return file.read(LARGEST_BYTES).strip()
    except (OSError, UnicodeDecodeError) as error:
        raise CredentialsError(f"{path} ({TOKEN_FILE_VARIABLE}): cannot be read: {error}") from error


def _read(path: Path) -> dict[str, dict[str, str]]:
    try:
        with path.open("rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            content = file.read(LARGEST_BYTES)
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise CredentialsError(f"{path}: cannot be read: {error.strerror}") from error
    if mode & (stat.S_IRWXG | stat.S_IRWXO):
        raise CredentialsError(
            f"{path}: expected a file that only its owner may read, found mode {stat.S_IMODE(mode):o}; run "
            f"chmod 600 on it, and log in again where others may have read it"
        )
    try:
        found = json.loads(content)
        return {
            str(url): {str(name): str(secret) for name, secret in kept.items()} for url, kept in found.items()
        }
    except (ValueError, AttributeError, RecursionError) as error:
        raise CredentialsError(
            f"{path}: expected what mcc login writes; delete it and log in again"
        ) from error


@contextmanager
def _changing(path: Path) -> Iterator[dict[str, dict[str, str]]]:
    """Give what the file holds, and write it anew after the block; others who change it wait."""
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        with path.with_suffix(".lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            kept = _read(path)
            yield kept
            new = path.with_suffix(".new")
            new.unlink(missing_ok=True)
            write_secret(new, json.dumps(_sorted(kept), indent=2))
            new.replace(path)
    except OSError as error:
        raise CredentialsError(f"{path}: cannot be written: {error.strerror}") from error


def _sorted(kept: Mapping[str, Mapping[str, str]]) -> dict[str, dict[str, str]]:
    return {url: dict(secrets) for url, secrets in sorted(kept.items()) if secrets}
