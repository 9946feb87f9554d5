"""Puts the API together."""

import json
from collections.abc import Collection, Mapping, Sequence
from functools import cache
from importlib.metadata import version
from types import MappingProxyType

from fastapi import APIRouter, Depends, FastAPI, Response
from fastapi.openapi.utils import get_openapi
from fastapi.routing import APIRoute, iter_route_contexts

from service.access.permissions import Permission
from service.api import probes, problems
from service.api.access import passkeys, second_factor, sessions, tokens, users
from service.api.access.gate import Gate
from service.api.access.requirements import RouteNeeds, require, requirement_of
from service.api.alarms import lists as alarm_lists
from service.api.alarms import people as alarm_people
from service.api.audit import trail as audit_trail
from service.api.backups import routes as backups
from service.api.classification import routes as classification
from service.api.conditions import notes, planned_stops, undo
from service.api.conditions import routes as conditions
from service.api.context import ApiContext
from service.api.exports import routes as exports
from service.api.host_guard import HostGuard
from service.api.inspections import routes as inspections
from service.api.integrations import routes as integrations
from service.api.limits.arrivals import Arrivals
from service.api.limits.body_limits import REPORT, BodyLimits, BodyRule, Route, document
from service.api.limits.long_lists import LongLists
from service.api.load import routes as load
from service.api.motors import baselines, measurements
from service.api.motors import routes as motors
from service.api.notifications import routes as notifications
from service.api.query_parameters import refuse_unknown_parameters
from service.api.recordings import deletions, diagnoses, event_reports, job_runners
from service.api.recordings import routes as recordings
from service.api.relay_reports import routes as relay_reports
from service.api.relays import routes as relays
from service.api.reports import routes as reports
from service.api.rotor_and_supply import routes as rotor_and_supply
from service.api.samples import routes as samples
from service.api.starts import routes as starts
from service.api.tracking import routes as tracking
from service.configuration.access import OidcSettings

PREFIX = "/api/v1"
DESCRIPTION = """Stator condition of every motor of the plant, from the protection relays it already has.

Times are RFC 3339 in UTC. Lists come in pages: pass `next_cursor` as `cursor` for the next one.
Every error is a problem document (RFC 9457)."""


def create_app(
    context: ApiContext,
    *,
    pages: Sequence[APIRouter] = (),
    page_uploads: Collection[Route] = (),
    page_bodies: Mapping[Route, BodyRule] = MappingProxyType({}),
) -> FastAPI:
    """Return the ASGI application for a plant that is in the database already.

    pages: routes for people beside those of the API.  page_uploads: those of them that take files.
    page_bodies: what those take that take no small form.
    """
    app = FastAPI(
        title="StatorWatch",
        version=version("statorwatch"),
        description=DESCRIPTION,
        openapi_url=None,  # FastAPI would write the document anew at each request; see _complete_document
        docs_url=None,  # its page would run a script from the internet, with the rights of this API
        redoc_url=None,
        generate_unique_id_function=_operation_id,
    )
    app.state.context = context
    api = APIRouter(dependencies=[Depends(refuse_unknown_parameters)])
    for part in (
        motors,
        conditions,
        notes,
        undo,
        planned_stops,
        inspections,
        rotor_and_supply,
        tracking,
        classification,
        load,
        integrations,
        baselines,
        starts,
        relay_reports,
        measurements,
        relays,
        alarm_lists,
        alarm_people,
        event_reports,
        recordings,
        samples,
        diagnoses,
        job_runners,
        deletions,
        exports,
        reports,
        notifications,
        audit_trail,
        backups,
        sessions,
        second_factor,
        passkeys,
        tokens,
        users,
    ):
        api.include_router(part.router)
    if context.settings.access.oidc is not None:
        _add_sign_on(api, context.settings.access.oidc)
    app.include_router(api, prefix=PREFIX)
    app.include_router(probes.router)
    for page in pages:
        app.include_router(page, include_in_schema=False)
    problems.install(app)
    settings = context.settings
    max_upload_bytes = settings.max_upload_bytes
    arrivals = Arrivals(grace_s=settings.transfer_timeout_s, least_rate=settings.min_upload_rate)
    uploads = frozenset((method, PREFIX + path) for method, path in recordings.UPLOAD_ROUTES)
    own = dict.fromkeys(relay_reports.REPORT_ROUTES, REPORT) | dict(inspections.PICTURE_ROUTES)
    rules = {(method, PREFIX + path): rule for (method, path), rule in own.items()}
    app.add_middleware(LongLists)
    app.add_middleware(
        BodyLimits,
        upload_routes=uploads | set(page_uploads),
        body_rules=rules | dict(page_bodies),
        max_upload_bytes=max_upload_bytes,
        arrivals=arrivals,
    )
    app.add_middleware(Gate, context=context, needs=_needs(app))
    hosts = [str(settings.bind_address), *settings.allowed_hosts]
    app.add_middleware(HostGuard, hosts=hosts)
    limits = dict.fromkeys(uploads, max_upload_bytes) | {
        route: rule.most_bytes for route, rule in rules.items()
    }
    _complete_document(app, limits)
    return app


def _operation_id(route: APIRoute) -> str:
    """Return what clients that are made from the document call the route."""
    return route.name


def _add_sign_on(api: APIRouter, settings: OidcSettings) -> None:
    """Add the routes of a login at an OpenID provider. Raises ImportError without the extra `oidc`."""
    from service.access.oidc import OpenIdProvider
    from service.api.access.sign_on import sign_on_router

    api.include_router(sign_on_router(OpenIdProvider(settings)))


def _needs(app: FastAPI) -> RouteNeeds:
    """Return what each route needs of its caller."""
    return RouteNeeds(
        (method, route.path, requirement_of(route.dependencies))
        for route in iter_route_contexts(app.routes)
        if isinstance(route.original_route, APIRoute) and route.path is not None
        for method in route.methods or ()
    )


def _complete_document(app: FastAPI, limits: Mapping[Route, int]) -> None:
    """Add the schema that the routes' error responses point to, and the largest body of each route."""

    def openapi() -> dict[str, object]:
        if not app.openapi_schema:
            schema = get_openapi(
                title=app.title, version=app.version, description=app.description, routes=app.routes
            )
            problem = problems.Problem.model_json_schema(ref_template="#/components/schemas/{model}")
            schemas = schema.setdefault("components", {}).setdefault("schemas", {})
            schemas.update(problem.pop("$defs", {}))
            schemas["Problem"] = problem
            document(schema["paths"], limits)
            app.openapi_schema = schema
        return app.openapi_schema

    @cache
    def written() -> bytes:
        return json.dumps(openapi()).encode()

    @app.get(
        f"{PREFIX}/openapi.json",
        include_in_schema=False,
        dependencies=[require(Permission.ACCOUNT), Depends(refuse_unknown_parameters)],
    )
    async def get_openapi_document() -> Response:
        return Response(written(), media_type="application/json")

    app.openapi = openapi  # type: ignore[method-assign]  # FastAPI's documented way to extend the schema
