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
