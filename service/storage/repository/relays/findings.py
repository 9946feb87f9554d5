"""What was found at the relays: what is used of each, and what is not as its SCL promises."""

from service.storage.models import IedRow, RelayFindingsRow
from service.storage.records import RelayFindings
from service.storage.repository.sessions import Sessions, found, record_of


class FindingsRows(Sessions):
    def note_findings(self, *findings: RelayFindings) -> None:
        """Replace what was found at each relay before by these findings; later ones replace earlier ones.

        Raises NotFoundError.
        """
        with self._write() as session:
            for each in findings:
                found(session, IedRow, each.ied, "relay")
                session.merge(
                    RelayFindingsRow(
                        ied=each.ied,
                        found_ns=each.found_ns,
                        acquisition=each.acquisition,
                        differences=list(each.differences),
                        ignored_files=list(each.ignored_files),
                        ignored_in_all=each.ignored_in_all,
                    )
                )

    def relay_findings(self, relay: str) -> RelayFindings | None:
        """Return what was found at a relay; None before the first visit. Raises NotFoundError."""
        with self._read() as session:
            found(session, IedRow, relay, "relay")
            row = session.get(RelayFindingsRow, relay)
            return None if row is None else record_of(RelayFindings, row)
