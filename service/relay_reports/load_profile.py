"""Load profiles (LDP): their rows become measured values of the motor."""

from collections.abc import Mapping
from typing import Final

from core.relay_reports import LoadRows, read_load_profile
from service.plant import MeteredQuantity, PowerUnit
from service.relay_reports.brought import LATER, BroughtReport
from service.relay_reports.errors import RefusedReportError
from service.relay_reports.kept import KeptLoad, LeftOutColumn
from service.storage import Repository
from service.storage.records import Sample

_PLAIN: Final[Mapping[str, MeteredQuantity]] = {
    "IA_MAG": MeteredQuantity.IA,
    "IB_MAG": MeteredQuantity.IB,
    "IC_MAG": MeteredQuantity.IC,
    "VAB_MAG": MeteredQuantity.VAB,
    "VBC_MAG": MeteredQuantity.VBC,
    "VCA_MAG": MeteredQuantity.VCA,
    "VA_MAG": MeteredQuantity.VA,
    "VB_MAG": MeteredQuantity.VB,
    "VC_MAG": MeteredQuantity.VC,
    "PF": MeteredQuantity.POWER_FACTOR,
    "FREQ": MeteredQuantity.FREQUENCY,
}
"""Columns in A, V and Hz."""
_POWERS: Final = {"P": MeteredQuantity.POWER, "Q": MeteredQuantity.REACTIVE_POWER}
_SIGNED: Final = {*_POWERS.values(), MeteredQuantity.POWER_FACTOR}
_FACTORS: Final = {PowerUnit.W: 1.0, PowerUnit.KW: 1000.0}
_NO_UNIT: Final = "no report tells its unit: say power_unit, W or kW"
_NO_PLACE: Final = "it is none of the quantities that the service keeps"


def keep_load_profile(repository: Repository, motor: str, brought: BroughtReport) -> KeptLoad:
    """Keep the rows of a load profile. Raises ReportError, RefusedReportError."""
    rows = read_load_profile(brought.text, date_order=brought.date_order)
    factors, left_out = _columns(rows, brought.power_unit)
    if rows.values and not factors:
        raise RefusedReportError(
            "heading", f"expected IA_MAG or another quantity, found {', '.join(rows.values)}"
        )
    _refuse_negative(rows, factors)
    times_ns = [brought.utc_ns(time_ns) for time_ns in rows.time_ns.tolist()]
    if times_ns and all(map(brought.is_ahead, times_ns)):
        raise RefusedReportError("", f"none of {len(times_ns)} rows can be kept: {LATER}")
    samples = [
        Sample(
            motor,
            time_ns,
            {
                quantity.value: factor * float(rows.values[label][place])
                for label, (quantity, factor) in factors.items()
            },
        )
        for place, time_ns in enumerate(times_ns)
    ]
    counts = repository.add_load_profile(motor, samples, by=brought.by, now_ns=brought.now_ns)
    return KeptLoad(
        added=counts.added,
        known=counts.known,
        not_over=counts.not_over,
        quantities=[quantity.value for quantity, _ in factors.values()],
        left_out=left_out,
    )


def _columns(
    rows: LoadRows, unit: PowerUnit | None
) -> tuple[dict[str, tuple[MeteredQuantity, float]], list[LeftOutColumn]]:
    """Return quantity and factor of each column that is kept, and why others are not."""
    kept, left_out = {}, []
    for label in rows.values:
        if label in _PLAIN:
            kept[label] = (_PLAIN[label], 1.0)
        elif label in _POWERS and unit is not None:
            kept[label] = (_POWERS[label], _FACTORS[unit])
        else:
            left_out.append(LeftOutColumn(column=label, reason=_NO_UNIT if label in _POWERS else _NO_PLACE))
    return kept, left_out


def _refuse_negative(rows: LoadRows, columns: Mapping[str, tuple[MeteredQuantity, float]]) -> None:
    for label, (quantity, _) in columns.items():
        lowest = float(rows.values[label].min(initial=0.0))
        if quantity not in _SIGNED and lowest < 0.0:
            raise RefusedReportError(label, f"expected 0 or more, found {lowest:g}")
