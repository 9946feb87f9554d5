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
from service.access.login_links import address_of, is_good, new_login_link
from service.client.credentials import write_secret
from service.configuration.settings import Settings
from service.storage import Repository, connect, migrate
from service.storage.answering import DatabaseUnusableError, answering
from service.storage.errors import UserExistsError
from service.storage.records import Actor, Role

NAME = "demo"
ROLES = (Role.VIEWER, Role.OPERATOR, Role.ENGINEER, Role.SECADM, Role.SECAUD)
MOST_TOKENS = 100
BY = Actor("mcc demo", "command line")


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
    if kept is not None and repository.token_with(digest_of(kept)) is not None:
        return kept
    now_ns = time.time_ns()
    with suppress(UserExistsError):
        repository.add_user(NAME, ROLES, password=None, by=BY, now_ns=now_ns)
    for token in repository.tokens(user=NAME, limit=MOST_TOKENS).items:
        repository.revoke_token(token.id, user=NAME, by=BY, now_ns=now_ns)
    secret = new_token()
    digest = digest_of(secret)
    repository.add_token(NAME, "mcc demo", digest, scope=None, expires_ns=None, by=BY, now_ns=now_ns)
    return secret


def main(file: Path) -> None:
    """Have a file with a token of the demo's user; end with one line where the database does not answer."""
    settings = Settings.load()
    settings.data_directory.mkdir(parents=True, exist_ok=True)
    kept = file.read_text(encoding="utf-8").strip() if file.exists() else None
    try:
        with answering(settings.database_url):
            token = demo_token(settings.database_url, kept)
    except DatabaseUnusableError as error:
        sys.exit(one_line(str(error)))
    write_secret(file, token)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
