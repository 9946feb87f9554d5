"""The answers of a motor's latest recordings, kept with their diagnoses."""

from collections.abc import Mapping
from typing import Any, cast

from sqlalchemy import select

from service.storage.models import DiagnosisRow, MotorRow
from service.storage.repository.sessions import Sessions, found


class AnswerRows(Sessions):
    def latest_answers(self, motor: str, *, limit: int) -> tuple[Mapping[str, Any], ...]:
        """Return the answers of a motor's latest recordings of running, oldest first. Raises NotFoundError.

        Those that earlier versions diagnosed have none.
        """
        query = (
            select(DiagnosisRow.document["classification"])
            .where(DiagnosisRow.motor == motor, DiagnosisRow.current, DiagnosisRow.says_nothing.is_(False))
            .order_by(DiagnosisRow.recorded_ns.desc(), DiagnosisRow.id.desc())
            .limit(limit)
        )
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            documents = session.scalars(query).all()
        return tuple(cast(Mapping[str, Any], one) for one in reversed(documents) if one is not None)
