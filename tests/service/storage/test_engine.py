"""Which databases can be connected to, and what is said of the others."""

import json
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import JSON, Connection, text

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


DOCUMENTS = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(st.characters()),  # half of a surrogate pair is among them
    lambda inside: st.lists(inside) | st.dictionaries(st.text(st.characters()), inside),
)


@pytest.fixture(scope="module")
def connection(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Connection]:
    """Yield a connection to an empty database."""
    engine = connect(f"sqlite:///{tmp_path_factory.mktemp('documents') / 'empty.sqlite'}")
    with engine.connect() as connection:
        yield connection
    engine.dispose()


@given(document=DOCUMENTS)
def test_a_document_is_read_as_it_was_written(document: object, connection: Connection) -> None:
    assert _read(json.dumps(document), connection) == document


def test_half_of_a_surrogate_pair_in_a_document_is_read(connection: Connection) -> None:
    assert _read(r'{"channel": "I\ud800", "phase": "A"}', connection) == {"channel": "I\ud800", "phase": "A"}


def test_what_is_no_document_is_an_error(connection: Connection) -> None:
    with pytest.raises(json.JSONDecodeError):
        _read('{"channel": ', connection)


def _read(document: str, connection: Connection) -> object:
    stored = text("SELECT :document AS document").columns(document=JSON)
    return connection.scalar(stored, {"document": document})
