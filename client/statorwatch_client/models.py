# Generated from the service's OpenAPI document by `make client`. Do not edit.
"""The documents of the API."""

from __future__ import annotations

from typing import Any, Literal, NotRequired, TypeAlias, TypedDict


class AcknowledgementRequest(TypedDict):
    """
    Several alarms that somebody takes notice of, by their ids.
    """

    comment: NotRequired[str | None]
    alarms: list[str]


AlarmEvent: TypeAlias = Literal[
    "raised",
    "cleared",
    "superseded",
    "reopened",
    "acknowledged",
    "acknowledgement-undone",
    "shelved",
    "unshelved",
    "shelving-ended",
    "suppressed",
    "unsuppressed",
    "taken-out-of-service",
    "put-back-in-service",
]


AlarmKind: TypeAlias = Literal[
    "condition-fault",
    "condition-forecast",
    "condition-watch",
    "rotor-fault",
    "rotor-watch",
    "supply-fault",
    "supply-watch",
    "uneven-air-gap",
    "inefficient",
    "parameter-drift",
    "hard-starts",
    "changed-starts",
    "motor-tripped",
    "missing-data",
    "link-down",
    "site-lost",
    "alarm-flood",
    "clock-off",
    "time-zone",
    "quarantined",
    "relay-differs",
    "file-refused",
    "file-too-large",
    "file-unsteady",
    "daily-limit",
    "disk-filling",
    "certificate-end",
    "backup-overdue",
    "password-guessing",
    "forged-tokens",
    "owner-locked",
]


class AlarmLinks(TypedDict):
    """
    Where to look further: addresses of this API. null: the alarm is not about one.
    """

    motor: str | None
    ied: str | None
    recording: str | None
    part_of: str | None


AlarmPriority: TypeAlias = Literal["critical", "high", "medium", "low"]


AlarmState: TypeAlias = Literal[
    "normal",
    "unacknowledged",
    "acknowledged",
    "returned-unacknowledged",
    "shelved",
    "suppressed",
    "out-of-service",
]


class AlarmsOfDay(TypedDict):
    """
    How often alarms called for somebody on a day of UTC.
    """

    date: str
    calls: int


AuditAction: TypeAlias = Literal[
    "recording-requested",
    "recording-uploaded",
    "report-imported",
    "recording-deleted",
    "recording-deletion-undone",
    "diagnosis-requested",
    "baseline-set",
    "baseline-deleted",
    "note-added",
    "note-withdrawn",
    "reference-restarted",
    "inspection-added",
    "inspection-withdrawn",
    "stop-planned",
    "stop-cancelled",
    "quarantine-released",
    "alarm-acknowledged",
    "alarm-acknowledgement-undone",
    "alarm-shelved",
    "alarm-unshelved",
    "alarm-taken-out-of-service",
    "alarm-put-back-in-service",
    "channel-tested",
    "notification-retried",
    "logged-in",
    "login-failed",
    "login-locked",
    "login-refused",
    "request-refused",
    "token-refused",
    "session-refused",
    "login-link-made",
    "logged-out",
    "sessions-ended",
    "user-added",
    "user-changed",
    "user-unlocked",
    "user-deleted",
    "password-set",
    "second-factor-begun",
    "second-factor-added",
    "second-factor-removed",
    "second-factor-reset",
    "recovery-codes-made",
    "recovery-code-used",
    "token-added",
    "token-revoked",
    "tokens-revoked",
    "service-started",
    "service-ended",
    "settings-changed",
    "plant-changed",
    "parameters-changed",
    "retention-applied",
    "backup-made",
    "backup-restored",
    "plant-purged",
]


class AuditEntry(TypedDict):
    """
    Who did what, from where, to what, and the values before and after.

    hash: follows from all else, so also from `previous`, the hash of the entry before. roles: of the actor.
    """

    number: int
    time: str
    actor: str
    origin: str
    roles: list[str]
    action: str
    subject_kind: str
    subject: str
    before: dict[str, Any] | None
    after: dict[str, Any] | None
    previous: str
    hash: str


class AuditHead(TypedDict):
    """
    The last entry of the trail: whoever keeps it elsewhere can tell later whether the trail was replaced.

    number: 0 where the trail has no entries.
    """

    number: int
    hash: str


class AuditState(TypedDict):
    """
    The last entry, and `forwarded`, the last one that the syslog server has; null where none is set.
    """

    number: int
    hash: str
    forwarded: int | None


AveragingStep: TypeAlias = Literal[0, 60, 900]


BackupState: TypeAlias = Literal["running", "verified", "failed"]


class BaselineDoubt(TypedDict):
    """
    What spoke against a recording as one of a healthy motor when it was chosen.
    """

    recording_id: str
    doubt: str


class BaselineRequest(TypedDict):
    """
    The recordings that stand for a motor's healthy condition.

    reason: why they do; needed where a recording is in doubt.
    """

    on_behalf_of: NotRequired[str | None]
    recording_ids: list[str]
    reason: NotRequired[str | None]


class BodyUploadRecording(TypedDict):
    motor: str
    files: list[str]


Cause: TypeAlias = Literal[
    "healthy",
    "stator-shorted-turns",
    "rotor-asymmetry",
    "high-resistance-connection",
    "supply-unbalance",
    "voltage-channel",
    "current-channel",
    "load-pulsation",
    "eccentricity",
    "load-change",
    "wrong-parameters",
    "load-behind-relay",
    "another-asymmetry",
]


ChangeState: TypeAlias = Literal["as-before", "changed", "not-told-apart", "unknown"]


ClockQuality: TypeAlias = Literal["synchronised", "not-synchronised", "failed"]


class ConditionReference(TypedDict):
    """
    What the motor was like before any change, as learnt from `records` records.

    complete: whether changes are looked for. standing: level that the asymmetry from the first record on
    would mean if it were shorted turns (..._ci95: 95 % interval, ..._deviation: standard deviation,
    ..._phase_probabilities: of the phases a, b and c, ..._axis_deg: axis of the coils, as below,
    ..._score: standard deviations beyond what the sensors leave). detectable: step of the level that would be
    seen within ten records in nine of ten cases. from_bus: whether other motors of the bus took part in
    judging it.
    accepted: whether a person said that the motor is healthy as it is; accepted_level: level of the shorted
    turns that the records showed until then, in accepted_phase, or null.
    """

    records: int
    complete: bool
    standing: float | None
    standing_ci95: tuple[float, float] | None
    standing_deviation: float | None
    standing_phase: Literal["a", "b", "c"] | None
    standing_phase_probabilities: NotRequired[tuple[float, float, float] | None]
    standing_axis_deg: NotRequired[float | None]
    standing_score: float | None
    detectable: float | None
    since: str | None
    from_bus: bool
    accepted: bool
    accepted_level: NotRequired[float | None]
    accepted_level_ci95: NotRequired[tuple[float, float] | None]
    accepted_phase: NotRequired[Literal["a", "b", "c"] | None]


DateOrder: TypeAlias = Literal["MDY", "YMD", "DMY"]


DeletedBy: TypeAlias = Literal["person", "retention"]


class DiagnosisRequest(TypedDict):
    """
    How to diagnose: the method and the fault model.

    A search goes with a model of the thesis: with `coil`, `split-winding` is taken. The evidence goes with
    `coil`: with another model, `hybrid` is taken.
    """

    method: NotRequired[
        Literal["evidence", "hybrid", "hcpa", "genetic", "pattern-search", "pattern-search-lhs"]
    ]
    model: NotRequired[Literal["coil", "split-winding", "shorted-winding"]]


DifferenceKind: TypeAlias = Literal[
    "logical-device", "logical-node", "data-object", "data-set", "report-control"
]


DriftCause: TypeAlias = Literal["winding-hot", "ratio", "magnetising", "leakage", "rotor"]


class EccentricityFinding(TypedDict):
    """
    What a record tells of the air gap; figures are None where it cannot tell them.

    Parameters
    ----------
    permeance_ripple : float or None
        Amplitude of the relative ripple of the gap's permeance, once a turn.
    standard_deviation : float or None
        Its standard deviation: noise, and the parameters of the model.
    detection_limit : float or None
        Ripple that nine of ten such records show.
    lower_sideband_dB, upper_sideband_dB : float or None
        Current at f - f_r and f + f_r as measured, over the fundamental [dB].
    load_torque : float or None
        Torque of the load that swings once a turn, its amplitude over rated torque.
    load_torque_deviation : float or None
        Its standard deviation, over rated torque.
    rotation_frequency_hz : float or None
        Frequency f_r at which the lines stand [Hz].
    reasons : tuple of str
        What limits the figures, in words.
    """

    permeance_ripple: float | None
    standard_deviation: float | None
    detection_limit: float | None
    lower_sideband_dB: float | None
    upper_sideband_dB: float | None
    load_torque: float | None
    load_torque_deviation: float | None
    rotation_frequency_hz: float | None
    reasons: list[str]


class EventImport(TypedDict):
    """
    What became of a sequence of events.

    added: starts, stops and trips that were not known.  ahead: those whose time is yet to come.
    left_out: elements that tell none of these, the first fifty.
    """

    added: int
    known: int
    ahead: int
    left_out: list[str]


EventKind: TypeAlias = Literal[
    "recorder-changed", "parameters-edited", "rewound", "maintenance", "reference-restarted", "note"
]


class Explanation(TypedDict):
    """
    Causes that together explain all that is measured, "healthy" for none.
    """

    causes: list[str]
    probability: float


class FactorCode(TypedDict):
    """
    A code of the authenticator app that is being set up.
    """

    code: str


Fault: TypeAlias = Literal["changed", "removed", "inserted", "reordered", "cut-off", "replaced"]


class FittedParameters(TypedDict):
    """
    The hypothesis that explains the currents best; `recordings/{recording_id}/model` draws it.

    It is not the verdict: mu_f may lie within chance, or below zero. leakage: of the shorted turns, 1 where
    they have it to themselves. axis_rad: from the phase's axis to the coil's, positive as the field turns.
    linkage: field that a turn of the coil links, over that of the phase's mean turn.
    """

    mu_f: float
    theta_f: Literal[0, 1, 2]
    load_level: float
    time_offset_s: float
    leakage: float
    axis_rad: float
    linkage: float


