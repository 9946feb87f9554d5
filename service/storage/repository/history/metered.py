"""Currents, voltages and power that a relay meters, over time, as the load of its motor follows from them."""

from typing import Final

from sqlalchemy import select

from core.load.metered import Metered
from service.plant import AveragingStep, MeteredQuantity
from service.storage.models import MeasurementRow, MotorRow
from service.storage.repository.sessions import Sessions, found

_QUANTITIES: Final = (
    MeteredQuantity.IA,
    MeteredQuantity.IB,
    MeteredQuantity.IC,
    MeteredQuantity.VAB,
    MeteredQuantity.VBC,
    MeteredQuantity.VCA,
    MeteredQuantity.POWER,
    MeteredQuantity.FREQUENCY,
)


class MeteredRows(Sessions):
    def metered(self, motor: str, step: AveragingStep, *, from_ns: int, to_ns: int) -> tuple[Metered, ...]:
        """Return the means of a motor's metering, oldest first, from_ns <= time < to_ns.

        Raises NotFoundError.
        """
        table = MeasurementRow.__table__.c
        query = (
            select(MeasurementRow.time_ns, *(table[quantity.value] for quantity in _QUANTITIES))
            .where(MeasurementRow.motor == motor, MeasurementRow.step_s == step.value)
            .where(MeasurementRow.time_ns >= from_ns, MeasurementRow.time_ns < to_ns)
            .order_by(MeasurementRow.time_ns)
        )
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            rows = session.execute(query).all()
        return tuple(
            Metered(time_ns, _three(ia, ib, ic), _three(vab, vbc, vca), power_W, frequency_hz)
            for time_ns, ia, ib, ic, vab, vbc, vca, power_W, frequency_hz in rows
        )


def _three(a: float | None, b: float | None, c: float | None) -> tuple[float, float, float] | None:
    return None if a is None or b is None or c is None else (a, b, c)
