"""A two-axis motor of other authors with shorted turns, run in Octave: its equations, its currents.

The equations are those of the code of "Modeling of Three-Phase Induction Machines Under Combined Inter-Turn
Fault and Mechanical Eccentricity", `gerais/atualizacaoEstados.m` of its repository, unchanged.
Only the loop around them is written here. Their motor's parameters come from finite elements; the shorted
turns lie on the axis of phase a and leak for themselves.
"""

import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat

from benchmarks.winding.others_fields import program

Array = NDArray[np.float64]

TURNS_PER_PHASE = 144
STEP_S = 10e-6
"""The authors' own step: the loop of one turn over 0.9 ohm has a time constant of 14 us."""
RISE_S, SETTLED_S, LASTS_S = 0.1, 0.15, 0.15
"""Time in which the voltage rises and the speed is held, in which nothing is kept, and that of the record."""
RATED_SLIP = 0.0397
EVERY = 20
"""Every so many steps one is kept."""
DRIVER = """
addpath("{folder}/gerais");
load("{folder}/dados/parametrosSaudaveis_Meeker.mat");
c.we = we; c.p = p; c.J = 1e9; c.Ns = Ns; c.Nr = Nr; c.rs = rs; c.rr = rr; c.Ls = Ls; c.Lr = Lr;
c.Lm = Lm; c.Lms = Lms; c.Lls = Lls; c.Lsr = Lsr; c.deg120 = 2*pi/3;
c.dt = {step}; c.dt_2 = c.dt/2; c.dt_6 = c.dt/6;
c.L_saud_modificada = [Ls 0 Lm 0 0; 0 Ls 0 Lm 0; Lm 0 Lr 0 0; 0 Lm 0 Lr 0; 0 0 0 0 1];
s = struct();
for name = {{"lambds", "lambqs", "lambdr", "lambqr", "lambasf", "ids", "iqs", "idr", "iqr", "i_f", ...
    "wr", "wmec", "theta_r", "theta_mec", "theta_dq"}}
  s.(name{{1}}) = 0;
end
s.wr = {speed}*we; s.wmec = (2/p)*s.wr;
steps = round({lasts}/c.dt); kept = zeros(floor(steps/{every}), 8); n = 0;
for k = 1:steps
  t = k*c.dt;
  if t > {rise}
    c.J = {inertia};
  end
  v = Vmax*(1 - cos(pi*min(t/{rise}, 1)))/2;
  va = {unbalance}*v*cos(we*t); vb = v*cos(we*t - c.deg120); vc = v*cos(we*t + c.deg120);
  next = atualizacaoEstados(c, s, va, vb, vc, 0, 0, {share}, {path}, {load}*TeNom);
  next.theta_dq = s.theta_dq + we*c.dt;
  if mod(k, {every}) == 0
    n = n + 1;
    kept(n, :) = [next.ias next.ibs next.ics va vb vc next.i_f next.wmec];
  end
  s = next;
end
save("-6", "{out}", "kept");
"""


@dataclass(frozen=True, slots=True)
class EquationCase:
    """turns: of 144 of phase a.  path_ohm: across them.  load: of rated."""

    name: str
    turns: int = 0
    path_ohm: float = 1e6
    load: float = 0.7


CASES = (
    EquationCase("healthy"),
    EquationCase("3 turns, 0.4 ohm", 3, 0.4),
    EquationCase("3 turns", 3, 0.0),
    EquationCase("4 turns", 4, 0.0, 0.3),
    EquationCase("7 turns", 7, 0.0, 1.0),
)
"""The first fault is the authors' own."""


def run(folder: Path, work: Path, case: EquationCase, *, inertia: float = 0.03) -> Array:
    """Currents of a, b, c [A], their voltages [V], the current of the path and the speed, (8, n)."""
    work.mkdir(parents=True, exist_ok=True)
    out, script = work / "kept.mat", work / "driver.m"
    text = DRIVER.format(
        folder=folder, inertia=inertia, step=STEP_S, rise=RISE_S,
        speed=1.0 - RATED_SLIP * case.load,
        lasts=SETTLED_S + LASTS_S, every=EVERY, unbalance=1.01, share=case.turns / TURNS_PER_PHASE,
        path=case.path_ohm, load=case.load, out=out,
    )  # fmt: skip
    script.write_text(text, encoding="utf-8")
    subprocess.run([program("octave-cli"), "--no-init-file", str(script)], cwd=work, check=True)
    kept = np.asarray(loadmat(out)["kept"], np.float64).T
    return kept[:, round(SETTLED_S / STEP_S / EVERY) :]
