"""The model of two bodies against a solver of differential equations, and against the simulator's warming."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.thermal.course import CurrentStep
from core.thermal.two_bodies import Rises, TwoBodies, after
from ied_sim.motor.warming import Warming

MOTOR = TwoBodies()
COURSE = [
    CurrentStep(1800.0, 1.0),
    CurrentStep(900.0, 1.2, 0.1),
    CurrentStep(3600.0, 0.0),
    CurrentStep(600.0, 0.5),
]


def test_rated_current_leads_to_the_rated_rises() -> None:
    end = after(Rises(), [CurrentStep(1e7, 1.0)], MOTOR)

    assert end.winding_K == pytest.approx(MOTOR.rated_rise_K)
    assert end.frame_K == pytest.approx(MOTOR.frame_share * MOTOR.rated_rise_K)
    assert after(end, [CurrentStep(1e8, 0.0)], MOTOR).winding_K == pytest.approx(0.0, abs=1e-9)


def test_it_is_the_solution_of_its_equations() -> None:
    """Losses and conductances are written out here from the definition, over the losses at rated current."""
    frame_K = 0.6 * 80.0
    G, H = 0.45 / (80.0 - frame_K), 1.0 / frame_K
    C_w, C_f = G * 400.0, H * 2400.0
    state = np.zeros(2)
    for step in COURSE:
        heating = step.positive**2 + 5.0 * step.negative**2
        stands = step.positive == 0.0
        P_w = 0.0 if stands else 0.45 * heating
        P_f = 0.0 if stands else 0.55 * (0.5 + 0.5 * heating)
        cooling = H / 2.5 if stands else H

        def rhs(
            _t: float, x: np.ndarray, P_w: float = P_w, P_f: float = P_f, cooling: float = cooling
        ) -> list[float]:
            between = G * (x[0] - x[1])
            return [(P_w - between) / C_w, (P_f + between - cooling * x[1]) / C_f]

        state = solve_ivp(rhs, (0.0, step.duration_s), state, rtol=1e-9, atol=1e-9).y[:, -1]

    found = after(Rises(), COURSE, MOTOR)
    assert (found.winding_K, found.frame_K) == pytest.approx(tuple(state), abs=1e-4)


def test_a_winding_warms_and_cools_faster_than_the_frame_at_first() -> None:
    early = after(Rises(), [CurrentStep(300.0, 1.0)], MOTOR)

    assert early.winding_K > 2.0 * early.frame_K


@pytest.mark.parametrize("load", [0.5, 0.75, 1.0])
def test_in_the_end_it_agrees_with_the_simulator_where_both_know_the_losses(load: float) -> None:
    """The simulator's winding is one body: losses at no load, and the rest with the square of the load."""
    idle = 0.55 * 0.5
    simulated = Warming(rise_K=80.0, time_constant_s=1800.0, idle_share=idle)
    truth_K = simulated.temperature_K(1e6, lambda time_s: np.full_like(time_s, load))

    found = after(Rises(), [CurrentStep(1e6, load)], MOTOR)

    # Two bodies put constant losses into the frame, from where the winding is warmed by a part only.
    assert found.winding_K == pytest.approx(truth_K, abs=9.0)
    assert found.winding_K <= truth_K + 1e-6