class Forecast(TypedDict):
    """
    Days from the latest record until the level reaches `limit`: likely not before, middle, likely by then.

    One chance in ten each that it is earlier than the first or later than the last. `days` is null where the
    records show no trend towards the limit. chances: probability that the level has reached the limit 0,
    0.25, 0.5, 1, 2, 3, 5, 7, 10, 14, 21, 30, 45, 60, 90, 120, 180, 270, 365, 545, 730, 1095, 1825 and 3650
    days after that record; null where too few records tell.
    """

    limit: float | None
    days: tuple[float, float, float] | None
    chances: NotRequired[list[float] | None]


Format: TypeAlias = Literal["csv", "xlsx", "parquet"]


class Gateway(TypedDict):
    """
    A process that visits relays: `relays` is how many it holds at present.

    problem: what does not work in it at present; null while all does.
    """

    id: str
    host: str
    process_id: int
    started_time: str
    relays: int
    problem: str | None


class Hypothesis(TypedDict):
    """
    One cause that the record's phasors were weighed for; the causes of a record exclude one another.

    log_likelihood_ratio: log of the likelihood of the record with this cause over that of a healthy motor.
    figure: what was measured of it, in words.
    """

    cause: Cause
    probability: float
    log_likelihood_ratio: float
    figure: str


class IgnoredFile(TypedDict):
    """
    A file of the relay's events directory that is not taken; `name` as printable text.
    """

    name: str
    reason: str


class Indicators(TypedDict):
    """
    Model-free figures of the line quantities, for comparison beside the fit.
    """

    current_unbalance: float
    voltage_unbalance: float
    negative_sequence_current_A: float
    negative_sequence_impedance_ohm: float
    park_axis_ratio: float
    park_axis_angle_deg: float


InspectionOutcome: TypeAlias = Literal["confirmed", "other-cause", "nothing-found"]


class InspectionWithdrawal(TypedDict):
    """
    Why an inspection was wrong.
    """

    reason: str


class Integration(TypedDict):
    """
    A gateway to another system, by its kind in the settings.

    restarts: how often it ended since the service started. problem: null while all works in it.
    """

    kind: str
    process_id: int | None
    restarts: int
    problem: str | None


class JobRunner(TypedDict):
    """
    A process that has diagnoses made: `workers` at once, `jobs` of them at present.
    """

    id: str
    host: str
    process_id: int
    workers: int
    started_time: str
    jobs: int


JobState: TypeAlias = Literal["queued", "running", "done", "failed"]


Kind: TypeAlias = Literal[
    "none",
    "shorted-turns",
    "voltage-channel",
    "current-channel",
    "connection",
    "supply",
    "parameters",
    "rotor",
    "starts",
    "thermal",
    "air-gap",
    "asymmetry",
    "other-load",
    "unclear",
]


class LeftOutColumn(TypedDict):
    """
    A column of a load profile that cannot be kept, and why.
    """

    column: str
    reason: str


class LeftOutStart(TypedDict):
    """
    A start of a relay's report that cannot be kept, and why.
    """

    time: str
    reason: str


class Likelihood(TypedDict):
    """
    How likely one cause is, alone or with another.

    log_likelihood_ratio: log of the likelihood of all figures with this cause alone, over that of a healthy
    motor; null where nothing is known of it, and `figure` then says why.
    """

    cause: str
    probability: float
    log_likelihood_ratio: float | None
    figure: str


class LikelyCause(TypedDict):
    """
    Causes that together explain all that is measured, "healthy" for none, and their probability.
    """

    causes: list[str]
    words: str
    probability: float


class LimitHours(TypedDict):
    """
    How long something was beyond a limit. longest_hours: without a break. worst: value furthest beyond.

    known_hours: time of which the quantity is known.
    """

    name: str
    limit: float
    below: bool
    hours: float
    known_hours: float
    longest_hours: float
    worst: float | None


class LinkFigures(TypedDict):
    """
    What went over a relay's link since the relay is known.

    round_trip_s: duration of its latest answer. received_bytes: of files. report_gaps: how often reports were
    lost, which costs time and no recording: the relay's directory is what counts.
    """

    round_trip_s: float | None
    connections: int
    received_bytes: int
    reports: int
    report_gaps: int


LinkState: TypeAlias = Literal["unknown", "up", "down", "quarantined"]


class LoadClass(TypedDict):
    """
    Hours and energy in a class of torque, over the rated one; the last class has no upper end.
    """

    from_level: float
    to_level: float | None
    hours: float
    energy_kWh: float


class LoadEfficiency(TypedDict):
    """
    The efficiency at one load.

    Parameters
    ----------
    load_class : int
        Tenth of the rated power at the shaft.
    records : int
        Records that tell it.
    efficiency : float
        Median of theirs.
    efficiency_ci95 : tuple of float
        Medians of the ends of their 95 % intervals: what is not known of a motor is so in each record.
    """

    load_class: int
    records: int
    efficiency: float
    efficiency_ci95: tuple[float, float]


class LoadImport(TypedDict):
    """
    What became of the rows of a load profile.

    added: rows that became measured values of these quantities.  known: of quarters of an hour that have
    measured values already.  not_over: of one that is not over, to be brought later, or ahead of the time.
    """

    added: int
    known: int
    not_over: int
    quantities: list[str]
    left_out: list[LeftOutColumn]


class LoginRequest(TypedDict):
    """
    Who logs in. code: of their authenticator app, or a recovery code, where they have a second factor.

    passkey: in place of the code, what a browser's `PublicKeyCredential.toJSON()` gives, as text.
    """

    name: str
    password: str
    code: NotRequired[str | None]
    passkey: NotRequired[str | None]


class LoginWays(TypedDict):
    """
    How one logs in here. oidc: where a browser begins to log in at the plant's identity provider.

    notice: on the use of the service. Who logs in acknowledges it.
    """

    password: bool
    oidc: str | None
    notice: str | None


LossCause: TypeAlias = Literal[
    "shorted turns", "unbalance of the supply", "voltage off its rated value", "faulty cage"
]


class LossFigures(TypedDict):
    """
    Losses of a motor in one record; figures are None where it cannot tell them.

    Parameters
    ----------
    efficiency : float or None
        Power at the shaft over power drawn.
    efficiency_ci95 : tuple of float or None
        Its 95 % interval: resistances, slip, and the losses that no current tells.
    output_W : float or None
        Power at the shaft [W].
    load_class : int or None
        Tenth of the rated power at the shaft, 0 to 11: efficiencies compare within one.
    losses_W : float or None
        All losses [W].
    losses_W_ci95 : tuple of float or None
        Their 95 % interval [W].
    stator_copper_W, rotor_copper_W : float or None
        In the windings of the stator with their shorted turns, and in the rotor [W].
    iron_W, friction_W, stray_W : float or None
        In the core, by friction and windage, and stray load losses [W].
    turns_loss_W : float or None
        What shorted turns cost; zero where none are found [W].
    unbalance_loss_W : float or None
        What the unbalance of the supply costs [W].
    voltage_loss_W : float or None
        What it costs that the voltage is not the rated one; below zero where that saves [W].
    rotor_loss_W : float or None
        What a faulty cage costs; zero where none is found [W].
    reasons : tuple of str
        What limits the figures, in words.
    """

    efficiency: float | None
    efficiency_ci95: tuple[float, float] | None
    output_W: float | None
    load_class: int | None
    losses_W: float | None
    losses_W_ci95: tuple[float, float] | None
    stator_copper_W: float | None
    rotor_copper_W: float | None
    iron_W: float | None
    friction_W: float | None
    stray_W: float | None
    turns_loss_W: float | None
    unbalance_loss_W: float | None
    voltage_loss_W: float | None
    rotor_loss_W: float | None
    reasons: list[str]


MeasurementSource: TypeAlias = Literal["load-profile", "polled"]


class NewPasskey(TypedDict):
    """
    A passkey that was added. recovery_codes: for who had no second factor, shown this once.
    """

    id: str
    label: str
    created_time: str
    used_time: str | None
    recovery_codes: list[str]


class NewPassword(TypedDict):
    """
    Change password for a user.
    """

    password: str


class NewToken(TypedDict):
    """
    A token with its secret, which is shown this once and not kept.
    """

    id: str
    user: str
    label: str
    scope: list[str] | None
    sites: list[str] | None
    parent: str | None
    created_time: str
    expires_time: str | None
    used_time: str | None
    token: str


Explanation1: TypeAlias = list[str]


class NotToldApart(TypedDict):
    """
    Two explanations that are left open, and the records or tests that would tell, the easiest first.
    """

    explanations: list[Explanation1]
    tests: list[str]


class Note(TypedDict):
    """
    What somebody told of a motor, or what its files tell.

    It happened at `time`; the account `by` told it at `made_time`, perhaps for somebody whom it named. The
    condition follows from all but those of kind `note` and those that were withdrawn.
    """

    id: str
    motor: str
    kind: EventKind
    text: str
    by: str
    on_behalf_of: str | None
    time: str
    made_time: str
    withdrawn_time: str | None
    withdrawn_by: str | None
    withdrawn_on_behalf_of: str | None
    withdrawn_reason: str | None


class NoteRequest(TypedDict):
    """
    What a person tells of a motor. `time`: when it happened, by default now.
    """

    on_behalf_of: NotRequired[str | None]
    kind: NotRequired[EventKind]
    text: str
    time: NotRequired[str | None]


class NotificationChannel(TypedDict):
    """
    A channel of the settings.

    receivers: mail addresses; of other kinds, the host, the program or the kind of service. waiting: how many
    messages wait to be sent; given_up: how many were given up and can be tried again.
    """

    name: str
    kind: Literal["mail", "webhook", "syslog", "command", "apprise"]
    receivers: list[str]
    waiting: int
    given_up: int


NotificationKind: TypeAlias = Literal["alarms", "escalation", "digest", "report", "test"]


NotificationState: TypeAlias = Literal["queued", "sending", "sent", "dead", "withdrawn"]


class OneTimeCode(TypedDict):
    """
    A code that stands for the second factor once.
    """

    code: str


Operation: TypeAlias = Literal["running", "not-running", "start", "stop", "trip"]


class OwnPassword(TypedDict):
    """
    The own password, again, for what a session left open must not do.
    """

    password: str


class PageAuditEntry(TypedDict):
    items: list[AuditEntry]
    next_cursor: str | None


class PageGateway(TypedDict):
    items: list[Gateway]
    next_cursor: str | None


class PageIntegration(TypedDict):
    items: list[Integration]
    next_cursor: str | None


class PageJobRunner(TypedDict):
    items: list[JobRunner]
    next_cursor: str | None


