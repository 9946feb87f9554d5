"""The rows of the filled database that are about conditions: every diagnosed recording is observed."""

from collections.abc import Iterator

from sqlalchemy import Connection, text, update

from benchmarks.storage.documents import condition_document
from benchmarks.storage.plant import IDLE, motor_name
from benchmarks.storage.rows import (
    END_NS,
    RECORDING,
    Amounts,
    Row,
    Table,
    id_of,
    motor_of,
    recording_state,
    time_of,
)
from core.units import NANOSECONDS_PER_DAY
from service.storage.models import Base

CHANGED = 50
"""Every 50th observation changed a condition."""
TOLD = 400
"""And after every 400th a person told something of the motor."""

CURVE = '{"first_s":0.01,"step_s":0.02,"current_A":[92.0,40.0,14.5],"voltage_V":[361.0,390.0,399.0]}'

STARTED = 300
"""And every 300th recording is that of a start."""

EVENT = 9
"""Kind of the ids of what people told, beside those of `rows`."""

_OBSERVATION_COLUMNS = (
    "recording_id", "motor", "time_ns", "recorder", "sequence", "voltage_channels", "frequency_hz",
    "positive_voltage_re", "positive_voltage_im", "negative_voltage_re", "negative_voltage_im",
    "zero_voltage_re", "zero_voltage_im", "positive_current_re", "positive_current_im",
    "negative_current_re", "negative_current_im", "zero_current_re", "zero_current_im", "scatter", "cycles",
    "load_level", "state", "kind", "phase", "mu_f", "mu_f_ci95_low", "mu_f_ci95_high", "change",
    "change_ci95_low", "change_ci95_high",
)  # fmt: skip
_CHANGE_COLUMNS = (
    "id", "motor", "time_ns", "recording_id", "event_id", "state", "kind", "phase", "mu_f", "mu_f_ci95_low",
    "mu_f_ci95_high", "change", "change_ci95_low", "change_ci95_high",
)  # fmt: skip
_EVENT_COLUMNS = ("id", "motor", "time_ns", "kind", "reason", "account", "by", "made_ns")

_START_COLUMNS = (
    "recording_id", "motor", "time_ns", "is_from_rest", "acceleration_s", "peak_current_A",
    "crest_current_A", "running_current_A", "lowest_voltage_V", "i2t_A2s", "i2t_over_s", "rated_current_A",
    "rated_voltage_V", "curve",
)  # fmt: skip
_ROTOR_COLUMNS = (
    "recording_id", "motor", "time_ns", "state", "lower_sideband_dB", "upper_sideband_dB", "severity_dB",
    "severity_dB_ci95_low", "severity_dB_ci95_high", "detection_limit_dB", "slip", "load_level", "load_bin",
    "duration_s", "load_oscillation_dB", "reasons", "condition",
)  # fmt: skip
_FIGURE_COLUMNS = (
    "recording_id", "motor", "time_ns", "gap_permeance_ripple", "gap_permeance_ripple_deviation",
    "gap_detection_limit", "gap_lower_sideband_dB", "gap_upper_sideband_dB", "turn_load_torque",
    "turn_load_torque_deviation", "turn_frequency_hz", "air_gap", "swing_load_torque", "swing_noise",
    "swing_frequency_hz", "swing_load_torque_deviation", "swing_detection_limit", "load", "frequency_hz",
    "voltage_unbalance_iec", "voltage_unbalance_nema", "derating", "voltage_deviation", "thd_voltage",
    "harmonic_voltage_factor", "current_unbalance", "thd_current", "active_power_W", "power_factor", "supply",
    "efficiency", "efficiency_ci95_low", "efficiency_ci95_high", "losses_W", "losses_W_ci95_low",
    "losses_W_ci95_high", "output_W", "turns_loss_W", "unbalance_loss_W", "voltage_loss_W", "rotor_loss_W",
    "losses",
)  # fmt: skip
_OUTLINE_COLUMNS = ("recording_id", "motor", "time_ns", "fidelity", "currents_A", "voltages_V")
_STATISTICS_COLUMNS = (
    "motor", "time_ns", "since_ns", "starts", "running_s", "stopped_s", "mean_current_A", "peak_current_A",
    "peak_start_current_A", "longest_start_s", "trips",
)  # fmt: skip

DAYS = f"""
    INSERT INTO condition_days (motor, day_ns, records, mu_f_least, mu_f_mean, mu_f_largest)
    SELECT motor, time_ns - time_ns % {NANOSECONDS_PER_DAY} AS of_day,
        count(*), min(mu_f), avg(mu_f), max(mu_f)
    FROM observations WHERE state IS NOT NULL GROUP BY motor, of_day
"""  # noqa: S608 - the number is our own

HARMONICS = "[1.0,0.001,0.004,0.0,0.03,0.0,0.017,0.0,0.0,0.0,0.006,0.0,0.004,0.0,0.0,0.0,0.002]"
REASONS = '["no asymmetry of the rotor above -52 dB"]'
NO_REASONS = '{"reasons":[]}'
LOSS_DETAILS = (
    '{"load_class":6,"stator_copper_W":43.5,"rotor_copper_W":20.0,"iron_W":27.0,"friction_W":18.0,"stray_W":5.0,'
    '"reasons":[]}'
)
SUPPLY_DETAILS = (
    f'{{"line_voltages_V":[401.0,399.5,396.25],"voltage_harmonics":{HARMONICS},"line_currents_A":[1.5,1.48,1.53],'
    f'"current_harmonics":{HARMONICS},"duration_s":10.0,"reasons":[]}}'
)


