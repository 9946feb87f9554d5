"""LDP.TXT and CLDP.TXT: the load profile, what was metered every so often, oldest first."""

from ied_sim.monitoring.journal import LoadRow
from ied_sim.texts.snapshot import DATE_LABELS, RelaySnapshot

LABELS = ("IA_MAG", "IB_MAG", "IC_MAG", "UBI_PCT", "VAVE", "P", "Q", "PF", "FREQ", "TCU")


def load_profile(snapshot: RelaySnapshot) -> bytes:
    lines = ["DATE       TIME          " + "".join(f"{label:>12}" for label in LABELS)]
    lines += [
        f"{snapshot.stamp(row.time_ns)}  " + "".join(f"{value:>12}" for value in _values(row))
        for row in snapshot.journal.load()
    ]
    return snapshot.report("LOAD PROFILE", lines)


def compressed_load_profile(snapshot: RelaySnapshot) -> bytes:
    rows = ([*snapshot.date_fields(row.time_ns), *_values(row)] for row in snapshot.journal.load())
    return snapshot.compressed((*DATE_LABELS, *LABELS), rows)


def _values(row: LoadRow) -> list[str]:
    """Currents [A], unbalance [%], line voltage [V], power [W, var], frequency, thermal image [%]."""
    seen = row.seen
    power = seen.complex_power_VA
    return [
        *(f"{abs(current):.3f}" for current in seen.currents_A),
        f"{100 * seen.unbalance:.2f}",
        f"{seen.voltage_V:.1f}",
        f"{power.real:.1f}",
        f"{power.imag:.1f}",
        f"{seen.power_factor:.3f}",
        f"{seen.frequency_Hz:.3f}",
        f"{100 * row.thermal_capacity:.1f}",
    ]
