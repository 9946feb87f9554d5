"""What was found at the relays: what is used of each, and what is not as its SCL promises."""

from sqlalchemy import select

from service.storage.models import IedRow, RelayFindingsRow
from service.storage.records import RelayFindings
from service.storage.repository.sessions import Sessions, found, record_of


class FindingsRows(Sessions):
    def note_findings(self, *findings: RelayFindings) -> None:
        """Replace what was found at each relay before by these findings; later ones replace earlier ones.

        Raises NotFoundError.
        """
        with self._write() as session:
            relays = {each.ied for each in findings}
            known = set(session.scalars(select(IedRow.name).where(IedRow.name.in_(relays))))
            earlier = select(RelayFindingsRow).where(RelayFindingsRow.ied.in_(relays))
            rows = {row.ied: row for row in session.scalars(earlier)}
            for each in findings:
                if each.ied not in known:
                    found(session, IedRow, each.ied, "relay")
                row = rows.setdefault(each.ied, RelayFindingsRow(ied=each.ied))
                row.found_ns, row.acquisition = each.found_ns, each.acquisition
                row.differences, row.ignored_files = list(each.differences), list(each.ignored_files)
                row.ignored_in_all = each.ignored_in_all
            session.add_all(rows.values())

    def relay_findings(self, relay: str) -> RelayFindings | None:
        """Return what was found at a relay; None before the first visit. Raises NotFoundError."""
        with self._read() as session:
            found(session, IedRow, relay, "relay")
            row = session.get(RelayFindingsRow, relay)
            return None if row is None else record_of(RelayFindings, row)