def tables(amounts: Amounts) -> Iterator[Table]:
    """Yield the tables about conditions that grow."""
    yield Table("observations", _OBSERVATION_COLUMNS, _observations(amounts))
    yield Table("condition_changes", _CHANGE_COLUMNS, _changes(amounts))
    yield Table("condition_events", _EVENT_COLUMNS, _events(amounts))
    yield Table("starts", _START_COLUMNS, _starts(amounts))
    yield Table("rotor_findings", _ROTOR_COLUMNS, _rotor_findings(amounts))
    yield Table("record_figures", _FIGURE_COLUMNS, _record_figures(amounts))
    yield Table("outlines", _OUTLINE_COLUMNS, _outlines(amounts))
    yield Table("relay_statistics", _STATISTICS_COLUMNS, _relay_statistics(amounts))
    yield Table("relay_events", ("motor", "kind", "time_ns"), _relay_events(amounts))


def judge(connection: Connection) -> None:
    """Give each motor but the idle one a condition, and all motors their days."""
    judge_motors(connection)
    connection.execute(text(DAYS))


def judge_motors(connection: Connection) -> None:
    """Give each motor but the idle one a condition."""
    conditions = Base.metadata.tables["conditions"]
    figures = dict(zip(_CHANGE_COLUMNS[5:], _said(0.012), strict=True))
    connection.execute(
        update(conditions)
        .where(conditions.c.motor != motor_name(IDLE))
        .values(version=1, as_of_ns=END_NS, since_ns=END_NS, document=condition_document(), **figures)
    )


def _observed(amounts: Amounts) -> Iterator[tuple[int, str, int]]:
    """Yield number, motor and time of the recordings that are observed."""
    of = amounts.recordings
    for number in range(of):
        if recording_state(number, of) == "diagnosed":
            motor = motor_name(motor_of(number, of, amounts.motors))
            yield number, motor, time_of(number, of) - 2_000_000_000


def _observations(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        mu_f = number % 997 / 20_000
        yield (
            id_of(RECORDING, number), motor, time_ns, "RELAY 100:1", "abc", "phase", 50.02, 325.0, 1.5, -1.25,
            0.5, 0.1, -0.3, 2.1, -1.3, 0.02, 0.011, 1e-3, 2e-3, 1.2e-8, 12, 0.48, *_said(mu_f),
        )  # fmt: skip


def _changes(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        if number % CHANGED == 0:
            recording = id_of(RECORDING, number)
            yield recording, motor, time_ns, recording, None, *_said(0.01)
        if number % TOLD == 0:
            event = id_of(EVENT, number)
            yield event, motor, time_ns + 1, None, event, *_said(0.01)


def _events(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        if number % TOLD == 0:
            event = id_of(EVENT, number)
            yield event, motor, time_ns + 1, "maintenance", "bearings greased", "ann", "ann", time_ns + 1


def _starts(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        if number % STARTED == 0:
            recording = id_of(RECORDING, number)
            yield (
                recording, motor, time_ns, True, 1.2, 92.0, 131.0, 14.5, 361.0, 9500.0, 1.4, 15.0, 400.0,
                CURVE,
            )  # fmt: skip


def _rotor_findings(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        severity_dB = -70.0 + number % 97 / 10.0
        yield (
            id_of(RECORDING, number), motor, time_ns, "healthy", severity_dB - 4.0, severity_dB - 7.0,
            severity_dB, severity_dB - 5.0, severity_dB + 3.0, -52.0, 0.031, 0.48, number % 12, 10.0, -60.0,
            REASONS, "healthy",
        )  # fmt: skip


def _record_figures(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        ripple, unbalance = number % 83 / 40_000, number % 89 / 10_000
        yield (
            id_of(RECORDING, number), motor, time_ns, ripple, 0.001, 0.0035, -58.0, -61.5, 0.002, 0.001,
            24.25, NO_REASONS, 0.003, 0.0008, 4.125, 0.0006, 0.004, NO_REASONS, 50.02, unbalance, unbalance,
            1.0, -0.003, 0.021, 0.0085, 0.02, 0.035, 612.5, 0.61, SUPPLY_DETAILS,
            0.815, 0.775, 0.8475, 113.5, 93.5, 137.75, 499.0, 0.0, 2.25, -0.5, 0.0, LOSS_DETAILS,
        )  # fmt: skip


def _outlines(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        yield id_of(RECORDING, number), motor, time_ns, 1, "[1.5,1.48,1.53]", "[231.0,230.5,229.0]"


def _relay_statistics(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        if number % TOLD == 0:
            since_ns = time_ns - 30 * NANOSECONDS_PER_DAY
            yield motor, time_ns, since_ns, 17, 432_000.0, 9000.0, 14.2, 19.0, 92.0, 1.3, '{"overcurrent":1}'


def _relay_events(amounts: Amounts) -> Iterator[Row]:
    for number, motor, time_ns in _observed(amounts):
        if number % STARTED == 0:
            yield motor, "start", time_ns


def _said(mu_f: float) -> Row:
    """Return state, kind, phase and levels."""
    is_fault = mu_f > 0.045
    state, kind, phase = ("fault", "shorted-turns", "b") if is_fault else ("healthy", "none", None)
    return state, kind, phase, mu_f, mu_f - 0.001, mu_f + 0.001, mu_f, mu_f - 0.001, mu_f + 0.001