class PageNote(TypedDict):
    items: list[Note]
    next_cursor: str | None


class PageNotificationChannel(TypedDict):
    items: list[NotificationChannel]
    next_cursor: str | None


ParameterName: TypeAlias = Literal[
    "stator_resistance_ohm", "rotor_resistance_ohm", "magnetising_inductance_H", "leakage_inductance_H"
]


ParametersSource: TypeAlias = Literal["given", "commissioned", "data-sheet", "typical"]


Part: TypeAlias = Literal[
    "stator",
    "rotor",
    "supply",
    "measurement",
    "starts",
    "thermal",
    "air-gap",
    "parameters",
    "load",
    "efficiency",
]


class PartUntilStop(TypedDict):
    """
    What is known of a part until the planned stop. probability: null where it is not known.

    is_beyond: it is beyond its limit already.
    """

    part: Part
    probability: float | None
    reason: str
    is_beyond: bool


class Passkey(TypedDict):
    """
    A passkey of a user. used_time: when it last let them in.
    """

    id: str
    label: str
    created_time: str
    used_time: str | None


class PasskeyAnswer(TypedDict):
    """
    What a device has made: `PublicKeyCredential.toJSON()`, as text. label: what its owner calls it.
    """

    label: str
    answer: str


class PasskeyOptions(TypedDict):
    """
    What browsers ask a device with: PublicKeyCredentialCreationOptionsJSON, or ...RequestOptionsJSON.

    `PublicKeyCredential.parseCreationOptionsFromJSON` and `parseRequestOptionsFromJSON` read them.
    """

    options: dict[str, Any]


class Passkeys(TypedDict):
    """
    All passkeys of a user.
    """

    items: list[Passkey]


class PasswordChange(TypedDict):
    """
    The own password, old and new.
    """

    old: str
    new: str


Permission: TypeAlias = Literal[
    "view",
    "metrics",
    "trigger",
    "acknowledge",
    "note",
    "release",
    "recordings",
    "configure",
    "notify",
    "account",
    "users",
    "audit",
]


PhaseSequence: TypeAlias = Literal["abc", "acb"]


class Phasor(TypedDict):
    """
    An rms phasor; its angle counts from `reference`, and a positive one leads.
    """

    name: str
    magnitude: float
    angle_deg: float
    unit: str


class Phasors(TypedDict):
    """
    Phasors of the cycle around a time, and their symmetrical components.

    at_s: middle of the cycle, in seconds after the first sample. components: 1 is the system that turns as
    the supply does, 2 the one that turns against it, 0 what all phases have in common, where it was measured.
    frequency_is_assumed: none could be found, and the rated one was taken.
    """

    recording_id: str
    at_s: float
    frequency_hz: float
    frequency_is_assumed: bool
    sequence: PhaseSequence
    reference: str
    phases: list[Phasor]
    components: list[Phasor]
    voltage_unbalance: float | None
    current_unbalance: float | None
    active_power_W: float | None
    power_factor: float | None


PowerUnit: TypeAlias = Literal["W", "kW"]


class PulsationFinding(TypedDict):
    """
    The strongest swing of the load's torque; figures are None where a record cannot tell them.

    Parameters
    ----------
    load_torque : float or None
        Its amplitude over rated torque.
    noise : float or None
        What noise makes of it, rms, over rated torque.
    frequency_hz : float or None
        Its frequency [Hz].
    load_torque_deviation : float or None
        Standard deviation of the amplitude: noise, and the parameters of the model; the inertia is taken as
        the motor's file has it.
    detection_limit : float or None
        Swing that nine of ten such records show, over rated torque.
    reasons : tuple of str
        What limits the figures, in words.
    """

    load_torque: float | None
    noise: float | None
    frequency_hz: float | None
    load_torque_deviation: float | None
    detection_limit: float | None
    reasons: list[str]


class QualityFinding(TypedDict):
    """
    One check of the quality gate: the figure it measured, its limit and what that means.

    One that passed and has a message is a warning, such as of a file that departs from its standard.
    """

    name: str
    value: float
    limit: float
    unit: str
    passed: bool
    message: str


Quantity: TypeAlias = Literal["current", "phase_voltage", "line_voltage", "other"]


class Quarantine(TypedDict):
    """
    A relay set aside until `until_time`, or back since then and not trusted yet.

    times: how often in a row; 0 where it is one of several relays of which one crashed a gateway.
    """

    reason: str
    times: int
    since_time: str
    until_time: str


class RecordLimit(TypedDict):
    """
    How many records of that time lay beyond a limit. records: that tell the quantity. worst: largest.
    """

    name: str
    limit: float
    records: int
    beyond: int
    share: float | None
    worst: float | None


class RecordedStarts(TypedDict):
    """
    The starts of a motor from which its parameters can be estimated: how many, and the latest one's time.

    advice: the command that does it; null where the motor's parameters were estimated already.
    """

    number: int
    latest_time: str
    advice: str | None


class RecordingFile(TypedDict):
    name: str
    size_bytes: int
    sha256: str


RecordingRequestOrigin: TypeAlias = Literal["request", "schedule"]


RecordingRequestState: TypeAlias = Literal[
    "requested", "triggered", "recorded", "fetched", "diagnosed", "failed", "skipped"
]


RecordingSource: TypeAlias = Literal["relay", "upload", "joined"]


RecordingState: TypeAlias = Literal["announced", "fetched", "diagnosed", "rejected", "failed"]


class RecordingWanted(TypedDict):
    """
    What is to be recorded. seconds: so much as a series of recordings; null for one.
    """

    seconds: NotRequired[float | None]


class RecoveryCodes(TypedDict):
    """
    Codes that stand for the second factor, each of them once. They are not kept here.
    """

    recovery_codes: list[str]


class Refusal(TypedDict):
    """
    An alarm that could not be acknowledged, and why.
    """

    alarm: str
    detail: str


RelayEventKind: TypeAlias = Literal["start", "stop", "trip"]


class RelayStatistics(TypedDict):
    """
    What the relay's latest statistics report tells, and what the service counted in the same time.

    counted_...: null where the report does not tell since when. known_hours: of that time, whether the motor
    ran. remarks: where both disagree, and the likely reason.
    """

    time: str
    since_time: str | None
    running_hours: float | None
    standing_hours: float | None
    starts: int | None
    mean_current_A: float | None
    peak_current_A: float | None
    peak_start_current_A: float | None
    longest_start_s: float | None
    trips: dict[str, int]
    counted_starts: int | None
    counted_running_hours: float | None
    known_hours: float | None
    remarks: list[str]


class Remark(TypedDict):
    """
    What somebody says who does something about an alarm; nothing needs to be said.
    """

    comment: NotRequired[str | None]


ReportFormat: TypeAlias = Literal["pdf", "xlsx"]


ReportKind: TypeAlias = Literal["MSR", "LDP", "MOT", "SER"]


class ReportLength(TypedDict):
    """
    How long a relay's event reports are, by its latest record, and how much of it is before the trigger.

    cycles: of the motor's rated frequency. longest_cycles: what its family allows; null where that is not
    known. advice: what to set in the relay for longer records, and for series of them that are joined.
    """

    duration_s: float
    pre_trigger_s: float
    cycles: float
    longest_cycles: int | None
    advice: list[str]


ReportOutcome: TypeAlias = Literal["added", "joined", "known"]


class RestartRequest(TypedDict):
    """
    Why the motor counts as healthy as it is. `time`: from when on, by default now.
    """

    on_behalf_of: NotRequired[str | None]
    reason: str
    time: NotRequired[str | None]


Role: TypeAlias = Literal["VIEWER", "OPERATOR", "ENGINEER", "SECADM", "SECAUD"]


class RotorLoadBin(TypedDict):
    """
    The records of one tenth of the rated load, 0 to 11, with the median severity of its first ones.
    """

    bin: int
    records: int
    baseline_dB: float | None


RotorState: TypeAlias = Literal["healthy", "watch", "fault", "unsupported"]


class RotorTrendPoint(TypedDict):
    """
    What one recording of a motor shows of its rotor's cage. It never says how many bars are broken.

    lower_sideband_dB, upper_sideband_dB: currents at (1 - 2s) f and (1 + 2s) f as measured, over the
    fundamental. severity_dB: asymmetry of the rotor, without what load and inertia do to the sidebands
    (..._ci95: 95 % interval). detection_limit_dB: severity that nine of ten such recordings show. load_bin:
    tenth of 1.2 times the rated load, 0 to 11. duration_s: what was examined. load_oscillation_dB: torque of
    the load that swings at 2 s f, over the rated one.
    """

    time: str
    recording_id: str
    state: RotorState
    lower_sideband_dB: float | None
    upper_sideband_dB: float | None
    severity_dB: float | None
    severity_dB_ci95: tuple[float, float] | None
    detection_limit_dB: float | None
    slip: float | None
    load_level: float | None
    load_bin: int | None
    duration_s: float
    load_oscillation_dB: float | None
    reasons: list[str]


class ShelvingRequest(TypedDict):
    """
    What ends the shelving: a time, or growth of the alarm's value by so much; the first of both.
    """

    comment: NotRequired[str | None]
    until: NotRequired[str | None]
    growth: NotRequired[float | None]


class Site(TypedDict):
    name: str
    description: str


class SpectralLine(TypedDict):
    """
    A line to look for: where it lies, what makes it, and how strong it is in each phase (rms).
    """

    label: str
    meaning: str
    frequency_hz: float
    amplitude_A: tuple[float, float, float]
    level_dB: float


class Spectrum(TypedDict):
    """
    The spectrum of the line currents under a Hann window, up to 25 times the supply's.

    Levels are beside the strongest line; those below -120 dB are -120. Of lines that are too many, the
    strongest of each interval is given. resolution_hz: nearer lines run into one. slip: from the speed that
    the diagnosis found; null without. seconds_for_sidebands: how long a recording has to be to tell the
    sidebands of broken bars from the supply's line.
    """

    recording_id: str
    first_s: float
    last_s: float
    supply_hz: float
    resolution_hz: float
    slip: float | None
    seconds_for_sidebands: float | None
    frequency_hz: list[float]
    a_dB: list[float]
    b_dB: list[float]
    c_dB: list[float]
    lines: list[SpectralLine]


