"""`mcc user`: users and their roles."""

from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path

from rich.text import Text

from core.error_words import one_line
from service.cli.access.directory import directory
from service.cli.access.passwords import given_password
from service.cli.output import CommandError, print_document, results
from service.cli.rows import print_rows
from service.client.rest_client import Document
from service.client.verdicts import local_time
from service.storage.records import Role

FIELDS = (
    "name",
    "full_name",
    "roles",
    "sites",
    "disabled",
    "has_password",
    "last_login_time",
    "last_login_origin",
)


def _words(key: str) -> Callable[[Document], str]:
    return lambda user: "-" if user[key] is None else one_line(str(user[key]))


def _roles(user: Document) -> str:
    roles = user["roles"]
    return " ".join(map(str, roles)) if isinstance(roles, list) and roles else "-"


def _sites(user: Document) -> str:
    sites = user["sites"]
    return "all" if not isinstance(sites, list) else one_line(", ".join(map(str, sites))) or "none"


def _state(user: Document) -> str:
    if user["disabled"]:
        return "disabled"
    if user.get("locked_until_time"):
        return f"locked until {local_time(user['locked_until_time'])}"
    return "password" if user["has_password"] else "tokens only" if user["subject"] is None else "sign-on"


COLUMNS: Mapping[str, Callable[[Document], str | Text]] = {
    "name": _words("name"),
    "full name": _words("full_name"),
    "roles": _roles,
    "sites": _sites,
    "logs in": _state,
    "last login": lambda user: (
        "-" if user["last_login_time"] is None else local_time(user["last_login_time"])
    ),
    "from": _words("last_login_origin"),
}


def list_users(url: str, config: Path | None, *, local: bool, as_csv: bool, as_json: bool) -> None:
    """Print the users. Raises CommandError."""
    with directory(url, config, local=local) as users:
        found = users.users()
    print_rows("users", found, FIELDS, COLUMNS, as_csv=as_csv, as_json=as_json, whole=("name",))


def add_user(
    url: str,
    config: Path | None,
    name: str,
    roles: Collection[Role],
    *,
    sites: Collection[str] | None,
    full_name: str | None,
    password_file: str | None,
    no_password: bool,
    local: bool,
    as_json: bool,
) -> None:
    """Make a user. Raises CommandError."""
    if no_password and password_file is not None:
        raise CommandError("--no-password: expected it or --password-file, found both")
    password = None if no_password else given_password(password_file, f"password of {name}", again=True)
    with directory(url, config, local=local) as users:
        user = users.add_user(name, roles, sites, full_name, password)
    told = "may log in (mcc login)"
    if no_password:
        told = "has no password; tokens are made on the service's machine (mcc token add --user --config)"
    elif user["password_set_by"] is not None:
        told = "may log in (mcc login), and changes the password first (mcc password)"
    _say(f"user {user['name']}: {_roles(user)}{_where(user)}; {told}", user, as_json=as_json)


def change_user(
    url: str,
    config: Path | None,
    name: str,
    *,
    roles: Sequence[Role] | None,
    no_roles: bool,
    sites: Sequence[str] | None,
    all_sites: bool,
    full_name: str | None,
    disabled: bool | None,
    local: bool,
    as_json: bool,
) -> None:
    """Change what is given of a user. Raises CommandError."""
    wanted = sorted(roles) if roles else [] if no_roles else None
    if sites and all_sites:
        raise CommandError("--all-sites: expected it or --site, found both")
    change = {
        "roles": wanted,
        "sites": sorted(sites) if sites else None,
        "all_sites": all_sites or None,
        "full_name": full_name,
        "disabled": disabled,
    }
    given = {key: value for key, value in change.items() if value is not None}
    if not given:
        raise CommandError(
            "expected --role, --no-roles, --site, --all-sites, --full-name, --disable or --enable, found none"
        )
    with directory(url, config, local=local) as users:
        user = users.change_user(name, given)
    _say(f"user {user['name']}: {_roles(user)}{_where(user)}; {_state(user)}", user, as_json=as_json)


def set_password(
    url: str, config: Path | None, name: str, *, password_file: str | None, local: bool, as_json: bool
) -> None:
    """Give a user another password. Raises CommandError."""
    password = given_password(password_file, f"new password of {name}", again=True)
    with directory(url, config, local=local) as users:
        users.set_password(name, password)
    _say(f"user {name}: password changed; all their sessions and tokens have ended", {}, as_json=as_json)


def unlock_user(url: str, config: Path | None, name: str, *, local: bool, as_json: bool) -> None:
    """Forget the failed logins of a user. Raises CommandError."""
    with directory(url, config, local=local) as users:
        users.unlock(name)
    _say(f"user {name}: failed logins are forgotten", {}, as_json=as_json)


def end_sessions(url: str, config: Path | None, name: str, *, local: bool, as_json: bool) -> None:
    """End all sessions of a user. Raises CommandError."""
    with directory(url, config, local=local) as users:
        users.end_sessions(name)
    _say(f"user {name}: all sessions and tokens have ended", {}, as_json=as_json)


def reset_second_factor(url: str, config: Path | None, name: str, *, local: bool, as_json: bool) -> None:
    """Remove a user's second factor, and print the code that lets them in once. Raises CommandError."""
    with directory(url, config, local=local) as users:
        code = users.reset_second_factor(name)
    ended = "all their sessions and tokens have ended"
    told = f"user {name}: has no second factor now; {ended}; code for one login: {code}"
    _say(told, {"code": code}, as_json=as_json)


def delete_user(url: str, config: Path | None, name: str, *, local: bool, as_json: bool) -> None:
    """Delete a user. Raises CommandError."""
    with directory(url, config, local=local) as users:
        users.delete_user(name)
    _say(f"user {name}: deleted, with sessions and tokens", {}, as_json=as_json)


def _where(user: Document) -> str:
    return "" if user["sites"] is None else f" at {_sites(user)}"


def _say(text: str, document: Document, *, as_json: bool) -> None:
    if as_json:
        print_document(document)
    else:
        results().print(Text(one_line(text)), soft_wrap=True)
