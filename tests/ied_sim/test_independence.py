"""The simulated motors know nothing of the models and methods that diagnose them."""

import subprocess
import sys

SHARED = (
    "core.error_words",
    "core.machines.motor_file",
    "core.machines.parameters",
    "core.machines.deep_bars",
    "core.machines.plausibility",
    "core.machines.sensors",
    "core.machines.stator_winding",
    "core.machines.typical",
    "core.quantity_text",
    "core.recordings",
    "core.table_layout",
    "core.units",
)
"""What simulator and diagnosis have in common: what a motor's file says, may say and leaves out, a file
format, units, and the words of errors and figures.
"""


def test_the_simulator_loads_nothing_of_the_diagnosis() -> None:
    program = "import sys, ied_sim.cli; print(*(name for name in sys.modules if name.startswith('core.')))"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    modules = set(loaded.stdout.split()) - {"core.machines"}
    assert "core.machines.parameters" in modules
    assert {name for name in modules if not name.startswith(SHARED)} == set()
