"""The demo's own user, so that the demo, its page and commands in other terminals may do what they show.

`python -m service.demo.account FILE` writes a token of that user into a file that containers share, by the
settings of the environment. A token in that file that is still good stays.
"""

import sys
import time
from contextlib import suppress
from pathlib import Path

from core.error_words import one_line
from service.access.bearer_secrets import digest_of, new_token
from service.access.identities import identity_of_token
from service.access.login_links import address_of, is_good, new_login_link
from service.access.tokens import end_of
from service.client.credentials import write_secret
from service.configuration.access import AccessSettings
from service.configuration.settings import Settings
from service.process.private_files import written_privately
from service.storage import Repository, connect, migrate
from service.storage.answering import DatabaseUnusableError, answering
from service.storage.errors import UserExistsError
from service.storage.records import COMMAND_LINE, Actor, Role

NAME = "demo"
ROLES = (Role.VIEWER, Role.OPERATOR, Role.ENGINEER, Role.SECADM)
BY = Actor("mcc demo", COMMAND_LINE)


def demo_token(database_url: str, kept: str | None = None) -> str:
    """Return a token of the demo's user, made where there is none: `kept` if it is one, else a new one.

    Older tokens of that user end.
    """
    migrate(database_url)
    engine = connect(database_url)
    try:
        return _token(Repository(engine), kept)
    finally:
        engine.dispose()


class LoginLinks:
    """Links to the page of the demo's service, each of which logs the demo's user in once."""

    def __init__(self, database_url: str, url: str) -> None:
        self._database_url = database_url
        self._url = url
        self._secret: str | None = None

    def address(self) -> str:
        """Return a link that can be followed, the same one as before while nobody has."""
        engine = connect(self._database_url)
        try:
            repository, now_ns = Repository(engine), time.time_ns()
            if self._secret is None or not is_good(repository, self._secret, now_ns=now_ns):
                self._secret = new_login_link(repository, NAME, by=BY, now_ns=now_ns)
            return address_of(self._url, self._secret)
        finally:
            engine.dispose()


def _token(repository: Repository, kept: str | None) -> str:
    access, now_ns = AccessSettings(), time.time_ns()
    if kept is not None and identity_of_token(repository, access, kept, now_ns=now_ns) is not None:
        return kept
    with suppress(UserExistsError):
        repository.add_user(NAME, ROLES, password=None, by=BY, now_ns=now_ns)
    repository.revoke_tokens(NAME, by=BY, now_ns=now_ns)
    secret = new_token()
    repository.add_token(
        NAME,
        "mcc demo",
        digest_of(secret),
        scope=None,
        expires_ns=end_of(None, access, parent=None, now_ns=now_ns),
        by=BY,
        now_ns=now_ns,
    )
    return secret


def main(file: Path) -> None:
    """Have a file with a token of the demo's user; end with one line where the database does not answer."""
    settings = Settings.load()
    kept = file.read_text(encoding="utf-8").strip() if file.exists() else None
    try:
        with written_privately(), answering(settings.database_url):
            settings.data_directory.mkdir(parents=True, exist_ok=True)
            token = demo_token(settings.database_url, kept)
    except DatabaseUnusableError as error:
        sys.exit(one_line(str(error)))
    write_secret(file, token)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
