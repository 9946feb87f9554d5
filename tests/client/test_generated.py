"""What is generated of the client package is what the present OpenAPI document gives."""

import inspect

import pytest

from statorwatch_client import AsyncClient, Client
from tests.client.generated import PACKAGE, files, openapi_document


@pytest.mark.parametrize("name", ["models.py", "operations.py", "async_operations.py"])
def test_it_is_as_make_client_writes_it(name: str, generated: dict[str, str]) -> None:
    assert (PACKAGE / name).read_text() == generated[name], "make client writes it anew"


@pytest.fixture(scope="module")
def generated() -> dict[str, str]:
    return files()


def test_each_route_has_a_function_in_both_clients() -> None:
    routes = [
        operation["operationId"]
        for methods in openapi_document()["paths"].values()
        for operation in methods.values()
    ]
    assert len(routes) > 90
    assert len(set(routes)) == len(routes), "two routes have the same name"
    for name in routes:
        there, here = inspect.signature(getattr(AsyncClient, name)), inspect.signature(getattr(Client, name))
        assert there.parameters == here.parameters, name