class SpeedAlternative(TypedDict):
    """
    The speed if the rotor has so many bars.

    Parameters
    ----------
    rotor_bars : int
        Number of bars.
    speed_rpm : float
        Speed of the shaft [rpm].
    speed_rpm_ci95 : tuple of float
        Its 95 % interval, if the number is right [rpm].
    """

    rotor_bars: int
    speed_rpm: float
    speed_rpm_ci95: tuple[float, float]


SpeedSource: TypeAlias = Literal["current", "model"]


SpeedState: TypeAlias = Literal["seen", "alternatives", "not-seen"]


StartCause: TypeAlias = Literal["supply", "load", "rotor", "warmth"]


class StartChange(TypedDict):
    """
    One figure beside the reference: its value, that of the reference, and the change with its interval.

    change: a share of the reference; of the load, of the rated torque.
    """

    value: float
    reference: float
    change: float
    ci95: tuple[float, float]


class StartComparison(TypedDict):
    """
    How starts differ from the reference, and why.

    causes: those that are told. possible: those that are not told apart. voltage_effect, load_effect: shares
    by which voltage or load alone makes the run-up longer, ends of the 95 % interval.
    """

    state: ChangeState
    causes: list[StartCause]
    possible: list[StartCause]
    changes: dict[Literal["acceleration", "voltage", "load", "rotor", "warmth"], StartChange]
    voltage_effect: tuple[float, float] | None
    load_effect: tuple[float, float] | None
    reasons: list[str]


class StartCurve(TypedDict):
    """
    Rms current and line voltage over one cycle or several, from the switching on.
    """

    first_s: float
    step_s: float
    current_A: list[float]
    voltage_V: list[float] | None


class StartParametersDetails(TypedDict):
    """
    Parameters by this start; those without an interval were held at the motor's.
    """

    values: dict[str, float]
    ci95: dict[str, tuple[float, float]]
    load_level: float
    load_level_ci95: tuple[float, float] | None
    load_law: str
    residual_share: float
    warnings: list[str]


class StartSidebandDetails(TypedDict):
    """
    The rotor's asymmetry by the lower sideband's path through the start.
    """

    state: RotorState
    severity_dB: float | None
    severity_dB_ci95: tuple[float | None, float] | None
    detection_limit_dB: float | None
    stretches: int
    reasons: list[str]


StartSource: TypeAlias = Literal["recording", "report"]


class StartStressDetails(TypedDict):
    """
    Heating of the start against what the rotor withstands, hot and cold.
    """

    hot_limit_A2s: float | None
    cold_limit_A2s: float | None
    share_of_hot: float | None
    share_of_cold: float | None
    source: str
    starts_per_hour: int | None


class StartSummary(TypedDict):
    """
    A start. Its figures are defined in docs/reference/operations.md.

    source: what tells of it. recording_id: null for a start that the relay's report alone tells. from_report:
    figures that the recording does not show, and the relay's report of the same start tells.
    mean_current_A: root of the mean square over the acceleration time.
    share_of_hot_limit: I2t over what the rotor withstands from running temperature. starts_within_hour: in
    the hour that ends with this start; starts_allowed: what the motor file allows.
    comparison: null for the starts of the reference, and for reported ones beside a recorded reference.
    """

    id: str
    source: StartSource
    recording_id: str | None
    time: str
    is_from_rest: bool
    is_reference: bool
    acceleration_s: float | None
    peak_current_A: float
    mean_current_A: float | None
    crest_current_A: float
    running_current_A: float | None
    lowest_voltage_V: float | None
    i2t_A2s: float
    i2t_over_s: float
    from_report: list[str]
    share_of_hot_limit: float | None
    starts_within_hour: int
    starts_allowed: int | None
    mean_torque_Nm: float | None
    load_torque_Nm: float | None
    load_torque_Nm_ci95: tuple[float, float] | None
    rotor_state: RotorState | None
    comparison: StartComparison | None


class StartTorqueDetails(TypedDict):
    """
    Torque of the air gap and speed over the synchronous one, from the switching on, and the load.
    """

    first_s: float
    step_s: float
    torque_Nm: list[float]
    speed: list[float | None]
    rated_torque_Nm: float
    impulse_Nms: float
    mean_torque_Nm: float
    torque_at_rated_voltage_Nm: float
    momentum_Nms: float | None
    momentum_tolerance: float
    load_torque_Nm: float | None
    load_torque_Nm_ci95: tuple[float, float] | None
    running_torque_Nm: float | None


State: TypeAlias = Literal["healthy", "watch", "fault", "unknown"]


class StateTimeline(TypedDict):
    """
    A state recorded beside the samples, by its changes; `is_cut` where it has more.
    """

    name: str
    begins_with: bool
    changes_s: list[float]
    is_cut: bool


class States(TypedDict):
    """
    The states of a recording, in the file's order; times are seconds after the first sample.
    """

    recording_id: str
    duration_s: float
    states: list[StateTimeline]


class StatisticsImport(TypedDict):
    """
    Whether the statistics of a motor were kept; they are where they were not known.
    """

    time: str
    since_time: str | None
    added: bool


class Status(TypedDict):
    """
    Whether the service runs, or its parts work.
    """

    status: Literal["ok", "ready"]
    parts: NotRequired[dict[str, str]]


StopOf: TypeAlias = Literal["motor", "site"]


class StopRequest(TypedDict):
    """
    When something stops.
    """

    time: str


class SupplyFigures(TypedDict):
    """
    Figures of the supply and of what the motor draws from it, over one recording.

    Harmonics are those of the line voltage, and of the line current, that is distorted most. They have as
    many orders as the sampling tells, 25 at most. Figures of the currents are None, and their harmonics
    empty, where no current flows.

    Parameters
    ----------
    frequency_hz : float
        Mean frequency of the supply [Hz].
    line_voltages_V : tuple of float
        Rms values of the fundamentals of v_ab, v_bc, v_ca [V].
    voltage_unbalance_iec : float
        |V2| / |V1| (IEC 61000-4-30, 5.7).
    voltage_unbalance_nema : float
        Largest deviation of a line voltage from their mean, over the mean (NEMA MG-1, 14.36).
    derating : float or None
        Factor of the rated power that the unbalance leaves (NEMA MG-1, 14.36); None above 5 %, where NEMA
        gives none and advises against running the motor.
    voltage_deviation : float
        Mean line voltage over rated voltage, minus 1.
    thd_voltage : float
        Total harmonic distortion of the voltage, over the fundamental (IEC 61000-4-7).
    harmonic_voltage_factor : float
        HVF (NEMA MG-1, 30.1.2.1): odd orders from 5 on, without multiples of 3, squares over the order.
    voltage_harmonics : tuple of float
        Orders 1, 2, 3 ... of the voltage, over the fundamental.
    line_currents_A : tuple of float or None
        Rms values of the fundamentals of i_a, i_b, i_c [A].
    current_unbalance : float or None
        |I2| / |I1|.
    thd_current : float or None
        Total harmonic distortion of the current, over the fundamental.
    current_harmonics : tuple of float
        Orders 1, 2, 3 ... of the current, over the fundamental.
    active_power_W : float or None
        Mean of the instantaneous power [W].
    power_factor : float or None
        Active power over effective apparent power (IEEE Std 1459, 3.2.2.8).
    duration_s : float
        Length of what was measured [s].
    reasons : tuple of str
        What limits the figures, in words.
    """

    frequency_hz: float
    line_voltages_V: tuple[float, float, float]
    voltage_unbalance_iec: float
    voltage_unbalance_nema: float
    derating: float | None
    voltage_deviation: float
    thd_voltage: float
    harmonic_voltage_factor: float
    voltage_harmonics: list[float]
    line_currents_A: tuple[float, float, float] | None
    current_unbalance: float | None
    thd_current: float | None
    current_harmonics: list[float]
    active_power_W: float | None
    power_factor: float | None
    duration_s: float
    reasons: list[str]


class SupplyTrendPoint(TypedDict):
    """
    What one recording of a motor shows of its supply, and of what the motor draws from it.

    voltage_unbalance_iec: negative over positive sequence. voltage_unbalance_nema: largest deviation of a
    line voltage from their mean, over the mean. derating: share of the rated power that the unbalance leaves
    (NEMA MG-1); null above 5 %, where NEMA gives none. voltage_deviation: mean over rated, minus 1.
    harmonic_voltage_factor: HVF of NEMA MG-1. ..._harmonics: orders 1, 2, 3 ... over the fundamental, of the
    line that is distorted most. What is of the currents is null, or empty, where none flows.
    """

    time: str
    recording_id: str
    frequency_hz: float
    line_voltages_V: tuple[float, float, float]
    voltage_unbalance_iec: float
    voltage_unbalance_nema: float
    derating: float | None
    voltage_deviation: float
    thd_voltage: float
    harmonic_voltage_factor: float
    voltage_harmonics: list[float]
    line_currents_A: tuple[float, float, float] | None
    current_unbalance: float | None
    thd_current: float | None
    current_harmonics: list[float]
    active_power_W: float | None
    power_factor: float | None
    duration_s: float
    reasons: list[str]


class SwingTrendPoint(TypedDict):
    """
    What one recording of a motor shows of its air gap, and of a load that swings.
    """

    time: str
    recording_id: str
    eccentricity: EccentricityFinding
    pulsation: PulsationFinding


class ThermalState(TypedDict):
    """
    Rises above the ambient temperature, between bounds, of a usual motor with such currents.

    winding_rise_K, frame_rise_K: as if the motor had stood, and had run at rated current, where nothing is
    known. from_resistance_K: how much hotter the winding is than in the record of reference_time, by its
    resistance (..._ci95: 95 % interval); reasons: why that is not told. relay_capacity_used: of the relay's
    thermal element, over the value at which it trips, between the same bounds; null where the motors file has
    no [thermal].
    """

    winding_rise_K: tuple[float, float] | None
    frame_rise_K: tuple[float, float] | None
    from_resistance_K: float | None
    from_resistance_K_ci95: tuple[float, float] | None
    record_time: str | None
    reference_time: str | None
    reasons: list[str]
    relay_capacity_used: tuple[float, float] | None


class Token(TypedDict):
    """
    A secret of a user for a program, without the secret. scope: null for all that the user may.

    sites: where it holds, of the user's; null for all of them.
    parent: the token that asked for this one, and with which it ends; null where a person did.
    """

    id: str
    user: str
    label: str
    scope: list[str] | None
    sites: list[str] | None
    parent: str | None
    created_time: str
    expires_time: str | None
    used_time: str | None


Site1: TypeAlias = str


