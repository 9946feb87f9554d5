"""A finite-element motor of other authors with shorted turns: its mesh, its circuit, its currents.

The motor is the 3 kW one that GetDP's examples have (J. Gyselinck, R. V. Sabariego). Its geometry, materials,
cage, moving band and equations stay as they are. Only the circuit is written here: the phases in star, and
a path across the shorted turns. Shorted turns are triangles of two slots that get a region of their own.
"""

import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from shutil import copy, which

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SLOTS, POLES, BARS = 36, 4, 32
TURNS_PER_PHASE, TURNS_PER_COIL = 204, 34
RESISTANCE_OHM = 2.2
"""Of a phase, as the authors give it; the turns' own copper has it by `Factor_R_3DEffects`."""
LENGTH_M, CONDUCTIVITY = 0.127, 5.9e7
PHASE_VOLTAGE_V, FREQUENCY_HZ = 220.0, 50.0
PHASE_A = (13_001, 13_004)
SHORTED = (13_101, 13_102)
"""Regions of the coil sides of phase a and of the shorted turns, to and fro."""
COARSER = 3.0
PERIODS, KEPT_PERIODS, STEPS = 10, 5, 80
"""Periods that are run, the last of them that make the record, and steps of one."""
UNBALANCE = 1.01
"""Of phase a over the others."""
FILES = (
    "BH.pro", "im_3kW.geo", "im_3kW_data.geo", "im_3kW_rotor.geo", "im_3kW_stator.geo", "im_3kW_orig.pro",
    "machine_magstadyn_a_orig.pro",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class FieldCase:
    """turns: shorted of one coil's 34, in slots `sides`.  path_ratio: of the path over their resistance.

    at_bottom: they lie deepest in their slots, else nearest to the air gap.
    """

    name: str
    turns: int = 0
    sides: tuple[int, int] = (0, 9)
    path_ratio: float = 0.0
    rpm: float = 1_440.0
    at_bottom: bool = True


CASES = (
    FieldCase("healthy"),
    FieldCase("10 turns, lap", 10),
    FieldCase("6 turns, lap", 6),
    FieldCase("6 turns, concentric", 6, (0, 11), at_bottom=False),
    FieldCase("17 turns, lap, path 2", 17, path_ratio=2.0),
    FieldCase("10 turns, concentric", 10, (0, 11), rpm=1_470.0),
)


@dataclass(frozen=True, slots=True)
class Mesh:
    """Triangles of a Gmsh file of version 2: the line of each, its region, its area and its centre."""

    lines: list[str]
    at: NDArray[np.int64]
    region: NDArray[np.int64]
    area: Array
    centre: NDArray[np.complex128]


def prepared(folder: Path, work: Path) -> Mesh:
    """Copy the model's files to `work` and mesh all four poles."""
    work.mkdir(parents=True, exist_ok=True)
    for name in FILES:
        copy(folder / name, work / name)
    copy(work / "machine_magstadyn_a_orig.pro", work / "machine_magstadyn_a.pro")
    mesh = work / "sound.msh"
    poles = told({"NbrPolesInModel": POLES, "Input/20Number of poles in FE model": POLES})
    options = ["-clscale", f"{COARSER:g}", *poles, "-format", "msh2", "-o", str(mesh), "-v", "1"]
    subprocess.run([program("gmsh"), "im_3kW.geo", "-2", *options], cwd=work, check=True)
    return read_mesh(mesh)


def read_mesh(path: Path) -> Mesh:
    """Read the triangles of a mesh."""
    lines = path.read_text(encoding="ascii").splitlines()
    first = lines.index("$Nodes") + 2
    nodes = {}
    for line in lines[first : lines.index("$EndNodes")]:
        number, x, y, _ = line.split()
        nodes[int(number)] = complex(float(x), float(y))
    at, region, corners = [], [], []
    for k in range(lines.index("$Elements") + 2, lines.index("$EndElements")):
        figures = [int(one) for one in lines[k].split()]
        if figures[1] == 2:
            at.append(k)
            region.append(figures[3])
            corners.append([nodes[one] for one in figures[-3:]])
    z = np.array(corners)
    area = 0.5 * np.abs(np.imag(np.conj(z[:, 1] - z[:, 0]) * (z[:, 2] - z[:, 0])))
    return Mesh(lines, np.array(at), np.array(region), area, z.mean(axis=1))


def with_shorted(mesh: Mesh, case: FieldCase, path: Path) -> float:
    """Write the mesh with the shorted turns as regions; return how many turns they are on the average."""
    lines, turns = list(mesh.lines), []
    density = 2 * TURNS_PER_PHASE / mesh.area[np.isin(mesh.region, PHASE_A)].sum()
    for slot, new in zip(case.sides, SHORTED, strict=True):
        angle = np.deg2rad((slot + 0.5) * 360.0 / SLOTS)
        off = np.angle(mesh.centre * np.exp(-1j * angle))
        here = np.flatnonzero(np.isin(mesh.region, PHASE_A) & (np.abs(off) < np.pi / SLOTS))
        order = here[np.argsort(np.abs(mesh.centre[here]) * (-1.0 if case.at_bottom else 1.0))]
        has = np.cumsum(mesh.area[order]) * density
        chosen = order[: int(np.argmin(np.abs(has - case.turns))) + 1]
        turns.append(float(mesh.area[chosen].sum() * density))
        for k in chosen:
            figures = lines[mesh.at[k]].split()
            figures[3] = str(new)
            lines[mesh.at[k]] = " ".join(figures)
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    return float(np.mean(turns))


def circuit(resistance_ohm: float | None) -> str:
    """Phases in star, the cage's rings, and a path across the shorted turns."""
    short = resistance_ohm is not None
    rings = "\n".join(
        f"""
      {{ Region Rotor_Bar_{k} ; Branch {{{400 + k},{500 + k}}} ; }}
      {{ Region Ring_R_{k} ; Branch {{{400 + k},{400 + k % BARS + 1}}} ; }}
      {{ Region Ring_L_{k} ; Branch {{{500 + k},{500 + k % BARS + 1}}} ; }}"""
        for k in range(1, BARS + 1)
    )
    turns = (
        """
      { Region Turns_p ; Branch {103,104} ; }
      { Region Turns_m ; Branch {105,104} ; }
      { Region Path    ; Branch {103,105} ; }"""
        if short
        else ""
    )
    groups = "\n".join(
        f"  Ring_R_{k} = Region[{60_000 + k}] ; Rings_R += Region[Ring_R_{k}] ;\n"
        f"  Ring_L_{k} = Region[{70_000 + k}] ; Rings_L += Region[Ring_L_{k}] ;"
        for k in range(1, BARS + 1)
    )
    shorted = (
        f"""
  Turns_p = Region[{SHORTED[0]}] ;
  Turns_m = Region[{SHORTED[1]}] ;
  PhaseA += Region[{{Turns_p, Turns_m}}] ;
  Stator_Inds += Region[{{Turns_p, Turns_m}}] ;
  Stator_IndsP += Region[Turns_p] ;
  Stator_IndsN += Region[Turns_m] ;
  Path = Region[55551] ;
  Resistance_Cir += Region[Path] ;"""
        if short
        else ""
    )
    return f"""
Group {{
  DefineGroup[ Rings_R, Rings_L ] ;
  Input1 = Region[10001] ; Input2 = Region[10002] ; Input3 = Region[10003] ;
  L1 = Region[55561] ; L2 = Region[55562] ; L3 = Region[55563] ;
{groups}
  Resistance_Cir = Region[{{Rings_R}}] ;
  Inductance_Cir = Region[{{L1, L2, L3, Rings_L}}] ;{shorted}
  DomainZ_Cir = Region[{{Resistance_Cir, Inductance_Cir}}] ;
  DomainSource_Cir = Region[{{Input1, Input2, Input3}}] ;
  DomainZt_Cir = Region[{{DomainZ_Cir, DomainSource_Cir}}] ;
}}
Function {{
  Inductance[Region[{{L1, L2, L3}}]] = Ls ;
  Resistance[Rings_R] = R_endring_segment ;
  Inductance[Rings_L] = L_endring_segment ;
{f"  Resistance[Path] = {resistance_ohm:.9g} ;" if short else ""}
}}
Constraint {{
  {{ Name ElectricalCircuit ; Type Network ;
    Case Stator {{
      {{ Region Input1 ; Branch {{1,101}} ; }}
      {{ Region L1 ; Branch {{101,102}} ; }}
      {{ Region Stator_Ind_Ap ; Branch {{102,103}} ; }}{turns}
      {{ Region Stator_Ind_Am ; Branch {{2,{105 if short else 103}}} ; }}
      {{ Region Input2 ; Branch {{1,201}} ; }}
      {{ Region L2 ; Branch {{201,202}} ; }}
      {{ Region Stator_Ind_Bp ; Branch {{202,203}} ; }}
      {{ Region Stator_Ind_Bm ; Branch {{2,203}} ; }}
      {{ Region Input3 ; Branch {{1,301}} ; }}
      {{ Region L3 ; Branch {{301,302}} ; }}
      {{ Region Stator_Ind_Cp ; Branch {{302,303}} ; }}
      {{ Region Stator_Ind_Cm ; Branch {{2,303}} ; }}
    }}
    Case Cage {{{rings}
    }}
  }}
}}
"""


def command(mesh: Mesh, case: FieldCase, turns: float, periods: int, steps: int) -> list[str]:
    """Return how GetDP is called; numbers of the model that are set are told by name."""
    area = float(mesh.area[np.isin(mesh.region, PHASE_A)].sum())
    copper_ohm = LENGTH_M * (2 * TURNS_PER_PHASE) ** 2 / area / CONDUCTIVITY
    numbers = {
        "NbrPolesInModel": POLES,
        "Flag_AnalysisType": 1,
        "Flag_ImposedSpeed": 2,
        "myrpm": case.rpm,
        "NbrPeriod": periods,
        "NbSteps": steps,
        "Flag_NL": 0,
        "Flag_Cir_RotorCage": 1,
        "Flag_PrintFields": 0,
        "Factor_R_3DEffects": RESISTANCE_OHM / copper_ohm,
        # The model divides the turns by the area that is left to phase a: their density stays.
        "Ns": TURNS_PER_PHASE - turns,
        "Va": UNBALANCE * PHASE_VOLTAGE_V * np.sqrt(2),
    }
    return [
        program("getdp"),
        "im_3kW_orig.pro",
        "-msh",
        "this.msh",
        *told(numbers),
        "-solve",
        "Analysis",
        "-v",
        "2",
    ]


def program(name: str) -> str:
    """Return where a program is installed."""
    found = which(name)
    if found is None:
        raise SystemExit(f"{name} is not installed")
    return found


def told(numbers: Mapping[str, float]) -> list[str]:
    """Return numbers as GetDP and Gmsh are told them."""
    return [part for name, value in numbers.items() for part in ("-setnumber", name, f"{value:.12g}")]


def run(folder: Path, work: Path, case: FieldCase, *, periods: int = PERIODS, steps: int = STEPS) -> None:
    """Run one case in a folder of its own; GetDP appends its currents to `res` step by step."""
    mesh = prepared(folder, work)
    turns = with_shorted(mesh, case, work / "this.msh") if case.turns else 0.0
    if not case.turns:
        copy(work / "sound.msh", work / "this.msh")
    path_ohm = max(case.path_ratio * turns / TURNS_PER_PHASE * RESISTANCE_OHM, 1e-6)
    text = circuit(path_ohm if case.turns else None)
    (work / "im_3kW_circuit.pro").write_text(text, encoding="ascii")
    (work / "turns.txt").write_text(f"{turns!r}\n", encoding="ascii")
    subprocess.run(command(mesh, case, turns, periods, steps), cwd=work, check=True)


def steady(work: Path) -> tuple[Array, float]:
    """Read the last periods of a run, currents of a, b, c [A] and voltages [V], and the shorted turns."""
    rows = [np.loadtxt(work / "res" / f"{name}.dat")[:, 1] for name in ("Ia", "Ib", "Ic", "Ua", "Ub", "Uc")]
    least = min(len(row) for row in rows)
    samples = np.stack([row[:least] for row in rows])
    turns = float((work / "turns.txt").read_text(encoding="ascii"))
    return samples[:, -KEPT_PERIODS * STEPS :], turns
