"""Which gateway visits which relay: one lease a relay, for as long as its gateway's counter goes up.

No clock is compared with that of another host. A gateway increases its heartbeat counter. Whoever has seen a
counter stand still for the time of a lease, by its own monotonic clock, may declare that gateway dead. A
gateway that could not increase its counter for four fifths of that time, by its own boot clock, ends itself
(service/collector/gateway/lease_watchdog.py).
"""

from collections.abc import Collection
from dataclasses import dataclass

from sqlalchemy import delete, func, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from service.storage.errors import LeaseLostError
from service.storage.models import GatewayRow, IedRow, LeaseRow
from service.storage.records import GatewayEntry
from service.storage.repository.relays.links import change_links, locked_relays
from service.storage.repository.sessions import Sessions
from service.storage.states import LinkState

GATEWAY_GONE = "service restarting: another gateway visits this relay soon"

_LEASES = select(LeaseRow.ied, LeaseRow.gateway)


@dataclass(frozen=True, slots=True)
class Share:
    """What a gateway holds now, what of it others should have instead, and every gateway's counter."""

    held: frozenset[str]
    surplus: frozenset[str]
    heartbeats: dict[str, int]


class LeaseRows(Sessions):
    """Leases are renewed in time, or lost: what is written here goes ahead of what else is."""

    def register_gateway(self, gateway: str, *, host: str, process_id: int, now_ns: int) -> None:
        """Register a gateway that starts and holds nothing.

        The caller knows that whatever had its id before is dead.
        """
        with self._write(ahead=True) as session:
            _end(session, gateway, now_ns)
            session.add(
                GatewayRow(id=gateway, host=host, process_id=process_id, heartbeats=0, started_ns=now_ns)
            )

    def share_relays(self, gateway: str, relays: Collection[str], *, most: int, problem: str | None) -> Share:
        """Renew the gateway's counter and take what is free of these relays, up to its fair share.

        problem: what does not work in the gateway, for others to see; None while all does.
        Raises LeaseLostError where the gateway was declared dead: it holds nothing any more.
        """
        with self._write(ahead=True) as session:
            own = session.get(GatewayRow, gateway)
            if own is None:
                raise LeaseLostError(gateway)
            own.heartbeats += 1
            own.problem = problem
            rows = session.scalars(select(GatewayRow)).all()
            in_service = set(session.scalars(select(IedRow.name).where(IedRow.in_service)))
            wanted = sorted(in_service.intersection(relays))
            leases = dict(session.execute(_LEASES).all())  # no objects: there may be a thousand
            held = {relay for relay, holder in leases.items() if holder == gateway}
            fair = min(most, -(-len(wanted) // len(rows)))
            free = [relay for relay in wanted if relay not in leases]
            for relay in free[: max(0, fair - len(held))]:
                if _take(session, relay, gateway):
                    held.add(relay)
            staying = sorted(held.intersection(wanted))[:fair]
            return Share(
                frozenset(held), frozenset(held.difference(staying)), {r.id: r.heartbeats for r in rows}
            )

    def give_back_relays(self, gateway: str, relays: Collection[str]) -> None:
        """End the leases of relays that are not visited any more."""
        with self._write(ahead=True) as session:
            session.execute(delete(LeaseRow).where(LeaseRow.gateway == gateway, LeaseRow.ied.in_(relays)))

    def end_gateway(self, gateway: str, *, now_ns: int, heartbeats: int | None = None) -> bool:
        """Free the relays of a gateway that is dead; with `heartbeats`, only if that is still its counter.

        Returns False where there was nothing to end.
        """
        with self._write(ahead=True) as session:
            row = session.get(GatewayRow, gateway)
            if row is None or heartbeats not in (None, row.heartbeats):
                return False
            _end(session, gateway, now_ns)
            return True

    def gateways(self) -> tuple[GatewayEntry, ...]:
        """Return all gateways, by id, with the number of relays each holds."""
        query = (
            select(GatewayRow, func.count(LeaseRow.ied))
            .outerjoin(LeaseRow, LeaseRow.gateway == GatewayRow.id)
            .group_by(GatewayRow.id)
            .order_by(GatewayRow.id)
        )
        with self._read() as session:
            return tuple(
                GatewayEntry(row.id, row.host, row.process_id, row.started_ns, relays, row.problem)
                for row, relays in session.execute(query)
            )

    def held_relays(self) -> frozenset[str]:
        """Return the relays that some gateway holds."""
        with self._read() as session:
            return frozenset(session.scalars(select(LeaseRow.ied)))

    def heartbeats(self) -> dict[str, int]:
        """Return every gateway's counter."""
        with self._read() as session:
            return {row.id: row.heartbeats for row in session.scalars(select(GatewayRow))}

    def gateway_of(self, relay: str) -> str | None:
        """Return the gateway that holds a relay; None while none does."""
        with self._read() as session:
            row = session.get(LeaseRow, relay)
            return None if row is None else row.gateway


def require_lease(session: Session, relay: str, gateway: str) -> None:
    """Raise LeaseLostError unless the gateway holds the relay."""
    row = session.get(LeaseRow, relay)
    if row is None or row.gateway != gateway:
        raise LeaseLostError(gateway, relay)


def _take(session: Session, relay: str, gateway: str) -> bool:
    """Take a relay's lease, and tell whether that worked.

    In a database with several writers another gateway may be faster.
    """
    try:
        with session.begin_nested():
            session.add(LeaseRow(ied=relay, gateway=gateway))
    except IntegrityError:
        return False
    return True


def _end(session: Session, gateway: str, now_ns: int) -> None:
    """End a gateway's leases. Its links are locked first: a note of the gateway comes before or too late."""
    held = select(LeaseRow.ied).where(LeaseRow.gateway == gateway)
    relays = locked_relays(session, IedRow.name.in_(held))
    known = [row for row in relays if row.link_state not in (LinkState.UNKNOWN, LinkState.QUARANTINED)]
    change_links(session, known, LinkState.UNKNOWN, GATEWAY_GONE, now_ns)
    session.execute(delete(LeaseRow).where(LeaseRow.gateway == gateway))
    session.execute(delete(GatewayRow).where(GatewayRow.id == gateway))
