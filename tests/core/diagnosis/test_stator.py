"""Diagnoses of recordings made by independent phase circuits: verdict, phase, level, load, and refusals."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from core.diagnosis.causes import Cause
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.methods import Method, Model, resolved
from core.diagnosis.search import METHODS
from core.diagnosis.stator import diagnose, learn_baseline
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.candidates import Candidates
from core.machines.parameters import Connection, Motor
from core.machines.playback import Playback, window_of_record
from core.machines.shorted_winding import ShortedWinding
from core.machines.stator_models import MODELS
from core.machines.supply import supply
from core.recordings import Channel, Quantity, Recording, RecordingError
from core.signals.clarke import clarke, inverse_clarke
from core.signals.phasors import fundamental_phasors
from testing.machines.motors import ALL, LARGE, MEDIUM, ONE_LAYER, REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from tests.core.diagnosis.spoiling import edited

IDS = [motor.name for motor in ALL]


def healthy_record() -> Recording:
    return recording(running(REFERENCE, 0.5), noise=0.005)


@pytest.mark.parametrize("motor", ALL, ids=IDS)
@pytest.mark.parametrize("reverse", [False, True], ids=["abc", "acb"])
@pytest.mark.parametrize("winding", [0, 1, 2])
def test_shorted_turns_are_found_in_their_phase(motor: Motor, reverse: bool, winding: int) -> None:
    motor = replace(motor, winding=ONE_LAYER)
    truth = running(motor, 0.6, fault=Fault(0.06, winding), unbalance=0.01, reverse=reverse)
    result = diagnose(recording(truth, noise=0.01, current_delay_s=40e-6), motor)
    assert result.verdict is Verdict.FAULT
    assert result.theta_f == winding
    assert result.phase == "abc"[winding]
    assert result.mu_f == pytest.approx(0.06, abs=0.001)
    assert result.load_level == pytest.approx(0.6, abs=0.02)
    assert result.time_offset_s == pytest.approx(40e-6, abs=20e-6)
    assert result.mu_f is not None
    assert result.mu_f_ci95 is not None
    assert result.mu_f_ci95[0] < result.mu_f < result.mu_f_ci95[1]


@pytest.mark.parametrize("motor", ALL, ids=IDS)
def test_turns_bridged_by_a_resistance_count_by_their_equivalent_level(motor: Motor) -> None:
    motor = replace(motor, winding=ONE_LAYER)
    level, ratio = 0.06, 0.5
    fault = Fault(level, 1, ratio * level * motor.parameters.stator_resistance_ohm)
    result = diagnose(recording(running(motor, 0.6, fault=fault), noise=0.005), motor)
    assert result.verdict is Verdict.FAULT
    assert result.phase == "b"
    # A path looks as less leakage does: the level is as sure as that is known.
    assert result.mu_f == pytest.approx(level / (1 + ratio), rel=0.2)
    assert result.mu_f_ci95 is not None
    assert result.mu_f_ci95[0] < level / (1 + ratio) < result.mu_f_ci95[1]


@pytest.mark.parametrize("motor", ALL, ids=IDS)
@pytest.mark.parametrize("load", [0.0, 0.1, 0.8])
@pytest.mark.parametrize("unbalance", [0.0, 0.03, 0.05j])
def test_an_unbalanced_supply_is_no_fault(motor: Motor, load: float, unbalance: complex) -> None:
    truth = running(motor, load, unbalance=unbalance)
    result = diagnose(recording(truth, noise=0.01, current_gains=(1.002, 0.998, 1.001)), motor)
    assert result.verdict is Verdict.HEALTHY
    assert result.theta_f is None
    assert result.mu_f is not None
    assert result.mu_f < 0.002
    assert result.load_level == pytest.approx(load, abs=0.03)


def test_a_current_sensor_out_of_class_is_refused_by_the_sum_of_the_currents() -> None:
    record = recording(running(REFERENCE, 0.5), noise=0.002, current_gains=(1.0, 0.8, 1.0))
    result = diagnose(record, REFERENCE)
    assert result.verdict is Verdict.UNDIAGNOSABLE
    assert result.reasons[0].startswith("current sum")


@pytest.mark.parametrize("phase", [0, 1, 2])
def test_a_voltage_channel_that_reads_too_much_is_named(phase: int) -> None:
    record = recording(running(REFERENCE, 0.5), noise=0.002)
    samples = record.samples.copy()
    samples[3 + phase] *= 1.06
    result = diagnose(replace(record, samples=samples), REFERENCE)
    assert result.verdict is Verdict.WATCH
    assert result.theta_f is None
    assert f"channel {'abc'[phase]}: error of +5" in result.reasons[0]
    assert result.hypotheses[0].cause is Cause.VOLTAGE_CHANNEL
    assert result.hypotheses[0].probability > 0.99


def test_an_offset_no_relay_has_points_at_the_wrong_motor_file() -> None:
    record = recording(running(LARGE, 0.6), noise=0.002)
    mistaken = replace(LARGE, nameplate=replace(LARGE.nameplate, connection=Connection.STAR))
    assert any("not this motor's" in reason for reason in diagnose(record, mistaken).reasons)
    assert not any("not this motor's" in reason for reason in diagnose(record, LARGE).reasons)


@pytest.mark.parametrize("motor", ALL, ids=IDS)
def test_a_slightly_bad_joint_is_no_fault(motor: Motor) -> None:
    joint = (1, 0.05 * motor.parameters.stator_resistance_ohm)
    result = diagnose(recording(running(motor, 0.8, joint=joint), noise=0.005), motor)
    assert result.verdict is Verdict.HEALTHY


def test_the_thesis_model_diagnoses_machines_of_its_own_kind_only() -> None:
    """An extra resistive winding is not the same as dead-shorted turns, and the verdict says so."""
    record = recording(running(REFERENCE, 0.5), seconds=1.0)
    volts = clarke(record.samples[3:])
    feed = supply(volts, 10_000.0, 50.0, np.sqrt(2) * fundamental_phasors(volts, 50.0, 10_000.0))
    playback = Playback(
        ShortedWinding(), REFERENCE, feed, window_of_record(volts.shape[1], 10_000.0, 50.0, 1.0)
    )
    one = np.ones(1)
    truth = Candidates(0.05 * one, np.array([2]), 0.5 * one, 0.0 * one)
    window = playback.window
    samples = record.samples[:, window.first : window.last].copy()
    samples[:3] = inverse_clarke(playback.trajectories(truth).current[0])

    result = diagnose(replace(record, samples=samples), REFERENCE, model="shorted-winding")
    assert result.model == "shorted-winding"
    assert result.verdict is Verdict.FAULT
    assert result.theta_f == 2
    assert result.mu_f == pytest.approx(0.05, abs=1e-4)

    dead = recording(running(REFERENCE, 0.5, fault=Fault(0.05, 2)), noise=0.005)
    result = diagnose(dead, REFERENCE, model="shorted-winding")
    assert result.verdict is Verdict.WATCH
    assert result.theta_f is None


def test_line_voltages_serve_as_well_as_phase_voltages() -> None:
    motor = replace(MEDIUM, winding=ONE_LAYER)
    record = recording(running(motor, 0.5, fault=Fault(0.03, 1)), noise=0.002)
    samples = record.samples.copy()
    samples[3:] = record.samples[3:] - np.roll(record.samples[3:], -1, axis=0)
    lines = tuple(Channel("V" + p.upper(), Quantity.LINE_VOLTAGE, p, "V") for p in ("ab", "bc", "ca"))
    result = diagnose(replace(record, samples=samples, channels=record.channels[:3] + lines), motor)
    assert result.verdict is Verdict.FAULT
    assert result.mu_f == pytest.approx(0.03, abs=0.0015)


@pytest.mark.parametrize("rate", [960.0, 1_600.0, 8_000.0])
def test_slower_relays_serve_too(rate: float) -> None:
    motor = replace(REFERENCE, winding=ONE_LAYER)
    truth = running(motor, 0.5, fault=Fault(0.04, 0))
    result = diagnose(recording(truth, noise=0.005, sample_rate_hz=rate), motor)
    assert result.verdict is Verdict.FAULT
    assert result.phase == "a"
    assert result.mu_f == pytest.approx(0.04, abs=0.002)


def test_scatter_says_how_well_a_record_repeats() -> None:
    """White noise, 40 records: intervals of 95 % miss more than 6 times in one of a hundred such tests."""
    motor = replace(REFERENCE, winding=ONE_LAYER)
    truth = running(motor, 0.5, fault=Fault(0.05, 1))
    levels, intervals = [], []
    for seed in range(40):
        result = diagnose(recording(truth, noise=0.05, seconds=0.3, seed=seed), motor)
        assert result.mu_f is not None
        assert result.mu_f_scatter95 is not None
        levels.append(result.mu_f)
        intervals.append(result.mu_f_scatter95)
    middle = float(np.mean(levels))
    assert middle == pytest.approx(0.05, rel=0.05)
    assert sum(not low <= middle <= high for low, high in intervals) <= 6
    assert np.mean([high - low for low, high in intervals]) < 0.006


def test_the_reasons_say_what_was_estimated_and_what_only_bounded() -> None:
    result = diagnose(healthy_record(), REFERENCE)
    said = next(reason for reason in result.reasons if "estimated beside the level" in reason)
    for named in (
        "frequency (50.00 Hz)",
        "load",
        "offset of the currents",
        "ratios",
        "resistances and inductances",
    ):
        assert named in said


@pytest.mark.parametrize("factor", [2.0, 3.0])
def test_a_current_that_no_load_draws_is_no_verdict(factor: float) -> None:
    record = recording(running(MEDIUM, 1.0), noise=0.002)
    samples = record.samples.copy()
    samples[:3] *= factor
    result = diagnose(replace(record, samples=samples), MEDIUM)
    assert result.verdict in (Verdict.WATCH, Verdict.UNDIAGNOSABLE)
    assert any("edge" in reason or "not this motor's" in reason for reason in result.reasons)


@pytest.mark.parametrize("motor", ALL, ids=IDS)
@pytest.mark.parametrize("load", [0.1, 0.5])
@pytest.mark.parametrize("level", [0.0, 0.05])
def test_currents_twice_their_size_are_called_no_fault(motor: Motor, load: float, level: float) -> None:
    """A transformer's ratio taken for half of what it is: another motor's currents, whatever is nearest."""
    truth = running(motor, load, fault=Fault(level, 1), unbalance=0.01) if level else running(motor, load)
    record = recording(truth, noise=0.002)
    samples = record.samples.copy()
    samples[:3] *= 2.0
    assert diagnose(replace(record, samples=samples), motor).verdict is not Verdict.FAULT


def test_without_voltages_means_without_those_recorded_too() -> None:
    record = recording(running(REFERENCE, 0.5, unbalance=0.03), noise=0.002)
    currents = replace(record, samples=record.samples[:3], channels=record.channels[:3])
    both = [diagnose(one, REFERENCE, currents_only=True) for one in (record, currents)]
    assert both[0].mu_f == both[1].mu_f
    assert both[0].verdict is Verdict.WATCH
    assert both[0].as_dict()["currents_only"] is True
    assert diagnose(record, REFERENCE).as_dict()["currents_only"] is False


def test_levels_at_the_detection_limit_are_found_in_most_records() -> None:
    """Sensors within their class: at the limit the page promises nine of ten; seven of twelve leaves luck."""
    found = 0
    for seed in range(12):
        random = np.random.default_rng(seed)
        limit = diagnose(recording(running(REFERENCE, 0.5), noise=0.002), REFERENCE).detection_limit
        assert limit is not None
        record = recording(running(REFERENCE, 0.5, fault=Fault(limit, 1)), noise=0.002, seed=seed)
        gains = 1.0 + random.uniform(-0.01, 0.01, (6, 1))
        found += diagnose(replace(record, samples=record.samples * gains), REFERENCE).verdict is Verdict.FAULT
    assert found >= 7


def test_the_load_does_not_depend_on_the_limit() -> None:
    record = recording(running(REFERENCE, 0.6, fault=Fault(0.05, 1)), noise=0.002)
    limits = [replace(REFERENCE.limits, fault_level=level) for level in (0.005, 0.049, 0.2)]
    results = [diagnose(record, replace(REFERENCE, limits=each)) for each in limits]
    assert [each.verdict for each in results] == [Verdict.FAULT, Verdict.WATCH, Verdict.HEALTHY]
    assert len({(each.mu_f, each.load_level, each.load_level_ci95) for each in results}) == 1


def test_missing_voltages_are_a_recording_error() -> None:
    record = healthy_record()
    currents_only = replace(record, samples=record.samples[:3], channels=record.channels[:3])
    with pytest.raises(RecordingError, match="voltages: expected three phase voltages"):
        diagnose(currents_only, REFERENCE)


def test_without_voltages_the_verdict_is_a_hint_at_best() -> None:
    """A balanced supply, so the assumption holds: the phase is right, and still it is only a watch."""
    for winding in range(3):
        record = recording(running(REFERENCE, 0.5, fault=Fault(0.08, winding)), noise=0.005)
        bare = replace(record, samples=record.samples[:3], channels=record.channels[:3])
        result = diagnose(bare, REFERENCE, currents_only=True)
        assert result.verdict is Verdict.WATCH
        assert result.phase_probabilities is not None
        assert int(np.argmax(result.phase_probabilities)) == winding
        assert result.mu_f == pytest.approx(0.08, abs=0.02)
        assert "no voltages recorded" in result.reasons[1]
    healthy = recording(running(REFERENCE, 0.5), noise=0.005)
    bare = replace(healthy, samples=healthy.samples[:3], channels=healthy.channels[:3])
    assert diagnose(bare, REFERENCE, currents_only=True).verdict is Verdict.HEALTHY


def test_a_baseline_takes_the_standing_asymmetry_off() -> None:
    gains, unbalance = (0.99, 1.012, 1.0), 0.01
    healthy = [
        recording(running(MEDIUM, load, unbalance=unbalance), noise=0.005, current_gains=gains, seed=seed)
        for seed, load in enumerate((0.45, 0.5, 0.55, 0.6))
    ]
    baseline = learn_baseline(healthy[:3], MEDIUM)
    assert baseline.recordings == 3
    without, within = diagnose(healthy[3], MEDIUM), diagnose(healthy[3], MEDIUM, baseline=baseline)
    assert without.mu_f is not None
    assert within.mu_f is not None
    assert within.mu_f < 0.3 * without.mu_f
    assert within.detection_limit is not None
    assert without.detection_limit is not None
    assert within.detection_limit < without.detection_limit
    small = recording(
        running(MEDIUM, 0.5, fault=Fault(0.02, 2), unbalance=unbalance),
        noise=0.005,
        current_gains=gains,
        seed=9,
    )
    found = diagnose(small, MEDIUM, baseline=baseline)
    assert found.theta_f == 2
    assert found.mu_f == pytest.approx(0.02, rel=0.25)
    with pytest.raises(DiagnosisError, match="at least 3"):
        learn_baseline(healthy[:2], MEDIUM)
    with pytest.raises(DiagnosisError, match="not fit for a baseline: phase loss"):
        learn_baseline([edited(healthy_record(), [2], 0.02)], REFERENCE)


@pytest.mark.parametrize("motor", ALL, ids=IDS)
def test_indicators_and_speed_stand_beside_the_fit(motor: Motor) -> None:
    motor = replace(motor, winding=ONE_LAYER)
    truth = running(motor, 0.5, fault=Fault(0.05, 1), unbalance=0.02)
    result = diagnose(recording(truth, noise=0.001), motor)
    rpm = 60.0 * motor.nameplate.rated_frequency_Hz / motor.nameplate.pole_pairs
    assert result.speed_rpm == pytest.approx(rpm * (1.0 - truth.slip), abs=0.5)
    positive, negative = (
        (truth.line_current[0] + turn * truth.line_current[1] + turn**2 * truth.line_current[2]) / 3.0
        for turn in (np.exp(2j * np.pi / 3), np.exp(-2j * np.pi / 3))
    )
    seen = result.indicators
    assert seen is not None
    assert seen.voltage_unbalance == pytest.approx(0.02, rel=0.02)
    assert seen.current_unbalance == pytest.approx(abs(negative / positive), rel=0.02)
    assert seen.negative_sequence_current_A == pytest.approx(abs(negative), rel=0.02)
    volts = motor.nameplate.rated_voltage_V / np.sqrt(3.0)
    assert seen.negative_sequence_impedance_ohm == pytest.approx(0.02 * volts / abs(negative), rel=0.02)
    t = np.linspace(0.0, 2.0 * np.pi, 20_000)
    alpha, beta = clarke(np.real(truth.line_current[:, np.newaxis] * np.exp(1j * t)))
    radius = np.hypot(alpha, beta)
    assert seen.park_axis_ratio == pytest.approx(radius.min() / radius.max(), abs=0.005)
    major = np.degrees(np.arctan2(beta[radius.argmax()], alpha[radius.argmax()]))
    assert abs((seen.park_axis_angle_deg - major + 90.0) % 180.0 - 90.0) < 1.0


def test_unknown_method_and_model_name_the_known_ones() -> None:
    with pytest.raises(DiagnosisError, match="known: evidence, hybrid, hcpa"):
        diagnose(healthy_record(), REFERENCE, method="dowsing")
    with pytest.raises(DiagnosisError, match="split-winding"):
        diagnose(healthy_record(), REFERENCE, model="perfect")


def test_the_document_has_the_keys_of_the_contract() -> None:
    document = diagnose(healthy_record(), REFERENCE).as_dict()
    assert list(document) == [
        "verdict", "mu_f", "mu_f_ci95", "mu_f_scatter95", "detection_limit", "theta_f", "phase", "load_level",
        "time_offset_s", "residual_rms_A", "evaluations", "compute_seconds", "quality", "reasons", "model",
        "method", "load_level_ci95", "load_level_scatter95", "speed_rpm", "indicators", "currents_only",
        "operation", "fit", "phase_probabilities", "hypotheses",
    ]  # fmt: skip
    assert document["method"] == "evidence"
    assert document["model"] == "coil"


def test_residual_of_a_delta_is_given_in_line_amperes() -> None:
    """White noise on the lines: the residual over both axes is sqrt 2 times the noise of one."""
    clean = recording(running(LARGE, 0.6))
    samples = clean.samples.copy()
    samples[:3] += np.random.default_rng(3).standard_normal((3, samples.shape[1]))
    record = replace(clean, samples=samples)
    result = diagnose(record, LARGE)
    noise = np.std(clarke(record.samples[:3] - clean.samples[:3]))
    assert result.residual_rms_A == pytest.approx(np.sqrt(2) * noise, rel=0.05)


@pytest.mark.parametrize("motor", ALL, ids=lambda motor: motor.name)
@pytest.mark.parametrize("unbalance", [0.03, 0.05, -0.05, 0.07j])
def test_many_shorted_turns_are_no_reason_to_refuse(motor: Motor, unbalance: complex) -> None:
    """Far from the healthy machine, whose own fit is sought from a long way off."""
    for level, load_level in ((0.1, 0.12), (0.15, 0.05), (0.19, 0.12), (0.19, 0.3)):
        for winding in (0, 1):
            operation = running(motor, load_level, fault=Fault(level, winding), unbalance=unbalance)
            result = diagnose(recording(operation, noise=0.003, seconds=0.3), motor)
            assert (result.verdict, result.theta_f) == (Verdict.FAULT, winding), (level, load_level)
            assert result.mu_f == pytest.approx(level, rel=0.05)


def test_a_motor_running_light_on_a_strongly_unbalanced_supply_may_look_exchanged() -> None:
    record = recording(running(MEDIUM, 0.05, fault=Fault(0.1, 0), unbalance=0.1), noise=0.003)
    (reason,) = diagnose(record, MEDIUM).reasons
    assert "two phases are exchanged, or the motor runs light on a supply unbalanced by 10%" in reason


def test_a_diagnosis_is_repeatable() -> None:
    def figures(result: Diagnosis) -> tuple[object, ...]:
        return result.mu_f, result.load_level, result.evaluations

    record = healthy_record()
    assert figures(diagnose(record, REFERENCE)) == figures(diagnose(record, REFERENCE))


def test_every_named_method_and_model_can_be_used() -> None:
    assert set(METHODS) | {Method.EVIDENCE} == set(Method)
    for method, model in product(Method, Model):
        taken, used = resolved(method, model)
        assert (taken == Method.EVIDENCE) == (used == Model.COIL)
    assert set(MODELS) == set(Model)
