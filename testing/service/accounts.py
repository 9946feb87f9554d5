"""An account for tests that are not about access: it may do everything but read the audit trail."""

import atexit
import os
import shutil
import tempfile
import time
import uuid
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from service.access.bearer_secrets import digest_of, new_token
from service.client.credentials import bearer, remember
from service.configuration.settings import sqlite_url
from service.storage import Repository, connect, migrate
from service.storage.models import ApiTokenRow, UserRow
from service.storage.records import COMMAND_LINE, Actor, Role

TESTER = "tester"
AUDITOR = "auditor"
TESTS = Actor("tests", COMMAND_LINE)
EVERYTHING = tuple(role for role in Role if role is not Role.SECAUD)
"""The most that one user may be: nobody has SECADM and SECAUD."""


def token_of(repository: Repository, *roles: Role, name: str = TESTER) -> str:
    """A token of a user with these roles, or with EVERYTHING; the user is made where there is none.

    The audit trail tells of neither: it is for what the tests do.
    """
    secret, now_ns = new_token(), time.time_ns()
    with repository._write() as session:  # noqa: SLF001 - so that no entry is made
        if session.get(UserRow, name) is None:
            words = " ".join(roles or EVERYTHING)
            session.add(UserRow(name=name, roles=words, disabled=False, created_ns=now_ns))
            session.flush()
        session.add(
            ApiTokenRow(
                id=str(uuid.uuid4()),
                user=name,
                label="tests",
                digest=digest_of(secret),
                created_ns=now_ns,
            )
        )
    return secret


def auditor(repository: Repository) -> Mapping[str, str]:
    """The headers of somebody who reads the audit trail, and may do everything but manage users."""
    return bearer(auditor_token(repository))


def auditor_token(repository: Repository) -> str:
    """A token of the same."""
    return token_of(repository, *(role for role in Role if role is not Role.SECADM), name=AUDITOR)


def log_in(repository: Repository, url: str) -> str:
    """Have clients of this process, and commands that it runs, use a token of EVERYTHING at a service."""
    keep_apart()
    token = token_of(repository)
    remember(url, token=token)
    return token


def log_in_before_start(environment: Mapping[str, str], url: str) -> str:
    """Do the same for a service that will be started with these settings; its database is made."""
    data = Path(environment["MCC_DATA_DIRECTORY"])
    data.mkdir(parents=True, exist_ok=True)
    database_url = environment.get("MCC_DATABASE_URL") or sqlite_url(data)
    migrate(database_url)
    engine = connect(database_url)
    try:
        return log_in(Repository(engine), url)
    finally:
        engine.dispose()


@cache
def keep_apart() -> None:
    """Keep what tests log in with apart from what the person who runs them has."""
    folder = tempfile.mkdtemp(prefix="statorwatch-config-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ["XDG_CONFIG_HOME"] = folder
    for variable in ("MCC_TOKEN", "MCC_TOKEN_FILE", "MCC_CA"):
        os.environ.pop(variable, None)
