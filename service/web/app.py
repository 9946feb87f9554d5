"""Puts the pages on top of the API."""

from importlib.resources.abc import Traversable

from fastapi import FastAPI

from service.api.app import create_app
from service.api.context import ApiContext
from service.web.alarms import routes as alarms
from service.web.audit import routes as audit
from service.web.fleet import routes as fleet
from service.web.help.pages import FOLDER, HelpPages
from service.web.html_problems import HtmlProblems
from service.web.live import routes as live
from service.web.motor import inspections, relay_reports
from service.web.motor import pages as motor_pages
from service.web.motor import routes as motor
from service.web.notifications import routes as notifications
from service.web.people import account, passkeys, second_factor
from service.web.people import routes as people
from service.web.plant import routes as plant
from service.web.recording import routes as recording
from service.web.relays import routes as relays
from service.web.reports import routes as reports
from service.web.security_headers import SecurityHeaders
from service.web.sign_in import login_link
from service.web.sign_in import routes as sign_in
from service.web.starts import routes as starts
from service.web.static_files import StaticFiles, static_tree

ROOMS = (
    sign_in,
    login_link,
    alarms,
    relays,
    reports,
    live,
    fleet,
    recording,
    people,
    account,
    second_factor,
    passkeys,
    audit,
    plant,
    notifications,
    motor_pages,
    motor,
    relay_reports,
    inspections,
    starts,
)
"""Each has the routes of some pages in its `router`."""


def create_site(context: ApiContext, *, help_folder: Traversable = FOLDER) -> FastAPI:
    """Return the API and the pages as one ASGI application, for a plant that is in the database already.

    help_folder: where the help pages are, as MkDocs made them.
    """
    app = create_app(
        context,
        pages=[room.router for room in ROOMS],
        page_uploads=recording.UPLOADS,
        page_bodies=relay_reports.BODIES | inspections.BODIES,
    )
    live.install_live(app, context)
    fleet.install_fleet(app, context)
    app.add_middleware(HelpPages, folder=help_folder)
    app.add_middleware(HtmlProblems)
    app.add_middleware(StaticFiles, tree=static_tree())
    app.add_middleware(SecurityHeaders, proxy=context.settings.access.proxy)
    return app


def end_streams(app: FastAPI) -> None:
    """End the streams of open pages, which would else last until the service is forced to stop."""
    live.live_of(app).bus.close()
