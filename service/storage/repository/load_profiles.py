"""Load profiles of relays: they become measured values where the service has measured nothing itself."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.audit.actions import AuditAction
from service.plant import AveragingStep
from service.storage.engine import one_at_a_time
from service.storage.models import MeasurementRow, MotorRow
from service.storage.records import ImportedLoad, Sample
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.measurements import (
    AVERAGING,
    average_until,
    end_of_averages,
    insert_means,
    insert_samples,
)
from service.storage.repository.sessions import Sessions, found
from service.storage.states import MeasurementSource

_QUARTER_NS = AveragingStep.QUARTER_HOUR.value * NANOSECONDS_PER_SECOND


class LoadProfileRows(Sessions):
    def add_load_profile(
        self, motor: str, rows: Sequence[Sample], *, by: Actor | None, now_ns: int
    ) -> ImportedLoad:
        """Keep the rows of a relay's load profile, with their means.

        A quarter of an hour of which anything is known stays as it is: the service polls more often than a
        relay writes such rows, and a profile that is brought again adds nothing. One that is not over has no
        mean yet, and the service may still poll in it. Raises NotFoundError.
        """
        latest = {row.time_ns: replace(row, motor=motor) for row in rows}
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            one_at_a_time(session.connection(), AVERAGING)
            # What is polled has its means before: those are made from the latest one on.
            for finer, step_s in pairwise(step.value for step in AveragingStep):
                average_until(session, finer, step_s, now_ns=now_ns)
            end_ns = end_of_averages(AveragingStep.QUARTER_HOUR.value, now_ns)
            over = [row for time_ns, row in sorted(latest.items()) if time_ns < end_ns]
            known = _known_quarters(session, motor, over)
            added = [row for row in over if row.time_ns // _QUARTER_NS not in known]
            if added:
                insert_samples(session, added, MeasurementSource.LOAD_PROFILE)
                from_ns = added[0].time_ns // _QUARTER_NS * _QUARTER_NS
                to_ns = (added[-1].time_ns // _QUARTER_NS + 1) * _QUARTER_NS
                for finer, step_s in pairwise(step.value for step in AveragingStep):
                    insert_means(session, finer, step_s, from_ns, to_ns, of_load_profile=motor)
            counts = ImportedLoad(len(added), len(over) - len(added), len(latest) - len(over))
            if added and by is not None:
                after = {"report": "LDP", "rows": len(added)}
                note_change(
                    session, by, AuditAction.REPORT_IMPORTED, ("motor", motor), now_ns=now_ns, after=after
                )
            return counts


def _known_quarters(session: Session, motor: str, rows: Sequence[Sample]) -> set[int]:
    """Return the quarters of an hour, by their number since 1970, that have a mean."""
    if not rows:
        return set()
    times = session.scalars(
        select(MeasurementRow.time_ns).where(
            MeasurementRow.motor == motor,
            MeasurementRow.step_s == AveragingStep.QUARTER_HOUR.value,
            MeasurementRow.time_ns >= rows[0].time_ns - _QUARTER_NS,
            MeasurementRow.time_ns <= rows[-1].time_ns,
        )
    )
    return {time_ns // _QUARTER_NS for time_ns in times}