class TokenRequest(TypedDict):
    """
    What a new token is for. scope: the permissions it has, by default all of who asks.

    sites: where it holds, by default at all of who asks.
    expires_time: by default as late as the settings, and the token that asks, let it.
    """

    label: str
    scope: NotRequired[list[Permission] | None]
    sites: NotRequired[list[Site1] | None]
    expires_time: NotRequired[str | None]


class ToldAlarm(TypedDict):
    """
    An alarm as a message told it: what happened to it, and what it was about.
    """

    id: str
    event: str
    kind: str
    priority: str
    motor: str | None
    ied: str | None
    subject: str


class TotpProposal(TypedDict):
    """
    A secret for an authenticator app. uri: the same as the app reads it from a picture.
    """

    secret: str
    uri: str


class TrackedChange(TypedDict):
    """
    Change of one parameter and its 95 % interval, fractions; null before there is a reference.
    """

    change: float | None
    change_ci95: tuple[float, float] | None


class TrackedTrendPoint(TypedDict):
    """
    The changes of a motor's parameters after one of its recordings.
    """

    time: str
    recording_id: str
    stator_resistance: TrackedChange
    rotor_resistance: TrackedChange
    magnetising_inductance: TrackedChange
    leakage_inductance: TrackedChange


TrackingState: TypeAlias = Literal["steady", "drifting", "undetermined"]


TriggerAction: TypeAlias = Literal["set-reset", "pulse"]


class UndoRequest(TypedDict):
    """
    Alarms whose acknowledgement was a mistake.
    """

    alarms: list[str]


class UntilStop(TypedDict):
    """
    Whether a motor holds until its planned stop, from what is seen of it today.

    of: whether the stop is the motor's own or its site's. probability: that no part passes its limit before;
    0 where one is beyond it already, null where nothing can be said: `reasons` say why. likely_until: until
    then the probability is 90 % and more; null where it is not known, or beyond ten years.
    """

    stop: str
    of: StopOf
    probability: float | None
    likely_until: str | None
    parts: list[PartUntilStop]
    reasons: list[str]


Urgency: TypeAlias = Literal["today", "within-days", "within-weeks", "next-stop", "none"]


class User(TypedDict):
    """
    Somebody who may log in. has_password: whether with a password; subject: with an identity provider.

    sites: where the roles hold; null: at all of them.
    has_second_factor: whether their password lets nobody in alone.
    locked_until_time: none of their logins is tried before from some address, because too many failed.
    password_set_by: who else gave them their password, until they change it.
    """

    name: str
    full_name: str | None
    roles: list[Role]
    sites: list[str] | None
    disabled: bool
    has_password: bool
    has_second_factor: bool
    subject: str | None
    created_time: str
    password_set_time: str | None
    password_set_by: str | None
    last_login_time: str | None
    last_login_origin: str | None
    locked_until_time: NotRequired[str | None]


class UserChange(TypedDict):
    """
    What is to be changed of a user; what is left out, or null, stays.

    sites: where the roles hold. all_sites: they hold everywhere.
    """

    full_name: NotRequired[str | None]
    roles: NotRequired[list[Role] | None]
    sites: NotRequired[list[Site1] | None]
    all_sites: NotRequired[bool]
    disabled: NotRequired[bool | None]


class UserRequest(TypedDict):
    """
    A new user, who changes the password first. Without one nobody can log in as them.

    The role SECAUD is given by the owner of the service's files alone. sites: where the roles hold, by
    default at all of them.
    """

    name: str
    full_name: NotRequired[str | None]
    roles: list[Role]
    sites: NotRequired[list[Site1] | None]
    password: NotRequired[str | None]


Verdict: TypeAlias = Literal["healthy", "watch", "fault", "undiagnosable"]


class WaveformChannel(TypedDict):
    """
    Smallest and largest sample of each interval, in `unit`; null where the recorder missed them all.

    Figures have seven digits.
    """

    name: str
    quantity: Quantity
    phase: str | None
    unit: str
    minimum: list[float | None]
    maximum: list[float | None]


WindingKind: TypeAlias = Literal["lap", "concentric"]


class Withdrawal(TypedDict):
    """
    Why a note was wrong.
    """

    on_behalf_of: NotRequired[str | None]
    reason: str


class FieldError(TypedDict):
    """
    What is wrong with one part of a request; `location` is the way to it, "query.limit".
    """

    location: str
    message: str


class Problem(TypedDict):
    """
    RFC 9457 problem details.

    errors: what is wrong with which part of the request. parts: of the service, for readiness.
    """

    type: NotRequired[str]
    title: str
    status: int
    detail: str
    instance: str
    errors: NotRequired[list[FieldError] | None]
    parts: NotRequired[dict[str, str] | None]


class Account(TypedDict):
    """
    Who asks, and what they may do. way: how they showed who they are.

    password_set_by: who else gave them the password of this session; they change it before they do anything.
    sites: where the roles hold; null: at all of them.
    second_factor: "missing" where a role needs one and there is none; then one may but set it up.
    recovery_codes_left: that were not used.
    """

    name: str
    full_name: str | None
    roles: list[Role]
    sites: list[str] | None
    permissions: list[Permission]
    way: Literal["session", "token", "proxy", "none"]
    password_set_by: str | None
    second_factor: Literal["none", "missing", "set-up"]
    recovery_codes_left: int


class Acquisition(TypedDict):
    """
    What the service uses of a relay to have its recordings; null what it does not offer.

    asked: whether the relay itself was asked at `found_time`, or its SCL is taken at its word. trigger: the
    control that makes a record; trigger_action: set and reset, or a pulse that falls by itself.
    records_told_by: what tells of a new record. text_reports: those that the relay lists, and the service
    reads; empty until it has looked. overridden: what the motors file decides. remarks: what
    cannot be had of it, and what is used instead.
    """

    found_time: str
    asked: bool
    trigger: str | None
    trigger_action: TriggerAction | None
    control_model: str | None
    record_made: str | None
    record_number: str | None
    records_told_by: Literal["buffered-report", "unbuffered-report", "polling"]
    report_control: str | None
    events_directory: str | None
    text_reports: NotRequired[list[str]]
    overridden: list[str]
    remarks: list[str]


class Alarm(TypedDict):
    """
    What somebody has to look after; its cause stands while `cleared_time` is null.

    state: what people and the plant's design have made of it. site, ied, motor: null where it is not about
    one. subject: the record or file it is about, as printable text, empty where it is about the relay; of a
    motor's condition (`condition-...`), its cause. cause, consequence: of all of its kind, in a sentence.
    advice: what to do. recording: the one that shows it.
    value: how bad the cause is, where it can grow; seen_value: when somebody acknowledged or shelved it.
    raised_time: the latest; raises: how often. changed_...: the latest change of the state, by whom and with
    which comment. shelved_until, shelved_above: the time and the value that end the shelving.
    suppressed_because: why the plant's design suppresses it. part_of: the alarm that tells it with others.
    links: addresses of its motor, relay, recording and of that alarm.
    """

    id: str
    site: str | None
    ied: str | None
    motor: str | None
    kind: AlarmKind
    priority: AlarmPriority
    state: AlarmState
    standing: bool
    subject: str
    reason: str
    cause: str
    consequence: str
    advice: str
    recording: str | None
    value: float | None
    seen_value: float | None
    raised_time: str
    raises: int
    cleared_time: str | None
    changed_time: str
    changed_by: str
    comment: str | None
    shelved_until: str | None
    shelved_above: float | None
    suppressed_because: str | None
    part_of: str | None
    links: AlarmLinks


class AlarmCause(TypedDict):
    """
    A cause of alarms, and how often it called.
    """

    site: str | None
    ied: str | None
    motor: str | None
    kind: AlarmKind
    subject: str
    calls: int


class AlarmChange(TypedDict):
    """
    One thing that happened to an alarm; `sequence` goes up with each, of all alarms.
    """

    sequence: int
    time: str
    event: AlarmEvent
    before: AlarmState
    after: AlarmState
    by: str
    comment: str | None


class AlarmFigures(TypedDict):
    """
    Key figures of the alarms between two times.

    days: how often alarms called for somebody, oldest day first; calls_per_day: on average. frequent: the
    causes that called most often. chattering: those that called three times within an hour or more often,
    with how often they did. open: how many alarms are in each state. standing_long: those whose cause has
    stood for longer than a day, oldest first, the first of `standing_long_in_all`.
    """

    from_time: str
    to_time: str
    calls_per_day: float
    days: list[AlarmsOfDay]
    frequent: list[AlarmCause]
    chattering: list[AlarmCause]
    open: dict[AlarmState, int]
    standing_long: list[Alarm]
    standing_long_in_all: int


class AuditVerification(TypedDict):
    """
    What came of reading the whole trail.

    entries: those that are right, up to `last`. fault: null, or what was done to the trail: at the entry
    `number`, the first that is wrong, and in words in `message`.
    """

    entries: int
    last: AuditHead
    fault: Fault | None
    number: int | None
    message: str | None


class Backup(TypedDict):
    """
    A back-up: `running`, `verified` (every file was read again) or `failed`, with the problem.

    due_time: the time of the schedule that it was made for; null where somebody asked for it.
    """

    id: str
    state: BackupState
    name: str | None
    directory: str
    due_time: str | None
    began_time: str
    ended_time: str | None
    recordings: int | None
    files: int | None
    size_bytes: int | None
    problem: str | None


class CauseCost(TypedDict):
    """
    What one cause costs.

    Parameters
    ----------
    cause : LossCause
        The cause.
    loss_W : float
        Median of the latest records [W].
    energy_kWh_per_year : float
        Energy in a year of as many hours as the motor runs now [kWh].
    cost_per_year : float or None
        The same in money; None without a price.
    growth_W_per_year : float or None
        By how much the loss grows in a year [W]; None of too few records.
    growth_W_per_year_ci95 : tuple of float or None
        Its 95 % interval, from the scatter of the records [W].
    """

    cause: LossCause
    loss_W: float
    energy_kWh_per_year: float
    cost_per_year: float | None
    growth_W_per_year: float | None
    growth_W_per_year_ci95: tuple[float, float] | None


class Classification(TypedDict):
    """
    The one answer of a record or of a motor.

    answer: the likeliest causes. is_told: whether they are likely enough to be the answer alone. words: the
    answer as people read it. The verdict is what raises alarms; where it differs, `reasons` say so.
    """

    answer: list[str]
    is_told: bool
    probability: float
    words: str
    likelihoods: list[Likelihood]
    explanations: list[Explanation]
    not_told_apart: list[NotToldApart]
    reasons: list[str]


