"""Gateways' hosts: from a fault until the records of the lost host's relays are stored by others."""

import time
from collections import Counter
from collections.abc import Iterator, Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from benchmarks.takeover.hosts import Fault, Host, Site, freeze_inside_a_transaction, require_once
from mms import Client
from service.plant import Plant
from service.storage.models import DiagnosisRow, GatewayRow, RecordingRow
from testing.service.processes import RELAYS
from testing.waiting import wait_until

START_LIMIT_S = 120.0
LEASES = 4
"""Others take over within so many leases, and a time in which a busy machine does its work."""
WORK_LIMIT_S = 60.0
HOLD_S = 0.05
"""How long the control that triggers a relay is held."""


def take_over_times(site: Site, plant: Plant, repeats: int, command: str) -> Iterator[tuple[Fault, float]]:
    """Yield each fault with the time until a record of the lost host's relays was stored [s].

    command: of `mcc`, what the hosts run.
    Raises AssertionError where a record is lost or comes twice.
    """
    with site.hosts(command) as hosts:
        made: set[tuple[str, str]] = set()
        _wait_for_shares(site, hosts)
        for fault in Fault:
            for number in range(repeats):
                lost = hosts[number % len(hosts)]
                yield fault, _take_over(site, plant, lost, fault)
                _wait_for_shares(site, hosts)
                made |= site.plant.records()
                _require_each_once(site, made)


def _take_over(site: Site, plant: Plant, lost: Host, fault: Fault) -> float:
    wait_until(lambda: _stored(site).keys() >= site.plant.records(), "all records", WORK_LIMIT_S)
    relays = _relays_of(site, lost)
    before = site.plant.records()
    if fault is Fault.FROZEN_IN_TRANSACTION:  # it renews its leases
        own = select(GatewayRow.id).where(GatewayRow.process_id.in_(lost.process_ids))
        freeze_inside_a_transaction(site.engine, lost, own)
    else:
        lost.strike(fault)
    began_s = time.monotonic()
    try:
        for relay in relays:
            _record(plant, relay, site)
        wanted = {record for record in site.plant.records() - before if record[0] in relays}
        within_s = LEASES * site.lease_s + WORK_LIMIT_S
        wait_until(lambda: not wanted.isdisjoint(_stored(site)), f"one of {wanted}", within_s)
        took_s = time.monotonic() - began_s
        wait_until(lambda: _stored(site).keys() >= wanted, f"all of {wanted}", within_s)
    finally:
        lost.mend(fault)
    return took_s


def _wait_for_shares(site: Site, hosts: Sequence[Host]) -> None:
    """Wait until the hosts and the service share the relays, from when on none changes hands."""
    fair = len(RELAYS) // (len(hosts) + 1)
    wait_until(
        lambda: (
            all(len(_relays_of(site, host)) == fair for host in hosts)
            and len(site.repository.held_relays()) == len(RELAYS)
        ),
        f"{fair} relays at each host",
        START_LIMIT_S,
    )


def _relays_of(site: Site, host: Host) -> list[str]:
    """The relays whose leases the host's gateway holds."""
    own = set(host.process_ids)
    gateways = {one.id for one in site.repository.gateways() if one.process_id in own}
    return [
        one for one in sorted(site.repository.held_relays()) if site.repository.gateway_of(one) in gateways
    ]


def _record(plant: Plant, relay: str, site: Site) -> None:
    """Have a relay make a record, as a client that is none of the hosts; wait until it is there."""
    before = len(list(site.plant.events(relay).glob("*.CFG")))
    control = plant.relay(relay).trigger_control
    assert control is not None
    address = site.plant.address(relay)
    with Client.connect(address.host, address.port) as client:
        client.operate(control, True)  # noqa: FBT003 - the value of a control
        time.sleep(HOLD_S)
        client.operate(control, False)  # noqa: FBT003
    wait_until(lambda: len(list(site.plant.events(relay).glob("*.CFG"))) > before, f"a record of {relay}")


def _stored(site: Site) -> "Counter[tuple[str, str]]":
    """(relay, record) of the recordings whose files are stored, with the number of them."""
    stored = select(RecordingRow.ied, RecordingRow.name).where(RecordingRow.digest.is_not(None))
    with Session(site.engine) as session:
        return Counter((str(relay), name) for relay, name in session.execute(stored))


def _require_each_once(site: Site, made: set[tuple[str, str]]) -> None:
    """Raise AssertionError unless each record of the relays is stored once, and diagnosed once."""
    wait_until(lambda: _diagnosed(site).keys() >= made, "the diagnoses of all records", WORK_LIMIT_S)
    for what, found in (("stored", _stored(site)), ("diagnosed", _diagnosed(site))):
        require_once(f"record {what}", made | found.keys(), found)


def _diagnosed(site: Site) -> "Counter[tuple[str, str]]":
    """(relay, record) of the recordings that are diagnosed, with the number of their diagnoses."""
    diagnosed = select(RecordingRow.ied, RecordingRow.name).join(
        DiagnosisRow, DiagnosisRow.recording_id == RecordingRow.id
    )
    with Session(site.engine) as session:
        return Counter((str(relay), name) for relay, name in session.execute(diagnosed))
