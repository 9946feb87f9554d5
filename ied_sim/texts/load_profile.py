"""LDP.TXT and CLDP.TXT: the load profile, which is what was metered at intervals, oldest first."""

from ied_sim.monitoring.journal import LoadRow
from ied_sim.texts.snapshot import DATE_LABELS, RelaySnapshot

LABELS = ("IA_MAG", "IB_MAG", "IC_MAG", "UBI_PCT", "VAVE", "P", "Q", "PF", "FREQ", "TCU")


def load_profile(snapshot: RelaySnapshot) -> bytes:
    """Make LDP.TXT."""
    lines = ["DATE       TIME          " + "".join(f"{label:>12}" for label in LABELS)]
    lines += [
        f"{snapshot.stamp(row.time_ns)}  " + "".join(f"{value:>12}" for value in _values(row))
        for row in snapshot.journal.load()
    ]
    return snapshot.report("LOAD PROFILE", lines)


def compressed_load_profile(snapshot: RelaySnapshot) -> bytes:
    """Make CLDP.TXT."""
    rows = ([*snapshot.date_fields(row.time_ns), *_values(row)] for row in snapshot.journal.load())
    return snapshot.compressed((*DATE_LABELS, *LABELS), rows)


def _values(row: LoadRow) -> list[str]:
    """Return currents [A], unbalance [%], line voltage [V], power [W, var], frequency, thermal image [%]."""
    metering = row.metering
    power = metering.complex_power_VA
    return [
        *(f"{abs(current):.3f}" for current in metering.currents_A),
        f"{100 * metering.unbalance:.2f}",
        f"{metering.voltage_V:.1f}",
        f"{power.real:.1f}",
        f"{power.imag:.1f}",
        f"{metering.power_factor:.3f}",
        f"{metering.frequency_Hz:.3f}",
        f"{100 * row.thermal_capacity:.1f}",
    ]
