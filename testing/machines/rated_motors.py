"""Motors of 0.8 to 1,200 kW with 2 to 8 poles, as typical ones of their rating are: for statistics.

Figures of four poles are per unit of the winding's base impedance at the rated apparent power. Fewer poles
have more magnetising reactance and less leakage. The 0.8 and 7.5 kW motors of four poles are those of
`motors`, as good as.
"""

from math import pi

from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate

APPARENT_POWER = {0.8: 1.74, 7.5: 1.43, 37.0: 1.27, 160.0: 1.19, 1200.0: 1.14}
"""Rated apparent power over rated power."""
PER_UNIT = {
    0.8: (0.081, 0.079, 0.0994, 0.0994, 1.99, 0.0229),
    7.5: (0.0495, 0.0496, 0.0641, 0.0641, 2.61, 0.0343),
    37.0: (0.0242, 0.0148, 0.0668, 0.0668, 2.50, 0.37),
    160.0: (0.0220, 0.0150, 0.0990, 0.1050, 3.20, 3.0),
    1200.0: (0.0080, 0.0080, 0.1000, 0.1100, 3.50, 45.0),
}
"""R_s, R_r, X_ls, X_lr and X_m per unit, and the inertia [kg m^2], of four poles."""
MAGNETISING = {2: 1.3, 4: 1.0, 6: 0.85, 8: 0.72}
LEAKAGE = {2: 0.9, 4: 1.0, 6: 1.05, 8: 1.1}
"""Over those of four poles."""
POWERS_KW = tuple(PER_UNIT)
POLES = tuple(MAGNETISING)


def rated_motor(power_kW: float, poles: int = 4, connection: Connection = Connection.STAR) -> Motor:
    """A motor of one of POWERS_KW and of POLES; 400 V up to 160 kW, 6 kV above."""
    volts = 380.0 if power_kW < 1.0 else 400.0 if power_kW <= 160.0 else 6_000.0
    nameplate = Nameplate(power_kW * 1e3, volts, 50.0, poles // 2, connection)
    base = nameplate.base_impedance_ohm / APPARENT_POWER[power_kW]
    R_s, R_r, X_ls, X_lr, X_m, inertia = PER_UNIT[power_kW]
    w = 2 * pi * nameplate.rated_frequency_Hz
    return Motor(
        f"{power_kW:g} kW, {poles} poles",
        nameplate,
        MachineParameters.from_magnetising_inductance(
            stator_resistance_ohm=R_s * base,
            rotor_resistance_ohm=R_r * base,
            stator_leakage_H=X_ls * LEAKAGE[poles] * base / w,
            rotor_leakage_H=X_lr * LEAKAGE[poles] * base / w,
            magnetising_inductance_H=X_m * MAGNETISING[poles] * base / w,
            inertia_kgm2=inertia * (poles / 4) ** 2,
        ),
    )
