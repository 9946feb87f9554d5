"""`mcc login`, `logout`, `whoami`, `password`: the own account at a service."""

import getpass

from rich.text import Text

from core.error_words import one_line
from service.cli.access.passwords import given_code, given_password
from service.cli.output import failing_clearly, print_document, print_warning, progress, results
from service.client.credentials import CredentialsError, forget, remember
from service.client.rest_client import Document, ServiceClient, ServiceError, is_in_clear, without_credentials


def log_in(
    url: str, name: str | None, *, password_file: str | None, code_file: str | None, as_json: bool
) -> None:
    """Begin a session, and keep its secret for the commands that follow. Raises CommandError."""
    if is_in_clear(url):
        print_warning(
            f"the password goes to {without_credentials(url)} in clear; see setting tls_certificate"
        )
    who = name or getpass.getuser()
    with failing_clearly(ServiceError), ServiceClient(url, anonymous=True) as service:
        notice = service.get_login_ways()["notice"]
    if notice is not None:
        progress().print(Text(f"{notice}\n\nYou acknowledge this notice when you log in."), soft_wrap=True)
    password = given_password(password_file, f"password of {who} at {without_credentials(url)}", again=False)
    code = given_code(
        code_file, "code of the second factor (empty if there is none)", asked=password_file is None
    )
    with failing_clearly(ServiceError, CredentialsError), ServiceClient(url, anonymous=True) as service:
        account, secret = service.begin_session(who, password, code)
        kept = remember(url, session=secret)
    if as_json:
        print_document(account)
        return
    results().print(Text(f"{_who(account)}; mcc logout ends it (kept in {kept})"), soft_wrap=True)
    if account["password_set_by"] is not None:
        print_warning(
            f"{account['password_set_by']} set this password and knows it: change it before anything else "
            "(mcc password)"
        )
    if account["second_factor"] == "missing":
        print_warning("your role needs a second factor: set it up to go on (mcc second-factor set-up)")


def log_out(url: str, *, as_json: bool) -> None:
    """End the session, and forget what is kept of the service. Raises CommandError."""
    with failing_clearly(ServiceError, CredentialsError):
        try:
            with ServiceClient(url) as service:
                service.log_out()
        except ServiceError as error:
            if error.status is None:
                print_warning(f"the session is forgotten here, and may go on there: {error}")
        forget(url)
    if as_json:
        print_document({})
    else:
        results().print(Text(f"logged out of {without_credentials(url)}"), soft_wrap=True)


def show_account(url: str, *, as_json: bool) -> None:
    """Print who asks, and what they may do. Raises CommandError."""
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        account = service.get_account()
    if as_json:
        print_document(account)
        return
    may = " ".join(account["permissions"])
    results().print(Text(_who(account)), soft_wrap=True)
    results().print(Text(f"may: {may or 'nothing'}"), soft_wrap=True)
    if account["sites"] is not None:
        sites = one_line(", ".join(account["sites"]))
        results().print(Text(f"at: {sites or 'no site'}"), soft_wrap=True)


def change_password(url: str, *, old_file: str | None, new_file: str | None, as_json: bool) -> None:
    """Change the own password, which ends all own sessions and tokens. Raises CommandError."""
    old = given_password(old_file, "present password", again=False)
    new = given_password(new_file, "new password", again=True)
    with failing_clearly(ServiceError, CredentialsError):
        with ServiceClient(url) as service:
            service.change_password({"old": old, "new": new})
        forget(url)
    if as_json:
        print_document({})
    else:
        results().print(Text("the password is changed; log in again (mcc login)"), soft_wrap=True)


def _who(account: Document) -> str:
    roles = account["roles"]
    names = " ".join(map(str, roles)) if isinstance(roles, list) else ""
    return one_line(f"{account['name']}: {names or 'no role'}")
