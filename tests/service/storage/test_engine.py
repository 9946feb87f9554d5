"""Which databases can be connected to, and what is said of the others."""

import pytest

from service.storage.engine import connect
from service.storage.errors import StorageError


@pytest.mark.parametrize(
    ("url", "message"),
    [
        ("nonsense", "expected a URL such as sqlite"),
        ("sqlite://", "a database in memory"),
        ("mysql+pymysql://mcc@db.example/mcc", "expected sqlite:///FILE or postgresql\\+psycopg://"),
    ],
)
def test_what_cannot_be_connected_to_is_named(url: str, message: str) -> None:
    with pytest.raises(StorageError, match=message):
        connect(url)


def test_a_server_that_is_cut_off_is_given_up_when_the_url_says_or_soon() -> None:
    query = connect("postgresql+psycopg://mcc@db.example/mcc?connect_timeout=3").url.query
    assert (query["connect_timeout"], query["tcp_user_timeout"]) == ("3", "25000")
