"""`mcc parameters`: files, stdout and JSON, and what is said of a data sheet that cannot be."""

import json
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.machines.motor_file.reader import read_motor, read_plate
from core.machines.motor_file.writer import write_motor
from core.machines.parameters import ChannelNames, ParametersSource
from core.machines.stator_winding import StatorWinding, WindingKind
from service.cli import main
from testing.machines.motors import LARGE, REFERENCE

IMPEDANCES = ["--r1", "8.4", "--r2", "8.2", "--x1", "10.304", "--x2", "10.304", "--xm", "206.26"]
CATALOGUE = ["--efficiency", "94.2", "--power-factor", "0.87", "--rated-speed", "1480"]


@pytest.fixture
def plate(tmp_path: Path) -> Path:
    """The thesis's motor, in star."""
    return write_motor(tmp_path / "plate.toml", REFERENCE)


@pytest.fixture
def delta(tmp_path: Path) -> Path:
    """A motor of 37 kW in delta."""
    return write_motor(tmp_path / "delta.toml", LARGE)


def document(words: list[str], capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    assert main(["parameters", "--json", *words]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def test_impedances_in_ohm_give_the_thesis_motor(plate: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = document(["--nameplate", str(plate), *IMPEDANCES], capsys)
    assert found["parameters"]["stator_self_inductance_H"]["value"] == pytest.approx(0.4377, rel=1e-3)
    assert found["parameters"]["stator_leakage_H"]["value"] == pytest.approx(0.0328, rel=1e-3)
    assert found["magnetising_inductance_H"] == pytest.approx(0.65655, rel=1e-3)
    assert found["parameters_source"] == "data-sheet"
    assert found["warnings"] == []
    assert found["output"] is None


def test_without_an_output_the_file_goes_to_stdout(plate: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["parameters", "--nameplate", str(plate), *IMPEDANCES]) == 0
    printed = tomllib.loads(capsys.readouterr().out)
    assert printed["parameters"]["source"] == "data-sheet"
    assert set(printed["intervals"]) == set(printed["parameters"]) - {"source"}


def test_the_file_keeps_what_the_nameplate_file_has_beside(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = ChannelNames(currents=("I1", "I2", "I3"))
    plate = write_motor(tmp_path / "plate.toml", LARGE)
    plate.write_text(f'{plate.read_text("utf-8")}\n[channels]\nia = "I1"\nib = "I2"\nic = "I3"\n', "utf-8")
    output = tmp_path / "FAN.toml"
    words = ["--nameplate", str(plate), "--output", str(output), *CATALOGUE]
    assert main(["parameters", *words]) == 0
    shown = capsys.readouterr().out
    assert "rated speed" in shown
    assert max(map(len, shown.splitlines())) <= 80
    written = tomllib.loads(output.read_text("utf-8"))
    assert tuple(written["channels"].values()) == names.currents


def test_data_that_contradict_the_impedances_are_warned_of(
    delta: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    machine = LARGE.parameters
    w = LARGE.nameplate.rated_angular_frequency
    of_windings = {
        "--r1": machine.stator_resistance_ohm,
        "--r2": machine.rotor_resistance_ohm,
        "--x1": w * machine.stator_leakage_H,
        "--xm": w * machine.magnetising_inductance_H,
    }
    words = [word for name, value in of_windings.items() for word in (name, f"{value:.6g}")]
    words += ["--nameplate", str(delta), "--rated-current", "65"]
    assert document([*words, "--values", "winding"], capsys)["warnings"] == []
    # A third of the impedances: three times the current with the rotor locked.
    wrong = document([*words, "--values", "delta", "--locked-rotor-current", "7"], capsys)
    assert wrong["warnings"] == []
    star = document([*words, "--values", "star", "--locked-rotor-current", "7"], capsys)
    assert "locked-rotor current" in " ".join(star["warnings"])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "at least 3 figures"),
        (["--r1", "8.4", "--x1", "10.3"], "no --r2, --xm"),
        (["--values", "star", "--r1", "8.4"], "no --r2, --x1, --xm"),
        ([*IMPEDANCES, "--unit", "pu", "--base-VA", "1.1"], "is it in kVA? then 1100"),
        ([*IMPEDANCES, "--inertia", "1e9"], "inertia: expected"),
        ([*IMPEDANCES, "--terminal-resistance", "16.8"], "--r1 or --terminal-resistance, found both"),
        ([*IMPEDANCES, "--unit", "pu"], "--base-VA"),
        ([*IMPEDANCES, "--inertia", "0"], "inertia: expected a number above zero"),
        (["--efficiency", "0.95", "--power-factor", "0.8", "--rated-speed", "1420"], "found 0.95 %"),
    ],
)
def test_what_cannot_be_is_wrong_use_and_writes_nothing(
    plate: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    output = plate.with_name("out.toml")
    assert main(["parameters", "--nameplate", str(plate), "--output", str(output), *words]) == 2
    assert said in capsys.readouterr().err
    assert not output.exists()


def test_figures_that_no_motor_has_are_refused(plate: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = plate.with_name("out.toml")
    words = ["--r1", "0.0084", "--r2", "8.2", "--x1", "10.3", "--xm", "206"]
    assert main(["parameters", "--nameplate", str(plate), "--output", str(output), *words]) == 2
    assert "--r1, or by --terminal-resistance: expected" in capsys.readouterr().err
    assert not output.exists()


OF_LARGE = ["--power-factor", "0.88", "--rated-current", "66", "--efficiency", "92", "--rated-speed", "1480"]


def test_a_circuit_that_motors_do_not_have_is_warned_of_in_whole_lines(
    delta: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = delta.with_name("out.toml")
    words = ["--nameplate", str(delta), *OF_LARGE, "--locked-rotor-current", "14.9"]
    assert main(["parameters", *words, "--output", str(output)]) == 0
    shown = capsys.readouterr().out
    table, _, warnings = shown.partition("WARNING: ")
    assert "┘" in table
    said = " ".join(warnings.split())
    assert "motors have 3 to 12 times: check locked-rotor current (14.9)" in said
    assert "WARNING" not in table
    assert "WARNING: locked-rotor current" in output.read_text("utf-8")
    assert main(["parameters", *words]) == 0
    assert "mcc: warning: locked-rotor current: the circuit has" in capsys.readouterr().err


def test_a_file_that_is_there_is_kept_beside(delta: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = delta.with_name("out.toml")
    output.write_text("what was before", "utf-8")
    words = ["--nameplate", str(delta), *OF_LARGE, "--output", str(output)]
    assert document(words, capsys)["backup"] == str(output.with_name("out.toml.bak"))
    assert output.with_name("out.toml.bak").read_text("utf-8") == "what was before"
    assert main(["parameters", *words]) == 0
    assert f"{output} as it was: {output}.bak" in capsys.readouterr().out


def test_the_nameplate_is_never_replaced_by_what_is_kept(
    delta: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = delta.with_name("out.toml")
    output.write_text("what was before", "utf-8")
    plate = delta.rename(delta.with_name("out.toml.bak"))
    before = plate.read_text("utf-8")
    assert main(["parameters", "--nameplate", str(plate), *OF_LARGE, "--output", str(output)]) == 2
    assert "out.toml.bak: expected a file to write" in capsys.readouterr().err
    assert (output.read_text("utf-8"), plate.read_text("utf-8")) == ("what was before", before)


def test_an_efficiency_far_from_that_of_the_impedances_is_warned_of(
    plate: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--nameplate", str(plate), *IMPEDANCES, "--efficiency"]
    near, far = (document([*words, percent], capsys) for percent in ("72", "97"))
    assert near["warnings"] == []
    off = next(one["deviations"] for one in far["figures"] if one["name"] == "efficiency")
    assert off < -4.0
    assert far["warnings"][0].startswith("efficiency: the data sheet says 97 %")


NUMBERS = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.floats(0.01, 1e4),
    st.sampled_from([0.5, 0.86, 2.0, 2.5, 7.2, 95.2, 159.0, 1483.0, 1145.0, 1499.9999999]),
)
FIGURES = (
    "--efficiency",
    "--power-factor",
    "--rated-current",
    "--rated-speed",
    "--locked-rotor-current",
    "--locked-rotor-torque",
    "--breakdown-torque",
)
IN_RANGE = {
    "--efficiency": st.floats(30.0, 99.999),
    "--power-factor": st.floats(0.3, 0.999),
    "--rated-current": st.floats(59.0, 320.0),
    "--rated-speed": st.floats(1201.0, 1499.999),
    "--locked-rotor-current": st.floats(2.0, 15.0),
    "--locked-rotor-torque": st.floats(0.1, 8.0),
    "--breakdown-torque": st.floats(1.1, 8.0),
    "--terminal-resistance": st.floats(0.001, 1.0),
}
OTHERS = ("--r1", "--r2", "--x1", "--x2", "--xm", "--base-VA", "--terminal-resistance", "--temperature")
WORDS = st.one_of(
    st.dictionaries(st.sampled_from((*FIGURES, *OTHERS, "--inertia")), NUMBERS),
    st.fixed_dictionaries({}, optional=IN_RANGE),
    st.fixed_dictionaries(
        {name: st.floats(1e-4, 50.0) for name in ("--r1", "--r2", "--x1", "--xm")}, optional=IN_RANGE
    ),
)
SUPPRESSED = [HealthCheck.function_scoped_fixture, HealthCheck.too_slow]


@settings(max_examples=25, deadline=None, suppress_health_check=SUPPRESSED)
@given(figures=WORDS, options=st.sampled_from([[], ["--unit", "pu"], ["--values", "star"]]))
def test_no_figures_end_in_a_traceback(delta: Path, figures: dict[str, float], options: list[str]) -> None:
    words = [f"{name}={value!r}" for name, value in figures.items()]
    assert main(["parameters", "--nameplate", str(delta), *words, *options]) in (0, 2)


def test_a_winding_is_written_beside_the_parameters(plate: Path, tmp_path: Path) -> None:
    sheet = ["--winding", "lap", "--slots", "36", "--coil-pitch", "8"]
    output = tmp_path / "PUMP.toml"
    words = ["parameters", "--nameplate", str(plate), *IMPEDANCES, *sheet, "--output", str(output)]
    assert main(words) == 0
    assert read_motor(output).winding == StatorWinding(WindingKind.LAP, 36, 2, 8)
    assert read_motor(output).parameters_source is ParametersSource.DATA_SHEET


def test_a_winding_alone_leaves_the_parameters_as_they_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    intervals = {"inertia_kgm2": (0.02, 0.03)}
    plate = write_motor(tmp_path / "plate.toml", REFERENCE, intervals=intervals)
    found = document(["--nameplate", str(plate), "--winding", "concentric", "--slots", "24"], capsys)
    assert found["winding"] == {"kind": "concentric", "slots": 24, "layers": 2, "coil_pitch_slots": None}
    assert found["parameters"]["inertia_kgm2"]["ci95"] == [0.02, 0.03]
    assert found["parameters"]["stator_leakage_H"] == {"value": 0.0328, "ci95": None}
    output = tmp_path / "PUMP.toml"
    words = ["--nameplate", str(plate), "--winding", "concentric", "--slots", "24", "--layers", "1"]
    assert main(["parameters", *words, "--output", str(output)]) == 0
    assert "stator winding: concentric, 24 slots, one layer" in capsys.readouterr().out
    before, after = read_plate(plate), read_plate(output)
    assert after.winding == StatorWinding(WindingKind.CONCENTRIC, 24, 1)
    assert (after.parameters, after.source, after.intervals) == (
        before.parameters,
        before.source,
        before.intervals,
    )


def test_a_winding_of_the_file_is_kept_and_one_figure_of_it_changed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    winding = StatorWinding(WindingKind.LAP, 36, 2, 8)
    plate = write_motor(tmp_path / "plate.toml", replace(REFERENCE, winding=winding))
    assert document(["--nameplate", str(plate), *IMPEDANCES], capsys)["winding"] == {
        "kind": "lap",
        "slots": 36,
        "layers": 2,
        "coil_pitch_slots": 8,
    }
    pitch = document(["--nameplate", str(plate), "--coil-pitch", "7"], capsys)["winding"]["coil_pitch_slots"]
    assert pitch == 7
    other = document(["--nameplate", str(plate), "--slots", "48"], capsys)["winding"]
    assert (other["slots"], other["coil_pitch_slots"]) == (48, None)


@pytest.mark.parametrize(
    ("sheet", "words"),
    [
        (["--slots", "36"], "stator winding: expected --winding and --slots, found no --winding"),
        (["--winding", "lap"], "found no --slots"),
        (["--winding", "lap", "--slots", "35"], "--slots: expected a multiple of 3"),
        (["--winding", "lap", "--slots", "36", "--coil-pitch", "40"], "--coil-pitch: expected 1 to 18"),
        (["--winding", "wave", "--slots", "36"], "wave"),
        (["--winding", "lap", "--slots", "27", "--layers", "1"], "--slots: expected a multiple of 6"),
    ],
)
def test_a_winding_that_cannot_be_is_wrong_use(
    plate: Path, sheet: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["parameters", "--nameplate", str(plate), *sheet]) == 2
    assert words in capsys.readouterr().err