class ConditionChange(TypedDict):
    """
    A time at which the motor's state, kind, phase or candidates changed, or a note was taken into account.

    candidates: what an unclear kind may be, likeliest first; empty of records before they were kept.
    recording_id, note_id: what caused it; one of them is null.
    """

    state: State
    kind: Kind
    candidates: list[Kind]
    phase: Literal["a", "b", "c"] | None
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    change: float | None
    change_ci95: tuple[float, float] | None
    id: str
    time: str
    recording_id: str | None
    note_id: str | None


class ConditionPoint(TypedDict):
    """
    What was said of the motor from one of its records on; `record` is the id of the recording.

    candidates: what an unclear kind may be, likeliest first; empty of records before they were kept.
    """

    state: State
    kind: Kind
    candidates: list[Kind]
    phase: Literal["a", "b", "c"] | None
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    change: float | None
    change_ci95: tuple[float, float] | None
    record: str
    time: str


class Deletion(TypedDict):
    """
    A recording that was deleted, under the id that it had: what it was, when, by whom and why.

    deleted_by: `person` or `retention`, a rule of the settings.
    """

    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    sha256: str | None
    size_bytes: int
    state: RecordingState
    verdict: Verdict | None
    announced_time: str
    recorded_time: str | None
    deleted_time: str
    deleted_by: DeletedBy
    reason: str


class Difference(TypedDict):
    """
    Relay and SCL differ; `expected` is null where nobody expected it, `found` where the relay lacks it.
    """

    kind: DifferenceKind
    expected: str | None
    found: str | None


class EventReport(TypedDict):
    """
    A recording request: somebody, or the motor's schedule, asked a relay for a recording.

    It has the time of each state it went through. seconds: so much was asked for, as a series of recordings
    that overlap; null for one recording. joined_recording_id: what the series was joined to, once all of it
    is diagnosed. joined_remark: why that is shorter than asked for, or why there is none.
    """

    id: str
    motor: str
    ied: str
    origin: RecordingRequestOrigin
    state: RecordingRequestState
    reason: str | None
    recording_id: str | None
    requested_time: str
    triggered_time: str | None
    recorded_time: str | None
    fetched_time: str | None
    diagnosed_time: str | None
    failed_time: str | None
    seconds: float | None
    joined_recording_id: str | None
    joined_remark: str | None


class Ied(TypedDict):
    """
    A relay; `last_success_time` is when it last answered. `clock_...`: its clock less the service's.
    """

    clock_offset_s: float | None
    clock_uncertainty_s: float | None
    clock_quality: ClockQuality | None
    clock_measured_time: str | None
    name: str
    site: str
    host: str
    port: int
    manufacturer: str
    type: str
    link_state: LinkState
    link_reason: str | None
    link_changed_time: str | None
    last_success_time: str | None


class ImportedStart(TypedDict):
    """
    A start of a report: `added`, `joined` with the recording of the same start, or `known` already.
    """

    id: str
    time: str
    outcome: ReportOutcome


class Inspection(TypedDict):
    """
    What an inspection of a motor found, beside what the service had said. Nothing is judged by it.

    kind, finding: what was said. cause: what it was, where that is something else. pictures: how many, from
    1 on. An inspection that was withdrawn does not count.
    """

    id: str
    motor: str
    time: str
    kind: Kind
    finding: str
    outcome: InspectionOutcome
    cause: str | None
    text: str
    alarm_id: str | None
    pictures: int
    by: str
    on_behalf_of: str | None
    made_time: str
    withdrawn_time: str | None
    withdrawn_by: str | None
    withdrawn_reason: str | None


class InspectionCount(TypedDict):
    """
    Inspections of one kind of finding at a site in a year (UTC), as what they found.

    confirmed: hits. other_cause: something else was the matter. nothing_found: false alarms, or rightly
    nothing where the kind is `none`. missed: something was found of which nothing had been said.
    """

    kind: Kind
    site: str
    year: int
    confirmed: int
    other_cause: int
    nothing_found: int
    missed: int


class InspectionCounts(TypedDict):
    """
    How often inspections found what was said, latest year first.
    """

    counts: list[InspectionCount]


class InspectionRequest(TypedDict):
    """
    What an inspection found.

    outcome: `confirmed`: what the service said is what it was; `other-cause`: something else was the matter,
    `cause` says what; `nothing-found`. kind: what the service had said, by default what it says now; `none`
    where it said nothing. alarm_id: the alarm that it was about. time: when it was, by default now.
    """

    on_behalf_of: NotRequired[str | None]
    outcome: InspectionOutcome
    text: str
    kind: NotRequired[Kind | None]
    cause: NotRequired[str | None]
    alarm_id: NotRequired[str | None]
    time: NotRequired[str | None]


class LinkChange(TypedDict):
    """
    The state a link changed to, and why.
    """

    time: str
    state: LinkState
    reason: str | None


class ListedRecording(TypedDict):
    """
    A recording with the verdict of its latest diagnosis; null without one.
    """

    clock_offset_s: float | None
    clock_uncertainty_s: float | None
    clock_quality: ClockQuality | None
    clock_measured_time: str | None
    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    size_bytes: int
    state: RecordingState
    reason: str | None
    operation: Operation | None
    operation_remark: str | None
    duration_s: float | None
    pre_trigger_s: float | None
    parts: list[str] | None
    copy_of: str | None
    announced_time: str
    fetched_time: str | None
    recorded_time: str | None
    verdict: NotRequired[Verdict | None]


class LoadProfile(TypedDict):
    """
    How a motor was loaded. All is null, or empty, before a service has read the motors file.

    step_s: of the means that it is told by. running_hours, standing_hours and unknown_hours make up the whole
    time. unclassed_hours: running, at a load that is not known. duty: running over known hours. starts: at
    least so many. record_limits: of what no relay meters; shares of records, not of hours.
    """

    from_time: NotRequired[str | None]
    to_time: NotRequired[str | None]
    step_s: NotRequired[int | None]
    classes: NotRequired[list[LoadClass]]
    running_hours: NotRequired[float | None]
    standing_hours: NotRequired[float | None]
    unknown_hours: NotRequired[float | None]
    unclassed_hours: NotRequired[float | None]
    energy_kWh: NotRequired[float | None]
    duty: NotRequired[float | None]
    mean_load: NotRequired[float | None]
    starts: NotRequired[int | None]
    limits: NotRequired[list[LimitHours]]
    record_limits: NotRequired[list[RecordLimit]]
    thermal: NotRequired[ThermalState | None]
    relay_statistics: NotRequired[RelayStatistics | None]


class Losses(TypedDict):
    """
    What a motor loses, and what of it faults and supply cost a year.

    records: the latest ones that tell it. losses_W: median of the latest. duty: running over known hours of
    the last 30 days; null where none is metered, and the motor is then taken to run all the time.
    currency: of `[energy]`, empty without one.
    """

    records: int
    losses_W: float | None
    duty: float | None
    running_hours_per_year: float
    currency: str
    efficiencies: list[LoadEfficiency]
    causes: list[CauseCost]


class Measurement(TypedDict):
    """
    What the relay measured: at `time`, or means of `samples` values from then on.
    """

    time: str
    samples: int
    source: MeasurementSource
    ia_A: float | None
    ib_A: float | None
    ic_A: float | None
    vab_V: float | None
    vbc_V: float | None
    vca_V: float | None
    va_V: float | None
    vb_V: float | None
    vc_V: float | None
    power_W: float | None
    reactive_power_var: float | None
    power_factor: float | None
    frequency_Hz: float | None
    average_current_A: float | None
    maximum_current_A: float | None
    minimum_current_A: float | None
    average_voltage_V: float | None
    maximum_voltage_V: float | None
    minimum_voltage_V: float | None
    average_power_W: float | None
    maximum_power_W: float | None
    minimum_power_W: float | None
    maximum_ia_A: float | None
    maximum_ib_A: float | None
    maximum_ic_A: float | None
    minimum_ia_A: float | None
    minimum_ib_A: float | None
    minimum_ic_A: float | None
    maximum_vab_V: float | None
    maximum_vbc_V: float | None
    maximum_vca_V: float | None
    minimum_vab_V: float | None
    minimum_vbc_V: float | None
    minimum_vca_V: float | None


class MotorClassification(TypedDict):
    """
    The one answer of a motor. records: number of its latest records that took part.
    """

    answer: list[str]
    is_told: bool
    probability: float
    words: str
    likelihoods: list[Likelihood]
    explanations: list[Explanation]
    not_told_apart: list[NotToldApart]
    reasons: list[str]
    motor: str
    records: int


class Notification(TypedDict):
    """
    A message to one receiver, and what became of it.

    recipient: a mail address; null where the channel has one receiver. site, priority: of the alarms in it.
    alarms: how many it tells of, null before it is first tried. attempts: it has reached its receiver at most
    so often. not_before_time: of the next attempt. finished_time: when it was sent, given up (`dead`) or
    withdrawn. error: why the latest attempt failed, or why the message was withdrawn.
    """

    id: str
    kind: NotificationKind
    state: NotificationState
    channel: str
    recipient: str | None
    site: str | None
    priority: AlarmPriority | None
    alarms: int | None
    created_time: str
    not_before_time: str
    attempts: int
    tried_time: str | None
    finished_time: str | None
    error: str | None


class NotificationDetails(TypedDict):
    """
    A message with the first alarms in it, the most urgent first.
    """

    id: str
    kind: NotificationKind
    state: NotificationState
    channel: str
    recipient: str | None
    site: str | None
    priority: AlarmPriority | None
    alarms: int | None
    created_time: str
    not_before_time: str
    attempts: int
    tried_time: str | None
    finished_time: str | None
    error: str | None
    told: list[ToldAlarm]


class PageAlarmChange(TypedDict):
    items: list[AlarmChange]
    next_cursor: str | None


class PageAlarm(TypedDict):
    items: list[Alarm]
    next_cursor: str | None


class PageBackup(TypedDict):
    items: list[Backup]
    next_cursor: str | None


class PageConditionChange(TypedDict):
    items: list[ConditionChange]
    next_cursor: str | None


class PageDeletion(TypedDict):
    items: list[Deletion]
    next_cursor: str | None


class PageEventReport(TypedDict):
    items: list[EventReport]
    next_cursor: str | None


