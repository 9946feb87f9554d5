"""`mcc second-factor`: the own authenticator app and recovery codes."""

import sys

import segno
from rich.text import Text

from service.cli.access.passwords import given_code, given_password
from service.cli.output import CommandError, failing_clearly, print_document, progress, results
from service.client.rest_client import ServiceClient, ServiceError


def set_up(url: str, *, password_file: str | None, code_file: str | None, as_json: bool) -> None:
    """Show the secret for an app, have a code of it confirmed, print recovery codes. Raises CommandError."""
    password = given_password(password_file, "password", again=False)
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        made = service.propose_totp({"password": password})
        if sys.stderr.isatty():
            segno.make(made["uri"], micro=False).terminal(out=sys.stderr, compact=True)
        progress().print(Text(f"key for the authenticator app: {made['secret']}"), soft_wrap=True)
        code = given_code(code_file, "code that the app shows", asked=True)
        if code is None:
            raise CommandError("expected a code of the app, found none; nothing was changed")
        codes = service.confirm_totp({"code": code})["recovery_codes"]
    _print_codes(codes, as_json=as_json)


def make_codes(url: str, *, password_file: str | None, as_json: bool) -> None:
    """Print other recovery codes. Raises CommandError."""
    password = given_password(password_file, "password", again=False)
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        codes = service.make_recovery_codes({"password": password})["recovery_codes"]
    _print_codes(codes, as_json=as_json)


def remove(url: str, *, password_file: str | None, as_json: bool) -> None:
    """Remove the own second factor. Raises CommandError."""
    password = given_password(password_file, "password", again=False)
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        service.remove_second_factor({"password": password})
    if as_json:
        print_document({})
    else:
        results().print(Text("the second factor is removed"), soft_wrap=True)


def _print_codes(codes: list[str], *, as_json: bool) -> None:
    if as_json:
        print_document({"recovery_codes": codes})
        return
    progress().print(Text("each code stands once for the app; they are shown this once"), soft_wrap=True)
    for code in codes:
        results().print(Text(code), soft_wrap=True)
