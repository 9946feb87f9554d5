"""What recordings show beside their diagnosis, for tests without a worker."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from core.diagnosis.verdict import Diagnosis
from core.losses.figures import LossFigures
from core.rotor.finding import RotorFinding, RotorState
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.supply.figures import SupplyFigures
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Series
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, healthy

SOUND_ROTOR = RotorFinding(
    state=RotorState.HEALTHY,
    lower_sideband_dB=-71.5,
    upper_sideband_dB=-74.25,
    severity_dB=-68.0,
    severity_dB_ci95=(-74.0, -64.5),
    detection_limit_dB=-52.0,
    slip=0.031,
    load_level=0.72,
    load_bin=6,
    duration_s=10.0,
    load_oscillation_dB=-60.0,
    reasons=("no asymmetry of the rotor above -52 dB",),
)

BROKEN_ROTOR = replace(
    SOUND_ROTOR,
    state=RotorState.FAULT,
    lower_sideband_dB=-35.5,
    upper_sideband_dB=-41.0,
    severity_dB=-29.0,
    severity_dB_ci95=(-31.0, -27.5),
    reasons=("the rotor's resistance is asymmetric",),
)

SHORT_RECORD = replace(
    RotorFinding.untold("the record is too short for this slip", 1.0),
    slip=0.008,
    load_level=0.2,
    load_bin=1,
)

ECCENTRIC_ROTOR = EccentricityFinding(
    permeance_ripple=0.0525,
    standard_deviation=0.002,
    detection_limit=0.0075,
    lower_sideband_dB=-41.0,
    upper_sideband_dB=-43.5,
    load_torque=0.001,
    load_torque_deviation=0.002,
    rotation_frequency_hz=24.25,
    reasons=(),
)

SWINGING_LOAD = PulsationFinding(
    load_torque=0.0625,
    noise=0.001,
    frequency_hz=4.125,
    load_torque_deviation=0.0015,
    detection_limit=0.005,
    reasons=(),
)

SUPPLY = SupplyFigures(
    frequency_hz=50.01,
    line_voltages_V=(401.0, 399.5, 396.25),
    voltage_unbalance_iec=0.0071,
    voltage_unbalance_nema=0.0068,
    derating=1.0,
    voltage_deviation=-0.0027,
    thd_voltage=0.021,
    harmonic_voltage_factor=0.0085,
    voltage_harmonics=(1.0, 0.0, 0.001, 0.0, 0.018, 0.0, 0.011),
    line_currents_A=(1.5, 1.48, 1.53),
    current_unbalance=0.02,
    thd_current=0.035,
    current_harmonics=(1.0, 0.001, 0.004, 0.0, 0.03, 0.0, 0.017),
    active_power_W=612.5,
    power_factor=0.61,
    duration_s=10.0,
    reasons=(),
)


LOSSES = LossFigures(
    efficiency=0.815,
    efficiency_ci95=(0.775, 0.8475),
    output_W=499.0,
    load_class=6,
    losses_W=113.5,
    losses_W_ci95=(93.5, 137.75),
    stator_copper_W=43.5,
    rotor_copper_W=20.0,
    iron_W=27.0,
    friction_W=18.0,
    stray_W=5.0,
    turns_loss_W=12.5,
    unbalance_loss_W=2.25,
    voltage_loss_W=-0.5,
    rotor_loss_W=0.0,
    reasons=(),
)


class ExaminedRecordings:
    """Recordings of running motors with what they show, one a second."""

    def __init__(self, repository: Repository, store: RecordingStore) -> None:
        self.repository, self._store, self._number = repository, store, 0

    def add(
        self,
        rotor: RotorFinding | None,
        supply: SupplyFigures | None = None,
        *,
        motor: str = "PUMP-A1",
        diagnosis: Diagnosis | None = None,
        left_out: str | None = None,
        at_ns: int | None = None,
        **parts: Any,
    ) -> str:
        """Add a recording with what it shows; return its id. at_ns: of that time, not of the next second.

        parts: of its Findings, besides those named here.
        """
        self._number += 1
        now_ns = NOW_NS + self._number * SECOND_NS if at_ns is None else at_ns
        stored = self._store.store({f"R{self._number}.CFF": f"{motor} {self._number}".encode()})
        added = self.repository.add_recording(stored, motor=motor, now_ns=now_ns)
        self.diagnose(rotor, supply, now_ns, diagnosis=diagnosis, left_out=left_out, **parts)
        return added.recording.id

    def join(self, parts: Sequence[str], rotor: RotorFinding, *, motor: str = "PUMP-A1") -> str:
        """Join recordings to one of the time of the first, with what it shows; return its id."""
        series = self._series(parts, motor)
        stored = self._store.store({"JOINED.CFF": " ".join(parts).encode()})
        joined = self.repository.add_joined(
            stored, series, tuple(range(len(parts))), None, now_ns=series.recorded_ns[0]
        )
        self.diagnose(rotor, None, series.recorded_ns[0])
        return joined

    def diagnose_again(self, recording: str, rotor: RotorFinding, *, at_ns: int | None = None) -> None:
        """Have a recording show something else."""
        recorded_ns = self.repository.recording(recording).recorded_ns if at_ns is None else at_ns
        assert recorded_ns is not None
        self.repository.request_diagnosis(recording, now_ns=recorded_ns)
        self.diagnose(rotor, None, recorded_ns)

    def _series(self, parts: Sequence[str], motor: str) -> Series:
        rows = [self.repository.recording(part) for part in parts]
        request = self.repository.request_recording(motor, now_ns=NOW_NS)
        return Series(
            request.id,
            motor,
            tuple(parts),
            tuple(row.digest or "" for row in rows),
            tuple(row.recorded_ns or 0 for row in rows),
            ended_by=None,
            is_complete=True,
        )

    def diagnose(
        self,
        rotor: RotorFinding | None,
        supply: SupplyFigures | None,
        recorded_ns: int,
        *,
        diagnosis: Diagnosis | None = None,
        left_out: str | None = None,
        **parts: Any,
    ) -> None:
        """Have the next recording that waits diagnosed."""
        claimed = self.repository.claim_job(now_ns=recorded_ns + 1000 * SECOND_NS, runner=RUNNER)
        assert claimed is not None
        assert self.repository.finish_job(
            claimed.job.id,
            findings_of(healthy() if diagnosis is None else diagnosis, rotor=rotor, supply=supply, **parts),
            recorded_ns=recorded_ns,
            now_ns=recorded_ns,
            runner=RUNNER,
            left_out=left_out,
        )