class PageIed(TypedDict):
    items: list[Ied]
    next_cursor: str | None


class PageInspection(TypedDict):
    items: list[Inspection]
    next_cursor: str | None


class PageLinkChange(TypedDict):
    items: list[LinkChange]
    next_cursor: str | None


class PageListedRecording(TypedDict):
    items: list[ListedRecording]
    next_cursor: str | None


class PageMeasurement(TypedDict):
    items: list[Measurement]
    next_cursor: str | None


class PageNotification(TypedDict):
    items: list[Notification]
    next_cursor: str | None


class PageRotorTrendPoint(TypedDict):
    items: list[RotorTrendPoint]
    next_cursor: str | None


class PageSite(TypedDict):
    items: list[Site]
    next_cursor: str | None


class PageStartSummary(TypedDict):
    items: list[StartSummary]
    next_cursor: str | None


class PageSupplyTrendPoint(TypedDict):
    items: list[SupplyTrendPoint]
    next_cursor: str | None


class PageSwingTrendPoint(TypedDict):
    items: list[SwingTrendPoint]
    next_cursor: str | None


class PageToken(TypedDict):
    items: list[Token]
    next_cursor: str | None


class PageTrackedTrendPoint(TypedDict):
    items: list[TrackedTrendPoint]
    next_cursor: str | None


class PageUser(TypedDict):
    items: list[User]
    next_cursor: str | None


class PartOfMotor(TypedDict):
    """
    What is said of one part of a motor, or of what surrounds it.

    explained_by: the part whose finding explains this one, which does not count again.
    """

    part: Part
    state: State
    finding: str
    since: str | None
    advice: str
    reasons: list[str]
    explained_by: Part | None


class PlannedStop(TypedDict):
    """
    When a motor stops next, and whether the motor or its site was planned so; null without a plan.
    """

    time: str | None
    of: StopOf | None


class Recording(TypedDict):
    """
    A recording. `recorded_time` is the trigger time written in the record, known once it was read.

    operation: what the motor does in it; null while nobody has looked, or it cannot be told.
    operation_remark: why the motor's parameters cannot be estimated from this start.
    duration_s: its length; pre_trigger_s: how much of it is before the trigger; null before it was read.
    parts: the recordings that it was joined from (source joined); null of others.
    copy_of: the recording of the same event, with values as fine or finer, that counts in its place.
    That time is the relay's; `clock_...` is the latest comparison of its clock when the recording was stored,
    null where that was not made within an hour of it.
    """

    clock_offset_s: float | None
    clock_uncertainty_s: float | None
    clock_quality: ClockQuality | None
    clock_measured_time: str | None
    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    size_bytes: int
    state: RecordingState
    reason: str | None
    operation: Operation | None
    operation_remark: str | None
    duration_s: float | None
    pre_trigger_s: float | None
    parts: list[str] | None
    copy_of: str | None
    announced_time: str
    fetched_time: str | None
    recorded_time: str | None


class RelayEventEntry(TypedDict):
    """
    A start, stop or trip of a motor, by its relay's sequence of events.
    """

    kind: RelayEventKind
    time: str


class RotorFinding(TypedDict):
    """
    What a record tells of the rotor's cage; figures are None where it cannot tell them.

    Parameters
    ----------
    state : RotorState
        Healthy, watch, fault, or unsupported.
    lower_sideband_dB, upper_sideband_dB : float or None
        Current at (1 - 2s) f and (1 + 2s) f as measured, over the fundamental [dB].
    severity_dB : float or None
        Asymmetry of the rotor's resistance, half the difference of its axes over its value [dB]. It is the
        lower sideband over the rotor's current that a rotor of steady speed would have; load and inertia do
        not change it. A cage that lost n of N neighbouring bars has a little less than n / N.
    severity_dB_ci95 : tuple of float or None
        Its 95 % interval: noise, and the parameters of the model.
    detection_limit_dB : float or None
        Severity that nine of ten such records show.
    slip : float or None
        Slip: that seen in the current, else from the fit of the model.
    load_level : float or None
        Load torque over rated torque.
    load_bin : int or None
        Tenth of 1.2 times the rated load, 0 to 11.
    duration_s : float
        Length of the steady running that was examined [s].
    load_oscillation_dB : float or None
        Torque of the load that swings at 2 s f, its amplitude over rated torque [dB].
    reasons : tuple of str
        Reasons of the state in words.
    """

    state: RotorState
    lower_sideband_dB: float | None
    upper_sideband_dB: float | None
    severity_dB: float | None
    severity_dB_ci95: tuple[float, float] | None
    detection_limit_dB: float | None
    slip: float | None
    load_level: float | None
    load_bin: int | None
    duration_s: float
    load_oscillation_dB: float | None
    reasons: list[str]


class RotorOfStart(TypedDict):
    """
    What the latest start that can tell shows of the cage, beside the latest running record that can.

    agrees: whether both say the same; null where one cannot see what the other shows. words: the comparison.
    """

    recording_id: str
    time: str
    state: RotorState
    severity_dB: float | None
    agrees: bool | None
    words: str


class SpeedFinding(TypedDict):
    """
    The speed of the shaft in one record.

    Parameters
    ----------
    state : SpeedState
        Whether the current shows it.
    source : SpeedSource or None
        Where the speed comes from; None where there is none.
    speed_rpm : float or None
        The speed: that seen in the current, otherwise that of the model [rpm].
    speed_rpm_ci95 : tuple of float or None
        Its 95 % interval; None of the model's [rpm].
    slip : float or None
        The slip at this speed.
    model_speed_rpm : float or None
        Speed by the model, to compare [rpm].
    rotor_bars : int or None
        Number of bars with which the speed is seen.
    margin : float or None
        By how much the speed beats every separate one, the least of all pieces in which it is seen [nats].
    alternatives : tuple of SpeedAlternative
        Speeds by number of bars, the likeliest first, where the records do not tell them apart.
    reasons : tuple of str
        Reasons of the state in words.
    """

    state: SpeedState
    source: SpeedSource | None
    speed_rpm: float | None
    speed_rpm_ci95: tuple[float, float] | None
    slip: float | None
    model_speed_rpm: float | None
    rotor_bars: int | None
    margin: float | None
    alternatives: list[SpeedAlternative]
    reasons: list[str]


class StartDetails(TypedDict):
    """
    A start with its curves and all that the motor's model tells of it.
    """

    id: str
    source: StartSource
    recording_id: str | None
    time: str
    is_from_rest: bool
    is_reference: bool
    acceleration_s: float | None
    peak_current_A: float
    mean_current_A: float | None
    crest_current_A: float
    running_current_A: float | None
    lowest_voltage_V: float | None
    i2t_A2s: float
    i2t_over_s: float
    from_report: list[str]
    share_of_hot_limit: float | None
    starts_within_hour: int
    starts_allowed: int | None
    mean_torque_Nm: float | None
    load_torque_Nm: float | None
    load_torque_Nm_ci95: tuple[float, float] | None
    rotor_state: RotorState | None
    comparison: StartComparison | None
    curve: StartCurve
    torque: StartTorqueDetails | None
    parameters: StartParametersDetails | None
    sideband: StartSidebandDetails | None
    stress: StartStressDetails | None
    remark: str | None


class StartImport(TypedDict):
    """
    What became of the starts of a relay's report.
    """

    starts: list[ImportedStart]
    left_out: list[LeftOutStart]


class TrackedParameter(TypedDict):
    """
    One parameter, at the temperature of the first records.

    value: null where it is undetermined. reference: the motor file's. standing: by which fraction the first
    records differ from it, by errors of file and sensors; it is taken out of the value. change: a fraction,
    since the first records (..._ci95: 95 % interval). since: first record of the drift.
    """

    name: ParameterName
    value: float | None
    reference: float
    standing: float | None
    change: float | None
    change_ci95: tuple[float, float]
    state: TrackingState
    since: str | None
    reasons: list[str]


class TrendPoint(TypedDict):
    """
    One recording's figure; `value` is null where the recording does not tell it.

    ci95: 95 % interval from noise, sensors and parameters, where the figure has one. scatter95: of mu_f only,
    from the record's own scatter alone. detection_limit: what nine of ten such recordings show.
    verdict: of the recording alone, beside figures of the winding. state: of the stator from that recording
    on, with kind and phase, beside figures of the motor's condition; what the recording shows of the rotor,
    beside figures of that. reasons: what limits figures of rotor, air gap, load and supply.
    """

    time: str
    value: float | None
    ci95: tuple[float, float] | None
    scatter95: tuple[float, float] | None
    detection_limit: float | None
    verdict: Verdict | None
    recording_id: str
    state: NotRequired[State | RotorState | None]
    kind: NotRequired[Kind | None]
    phase: NotRequired[Literal["a", "b", "c"] | None]
    reasons: NotRequired[list[str] | None]


class UndoneAcknowledgements(TypedDict):
    """
    The alarms that call again, and those for which that was not possible.
    """

    undone: list[Alarm]
    refused: list[Refusal]


class Waveform(TypedDict):
    """
    Channels over time; `time_s` is where each interval begins, in seconds after `start_time`.
    """

    recording_id: str
    start_time: str
    trigger_time: str
    sample_rate_hz: float
    samples: int
    time_s: list[float]
    channels: list[WaveformChannel]


class Winding(TypedDict):
    """
    How a stator is wound, as the motors file has it.

    kind: how the coils lie. slots: of the stator. layers: coil sides in a slot. coil_pitch_slots: slots from
    side to side of a coil.
    """

    kind: WindingKind
    slots: int
    layers: int
    coil_pitch_slots: int | None


class Acknowledgements(TypedDict):
    """
    The alarms that were acknowledged, and those for which that was not possible.
    """

    acknowledged: list[Alarm]
    refused: list[Refusal]


class Baseline(TypedDict):
    """
    The motor's healthy recordings; empty where it has no baseline.

    When they were chosen, why, where that was said, and which of them were in doubt. by: the account that
    chose them; on_behalf_of: whom it named.
    """

    recordings: list[Recording]
    chosen_time: str | None
    reason: str | None
    by: str | None
    on_behalf_of: str | None
    doubts: list[BaselineDoubt]


