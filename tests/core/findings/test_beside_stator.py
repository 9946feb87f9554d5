"""Rotor and supply of a record: none of their errors takes the diagnosis away."""

from dataclasses import replace

import numpy as np
import pytest

from core.diagnosis.verdict import Verdict
from core.findings import beside_stator
from core.findings.examining import examine
from core.recordings import Recording
from core.rotor.finding import RotorFinding, RotorState
from core.supply.figures import SupplyFigures
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import recording, running


@pytest.fixture(scope="module")
def record() -> Recording:
    return recording(running(REFERENCE, 0.6), noise=0.002)


def no_solution(*_: object) -> RotorFinding:
    raise np.linalg.LinAlgError("singular matrix")


def endless(found: SupplyFigures) -> SupplyFigures:
    return replace(found, thd_voltage=float("inf"))


def test_a_record_tells_of_rotor_and_supply(record: Recording) -> None:
    examined = examine(record, REFERENCE)
    assert examined.rotor.state is RotorState.HEALTHY
    assert examined.rotor.slip == pytest.approx(0.032, abs=0.002)
    assert examined.supply is not None
    assert examined.supply.line_voltages_V == pytest.approx((380.0,) * 3, rel=0.01)
    document = examined.as_dict()
    assert document["rotor"] == examined.rotor.as_dict()
    assert document["supply"] == examined.supply.as_dict()
    assert examined.diagnosis.as_dict().items() <= document.items()


def test_figures_of_the_rotor_that_cannot_be_computed_are_a_reason(
    record: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = examine(record, REFERENCE)
    monkeypatch.setattr(beside_stator, "examine_rotor", no_solution)
    found = examine(record, REFERENCE)
    assert found.rotor.state is RotorState.UNSUPPORTED
    assert found.rotor.reasons == ("the figures of the rotor cannot be computed: singular matrix",)
    assert found.diagnosis.mu_f == expected.diagnosis.mu_f
    assert found.supply == expected.supply


def test_a_record_without_a_steady_stretch_tells_neither_rotor_nor_swings(
    record: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = examine(record, REFERENCE)
    monkeypatch.setattr(beside_stator, "baseband_of", no_solution)
    found = examine(record, REFERENCE)
    assert found.rotor.reasons == ("the figures of the rotor cannot be computed: singular matrix",)
    assert found.eccentricity.reasons == ("the figures of the swings cannot be computed: singular matrix",)
    assert found.pulsation.reasons == found.eccentricity.reasons
    assert found.diagnosis.mu_f == expected.diagnosis.mu_f


def test_figures_of_the_supply_that_are_not_finite_are_a_reason(
    record: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = examine(record, REFERENCE)
    assert expected.supply is not None
    figures = endless(expected.supply)
    monkeypatch.setattr(beside_stator, "measure_supply", lambda *_, **__: figures)
    found = examine(record, REFERENCE)
    assert found.supply is None
    assert found.diagnosis.reasons == (
        *expected.diagnosis.reasons,
        "the figures of the supply cannot be computed: thd_voltage is not finite",
    )


def test_a_record_that_was_refused_tells_neither(record: Recording) -> None:
    cut = record.samples.copy()
    cut[0, ::2] = np.nan
    found = examine(replace(record, samples=cut), REFERENCE)
    assert found.diagnosis.verdict is Verdict.UNDIAGNOSABLE
    assert found.rotor.reasons == ("the quality gate refused the record",)
    assert found.supply is None


def test_a_motor_that_stands_shows_its_supply(record: Recording) -> None:
    at_rest = record.samples.copy()
    at_rest[:3] = 0.0
    found = examine(replace(record, samples=at_rest), REFERENCE)
    assert found.supply is not None
    assert found.supply.line_currents_A is None


def test_a_record_without_voltages_shows_no_supply(record: Recording) -> None:
    currents = replace(record, samples=record.samples[:3], channels=record.channels[:3])
    found = examine(currents, REFERENCE, currents_only=True)
    assert found.supply is None
    assert not any("supply cannot" in reason for reason in found.diagnosis.reasons)
