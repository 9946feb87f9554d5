"""`mcc starts`: the starts of a motor, and why they have changed."""

from itertools import islice

from service.cli.output import failing_clearly
from service.cli.rows import Column, print_rows, require_one_format
from service.client.rest_client import Document, ServiceClient, ServiceError
from service.client.verdicts import local_time, percent

FIELDS = (
    "time", "source", "id", "recording_id", "is_from_rest", "is_reference", "acceleration_s",
    "peak_current_A", "mean_current_A", "running_current_A", "lowest_voltage_V", "i2t_A2s", "from_report",
    "share_of_hot_limit", "starts_within_hour", "starts_allowed", "load_torque_Nm", "load_torque_Nm_ci95",
    "rotor_state", "comparison",
)  # fmt: skip


def show_starts(url: str, motor: str, *, limit: int, as_csv: bool, as_json: bool) -> None:
    """Print the latest starts of a motor, oldest first. Raises CommandError."""
    require_one_format(as_csv=as_csv, as_json=as_json)
    with failing_clearly(ServiceError), ServiceClient(url) as service:
        found = service.list_starts(motor, limit=min(limit, 1000))
        starts = list(islice(found, limit))[::-1]
    columns: dict[str, Column] = {
        "time": lambda one: local_time(one["time"]),
        "run-up s": lambda one: _figure(one["acceleration_s"]),
        "peak A": lambda one: _figure(one["peak_current_A"]),
        "mean A": lambda one: _figure(one["mean_current_A"]),
        "lowest V": lambda one: _figure(one["lowest_voltage_V"]),
        "load N m": lambda one: _figure(one["load_torque_Nm"]),
        "heat %": lambda one: percent(one["share_of_hot_limit"]),
        "against the first starts": _told,
        "source": lambda one: str(one["source"]),
        "recording": lambda one: str(one["recording_id"] or "-"),
    }
    print_rows("starts", starts, FIELDS, columns, as_csv=as_csv, as_json=as_json)


def _figure(value: object) -> str:
    return f"{value:.3g}" if isinstance(value, int | float) else "-"


def _told(start: Document) -> str:
    if start["is_reference"]:
        return "reference"
    match start["comparison"]:
        case {"reasons": [*reasons], "state": str(state)}:
            return "; ".join(map(str, reasons)) or state.replace("-", " ")
        case _:
            return "-"
