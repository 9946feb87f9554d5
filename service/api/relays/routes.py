"""Relays, their links and what is wrong with them."""

import time
from http import HTTPStatus

from fastapi import APIRouter

from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.alarms.schemas import Alarm
from service.api.context import Context
from service.api.document import Name
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.relays.report_lengths import report_length_of
from service.api.relays.schemas import (
    Acquisition,
    Difference,
    Gateway,
    Ied,
    IedDetails,
    IgnoredFile,
    LinkChange,
    LinkFigures,
    Quarantine,
    ReportLength,
)
from service.storage.records import RelayFindings

router = APIRouter(tags=["relays"])

LATEST_CHANGES = 20
"""So many are shown with the relay itself; all have a route of their own."""


@router.get("/ieds", responses=problems(), dependencies=[require(Permission.VIEW)])
def list_ieds(context: Context, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None) -> Page[Ied]:
    """Return the relays and the state of their links, by name."""
    return page(context.repository.relays(limit=limit, after=decode(cursor, str)), Ied.model_validate)


@router.get("/ieds/{name}", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_ied(context: Context, name: Name) -> IedDetails:
    """Return one relay, with figures and history of its link and its standing alarms."""
    repository = context.repository
    ied = Ied.model_validate(repository.relay(name))
    changes = repository.link_changes(name, limit=LATEST_CHANGES)
    quarantine = repository.quarantine(name)
    findings = repository.relay_findings(name)
    length = report_length_of(context, repository.relay_overview(name))
    return IedDetails(
        **dict(ied),
        gateway=repository.gateway_of(name),
        figures=LinkFigures.model_validate(repository.link_figures(name)),
        changes=[LinkChange.model_validate(change) for change in changes.items],
        quarantine=None if quarantine is None else Quarantine.model_validate(quarantine),
        alarms=[Alarm.model_validate(alarm) for alarm in repository.standing_alarms(name)],
        acquisition=_acquisition(findings),
        report_length=None if length is None else ReportLength.model_validate(length),
        differences=[] if findings is None else [Difference.model_validate(d) for d in findings.differences],
        ignored_files=[]
        if findings is None
        else [IgnoredFile.model_validate(file) for file in findings.ignored_files],
        ignored_files_in_all=0 if findings is None else findings.ignored_in_all,
    )


@router.delete(
    "/ieds/{name}/quarantine",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404),
    dependencies=[require(Permission.RELEASE)],
)
def release_ied(context: Context, name: Name, caller: By) -> None:
    """Visit a relay again that was set aside, with a clean sheet; harmless where it was not."""
    context.repository.release(name, by=caller, now_ns=time.time_ns())


def _acquisition(findings: RelayFindings | None) -> Acquisition | None:
    if findings is None:
        return None
    return Acquisition.model_validate({**findings.acquisition, "found_time": findings.found_ns})


@router.get("/ieds/{name}/link-changes", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_link_changes(
    context: Context, name: Name, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[LinkChange]:
    """Return the changes of a relay's link with their reasons, latest first; the latest thousand are kept."""
    changes = context.repository.link_changes(name, limit=limit, after=decode(cursor, int, str))
    return page(changes, LinkChange.model_validate)


@router.get("/gateways", responses=problems(), dependencies=[require(Permission.VIEW)])
def list_gateways(context: Context) -> Page[Gateway]:
    """Return the processes that visit the relays, on all hosts, by id; always one page."""
    gateways = context.repository.gateways()
    return Page(items=[Gateway.model_validate(gateway) for gateway in gateways], next_cursor=None)
