"""Published motors judged by their nameplates alone: no fault is called, and intervals hold the truth."""

from dataclasses import replace

import numpy as np
import pytest

from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Verdict
from core.machines.parameters import Motor, ParametersSource
from core.machines.typical import TYPICAL_REASON, TYPICAL_TOLERANCES, typical_parameters
from testing.machines.phase_circuits import Fault, recording, running
from tests.core.machines.test_typical import PUBLISHED, Published

OF_50_HZ = [one for one in PUBLISHED if one.nameplate.rated_frequency_Hz == 50.0]


@pytest.mark.parametrize("published", OF_50_HZ, ids=lambda one: f"{one.nameplate.rated_power_W:.0f} W")
def test_a_nameplate_alone_tells_an_asymmetry_and_its_phase(published: Published) -> None:
    true = Motor("motor", published.nameplate, published.parameters)
    known = replace(
        true,
        parameters=typical_parameters(true.nameplate).parameters,
        parameters_source=ParametersSource.TYPICAL,
        tolerances=TYPICAL_TOLERANCES,
    )
    random = np.random.default_rng(round(true.nameplate.rated_power_W))
    for load_level in (0.1, 0.5, 0.95):
        for level in (0.0, 0.04):
            operation = running(
                true,
                load_level,
                fault=Fault(level, 1) if level else None,
                unbalance=complex(0.006 * np.exp(2j * np.pi * random.uniform())),
            )
            found = diagnose(recording(operation, noise=0.002, current_delay_s=40e-6), known)
            assert found.verdict in (Verdict.HEALTHY, Verdict.WATCH), found.reasons
            assert TYPICAL_REASON in found.reasons
            assert found.mu_f_ci95 is not None
            low, high = found.mu_f_ci95
            assert low <= level <= high, (load_level, found.mu_f, found.mu_f_ci95)
            if level:
                assert found.verdict is Verdict.WATCH
                assert found.phase_probabilities is not None
                assert int(np.argmax(found.phase_probabilities)) == 1
