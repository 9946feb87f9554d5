"""Every route declares what it needs of its caller."""

from fastapi.routing import APIRoute, iter_route_contexts

from service.api import ApiContext
from service.api.access.requirements import requirement_of
from service.web.app import create_site


def test_every_route_declares_what_it_needs(context: ApiContext) -> None:
    open_routes = set()
    for route in iter_route_contexts(create_site(context).routes):
        assert isinstance(route.original_route, APIRoute), f"{route.path}: no route"
        try:
            if requirement_of(route.dependencies) is None:
                open_routes.add(route.path)
        except LookupError as error:
            raise AssertionError(f"{route.methods} {route.path}: {error}") from error
    assert open_routes == {
        "/healthz",
        "/readyz",
        "/api/v1/login",
        "/api/v1/login/passkey",
        "/login",
        "/login/link",
    }