class Condition(TypedDict):
    """
    The condition of a motor over time, judged from all its records: what a plant acts on.

    state: of its worst part. kind: what that part has; `finding`: the same in words. causes: explanations of
    all that is measured, the likeliest first. parts: each of them. `candidates`: what an unclear kind may be.
    phase: null where it is less than 95 % sure. phase_probabilities: of a, b and c, if it is shorted turns.
    axis_deg: electrical degrees of their coils' axis from the phase's, where the motor's winding is known.
    mu_f: fault level in all, change: since the reference, as fractions of the phase turns, each with its 95 %
    interval from noise, sensors and parameters. size: of the change in its own measure, for example the
    relative error of a channel, with its 95 % interval. since: first record that shows the change.
    as_of: latest record that counts; stale: whether that is too old.
    """

    motor: str
    state: State
    kind: Kind
    candidates: list[Kind]
    phase: Literal["a", "b", "c"] | None
    phase_probabilities: NotRequired[tuple[float, float, float] | None]
    axis_deg: NotRequired[float | None]
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    change: float | None
    change_ci95: tuple[float, float] | None
    size: float | None
    size_ci95: NotRequired[tuple[float, float] | None]
    since: str | None
    growth_per_day: float | None
    forecast: Forecast
    reference: ConditionReference
    as_of: str | None
    stale: bool
    advice: str
    reasons: list[str]
    finding: NotRequired[str]
    urgency: NotRequired[Urgency]
    causes: NotRequired[list[LikelyCause]]
    parts: NotRequired[list[PartOfMotor]]


class ConditionDetails(TypedDict):
    """
    A condition with what was said from each of the latest records on, oldest first.

    until_stop: whether the motor holds until its planned stop; null where none is planned.
    """

    motor: str
    state: State
    kind: Kind
    candidates: list[Kind]
    phase: Literal["a", "b", "c"] | None
    phase_probabilities: NotRequired[tuple[float, float, float] | None]
    axis_deg: NotRequired[float | None]
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    change: float | None
    change_ci95: tuple[float, float] | None
    size: float | None
    size_ci95: NotRequired[tuple[float, float] | None]
    since: str | None
    growth_per_day: float | None
    forecast: Forecast
    reference: ConditionReference
    as_of: str | None
    stale: bool
    advice: str
    reasons: list[str]
    finding: NotRequired[str]
    urgency: NotRequired[Urgency]
    causes: NotRequired[list[LikelyCause]]
    parts: NotRequired[list[PartOfMotor]]
    until_stop: UntilStop | None
    history: list[ConditionPoint]


class Diagnosis(TypedDict):
    """
    The result for one recording, as `mcc diagnose --json` prints it.

    mu_f: equivalent fault level, fraction of the phase turns. theta_f: 0, 1, 2 = winding on terminals
    a, b, c; it and phase are null where no phase is named, which takes 0.95 of phase_probabilities.
    load_level: load torque over rated torque. ..._ci95: 95 % interval from noise, sensors, parameters, and
    what is not known of the turns. ..._scatter95: from the record's own scatter alone. speed_rpm: of the
    shaft, from the fit. detection_limit: nine of ten such recordings show a fault of that mu_f.
    currents_only: the voltages are assumed. operation: what the motor does in the recording.
    phase_probabilities: that shorted turns, if there are any, lie in the winding on terminal a, b, c; null of
    a motor with slip rings. hypotheses: the causes that the phasors were weighed for, the likeliest first.
    rotor, supply: what it shows of them. classification: which causes are likely, by all that was examined.
    eccentricity, pulsation: what it shows of the air gap, and of a load that swings. speed: of the shaft, as
    seen in the current or by the model. losses: with the efficiency, and what faults add to them.
    """

    verdict: Verdict
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    mu_f_scatter95: NotRequired[tuple[float, float] | None]
    detection_limit: NotRequired[float | None]
    theta_f: int | None
    phase: Literal["a", "b", "c"] | None
    load_level: float | None
    time_offset_s: float | None
    residual_rms_A: float | None
    evaluations: int
    compute_seconds: float
    quality: list[QualityFinding]
    reasons: list[str]
    model: str
    method: str
    load_level_ci95: NotRequired[tuple[float, float] | None]
    load_level_scatter95: NotRequired[tuple[float, float] | None]
    speed_rpm: NotRequired[float | None]
    indicators: NotRequired[Indicators | None]
    currents_only: NotRequired[bool]
    operation: NotRequired[Operation | None]
    fit: NotRequired[FittedParameters | None]
    phase_probabilities: NotRequired[tuple[float, float, float] | None]
    hypotheses: NotRequired[list[Hypothesis]]
    rotor: NotRequired[RotorFinding | None]
    supply: NotRequired[SupplyFigures | None]
    classification: NotRequired[Classification | None]
    eccentricity: NotRequired[EccentricityFinding | None]
    pulsation: NotRequired[PulsationFinding | None]
    speed: NotRequired[SpeedFinding | None]
    losses: NotRequired[LossFigures | None]


class DiagnosisRun(TypedDict):
    """
    A diagnosis asked for: queued, running, done with its `result`, or failed with its `error`.

    started_time, finished_time: of the latest attempt.
    """

    id: str
    recording_id: str
    method: str
    model: str
    state: JobState
    attempts: int
    error: str | None
    created_time: str
    started_time: str | None
    finished_time: str | None
    result: NotRequired[Diagnosis | None]


class Health(TypedDict):
    """
    What is known of a motor now: its condition, the diagnosis of its latest recording, its relay's link.

    What is said of verdict, level, phase, load and reasons beside the condition repeats the diagnosis; null
    and empty before the first one. Recordings in which the motor stands, starts, stops or trips say nothing
    of it, and are told by last_recording alone. starts: those among them that its parameters follow from.
    stood_time: when the motor was last seen to stand still.
    """

    motor: str
    site: str
    ied: str
    condition: Condition
    parameters_source: ParametersSource
    verdict: Verdict | None
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    mu_f_scatter95: tuple[float, float] | None
    detection_limit: float | None
    phase: Literal["a", "b", "c"] | None
    load_level: float | None
    load_level_ci95: tuple[float, float] | None
    reasons: list[str]
    recording_id: str | None
    recorded_time: str | None
    link_state: LinkState
    link_reason: str | None
    last_success_time: str | None
    last_recording: Recording | None
    starts: RecordedStarts | None
    stood_time: str | None


class IedDetails(TypedDict):
    """
    A relay with the figures of its link, its latest link changes and the alarms that stand.

    gateway: id of the one that visits it, null while none does. acquisition: null before the first visit.
    quarantine: null where nothing is held against it. report_length: null before a record of it was read.
    differences: from its SCL. ignored_files: the first hundred of `ignored_files_in_all`.
    """

    clock_offset_s: float | None
    clock_uncertainty_s: float | None
    clock_quality: ClockQuality | None
    clock_measured_time: str | None
    name: str
    site: str
    host: str
    port: int
    manufacturer: str
    type: str
    link_state: LinkState
    link_reason: str | None
    link_changed_time: str | None
    last_success_time: str | None
    gateway: str | None
    figures: LinkFigures
    changes: list[LinkChange]
    quarantine: Quarantine | None
    alarms: list[Alarm]
    acquisition: Acquisition | None
    report_length: ReportLength | None
    differences: list[Difference]
    ignored_files: list[IgnoredFile]
    ignored_files_in_all: int


class ListedMotor(TypedDict):
    """
    A motor in a list, with its health where that was asked for.
    """

    name: str
    description: str
    site: str
    ied: str
    schedule: str | None
    parameters_source: ParametersSource
    health: NotRequired[Health | None]


class Motor(TypedDict):
    """
    A motor; `schedule`, a cron expression in UTC, says when it is recorded without anybody asking.

    parameters_source: where its parameters come from: given in the motors file, commissioned from a recorded
    start, from a data sheet, or typical of its rating. With typical ones the motor is on watch at most.
    winding: of its stator; null where the motors file does not tell it.
    """

    name: str
    description: str
    site: str
    ied: str
    schedule: str | None
    parameters_source: ParametersSource
    winding: Winding | None


class PageDiagnosisRun(TypedDict):
    items: list[DiagnosisRun]
    next_cursor: str | None


class PageListedMotor(TypedDict):
    items: list[ListedMotor]
    next_cursor: str | None


class PageRelayEventEntry(TypedDict):
    items: list[RelayEventEntry]
    next_cursor: str | None


class PageTrendPoint(TypedDict):
    items: list[TrendPoint]
    next_cursor: str | None


class RecordingDetails(TypedDict):
    """
    A recording with its files and its latest diagnosis.

    copies: recordings of the same event in whose place it counts.
    """

    clock_offset_s: float | None
    clock_uncertainty_s: float | None
    clock_quality: ClockQuality | None
    clock_measured_time: str | None
    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    size_bytes: int
    state: RecordingState
    reason: str | None
    operation: Operation | None
    operation_remark: str | None
    duration_s: float | None
    pre_trigger_s: float | None
    parts: list[str] | None
    copy_of: str | None
    announced_time: str
    fetched_time: str | None
    recorded_time: str | None
    copies: list[str]
    files: list[RecordingFile]
    diagnosis: Diagnosis | None


class ReportImport(TypedDict):
    """
    What became of a report, by its kind; the other fields are null.
    """

    kind: ReportKind
    motor_starts: NotRequired[StartImport | None]
    load_profile: NotRequired[LoadImport | None]
    motor_statistics: NotRequired[StatisticsImport | None]
    events: NotRequired[EventImport | None]


class RotorCondition(TypedDict):
    """
    The rotor of a motor, from all its recordings that could tell.

    severity_dB: median of the latest ones. change_dB: against the baseline of the same load. since: first
    recording that shows this state. start: null without a start that can tell. advice: what is to be done.
    """

    motor: str
    state: RotorState
    severity_dB: float | None
    severity_dB_ci95: tuple[float, float] | None
    change_dB: float | None
    since: str | None
    bins: list[RotorLoadBin]
    start: RotorOfStart | None
    advice: str
    reasons: list[str]


class TrackedMotor(TypedDict):
    """
    The parameters of a motor, from all its recordings and starts.

    winding_excess_K: how much hotter the stator winding is than its load explains, against the first records.
    causes: what may have made parameters drift; several where the recordings do not tell them apart.
    advice: what is to be done.
    """

    motor: str
    state: TrackingState
    parameters: list[TrackedParameter]
    records: int
    as_of: str | None
    reference_complete: bool
    winding_excess_K: float | None
    winding_excess_K_ci95: tuple[float, float] | None
    causes: list[DriftCause]
    advice: str
    reasons: list[str]
