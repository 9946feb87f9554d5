"""A database URL is printed without its password, and not at all where it is wrong."""

import re
import traceback

import pytest

from service.storage import StorageError, connect
from service.storage.database_url import readable_url

MARK = "Zx9"
"""Each part of the passwords below has it."""


@pytest.mark.parametrize(
    "url",
    [
        "postgresql://mcc:Zx9@Zx9@db/mcc",
        "postgresql://mcc:Zx9@Zx9:Zx9@db/mcc",
        "postgresql://mcc:Zx9@Zx9/Zx9@db/mcc",
        "postgresql://mcc:Zx9@db:Zx9@db:5432/mcc",
        "postgresql+psycopg://mcc:Zx9@db:port/mcc",
        "mcc:Zx9@db",
        "Zx9@Zx9",
    ],
)
def test_a_url_that_ends_its_password_early_is_refused_and_told_nowhere(url: str) -> None:
    with pytest.raises(StorageError, match="%40") as refused:
        connect(url)
    assert MARK not in "".join(traceback.format_exception(refused.value))


@pytest.mark.parametrize(
    "scheme", ["postgres", "postgres+psycopg", "postgresql+psycopg2", "postgresql+asyncpg"]
)
def test_another_name_of_postgresql_names_the_right_url(scheme: str) -> None:
    words = rf"found {re.escape(scheme)}://; write postgresql\+psycopg://"
    with pytest.raises(StorageError, match=words) as refused:
        connect(f"{scheme}://mcc:{MARK}@db/mcc")
    assert MARK not in str(refused.value)


@pytest.mark.parametrize(
    ("url", "printed"),
    [
        ("postgresql://mcc:Zx9%40Zx9@db/mcc", "postgresql://mcc:***@db/mcc"),
        ("postgresql://mcc:Zx9@db/mcc?sslpassword=Zx9", "postgresql://mcc:***@db/mcc"),
        ("postgresql:///mcc?password=Zx9&host=db", "postgresql:///mcc"),
        ("sqlite:////data/db.sqlite", "sqlite:////data/db.sqlite"),
    ],
)
def test_what_people_see(url: str, printed: str) -> None:
    assert readable_url(url) == printed
