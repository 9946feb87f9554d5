"""Motors of different rating, the first the thesis's (Table 3.2)."""

from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate
from core.machines.stator_winding import StatorWinding, WindingKind

REFERENCE = Motor(
    "reference",
    Nameplate(rated_power_W=800.0, rated_voltage_V=380.0, rated_frequency_Hz=50.0, pole_pairs=2),
    MachineParameters(8.4, 8.2, 0.0328, 0.0328, 0.4377, 0.0229),
)
MEDIUM = Motor(
    "medium",
    Nameplate(rated_power_W=7_500.0, rated_voltage_V=400.0, rated_frequency_Hz=50.0, pole_pairs=2),
    MachineParameters(0.7384, 0.7402, 0.003045, 0.003045, 0.08273, 0.0343),
)
LARGE = Motor(
    "large",
    Nameplate(37_000.0, 400.0, 50.0, pole_pairs=2, connection=Connection.DELTA),
    MachineParameters(0.247, 0.1509, 0.002172, 0.002172, 0.05422, 0.37),
)
# Per unit of 300 kVA: R_s 0.01, R_r 0.009, X_ls 0.10, X_lr 0.11, X_m 3.5. The leakage X_ls is ten times R_s,
# as in most motors above 100 kW; in the three others it is 1.2 to 2.8 times R_s.
VERY_LARGE = Motor(
    "very large",
    Nameplate(250_000.0, 400.0, 50.0, pole_pairs=2, connection=Connection.DELTA),
    MachineParameters(0.016, 0.0145, 0.00051, 0.00056, 0.0119, 4.2),
)
ONE_LAYER = StatorWinding(WindingKind.CONCENTRIC, slots=36, layers=1)
"""A winding whose coils lie on their phase's axis, as the turns of the split winding do."""
ALL = (REFERENCE, MEDIUM, LARGE)
"""Without the very large one, which few tests need."""
