"""MSR.TXT, the motor start report, and MOT.TXT, the motor operating statistics."""

from collections.abc import Iterator

from ied_sim.monitoring.journal import LoggedStart
from ied_sim.texts.snapshot import RelaySnapshot


def motor_starts(snapshot: RelaySnapshot) -> bytes:
    """Make MSR.TXT: a summary of each of the last starts, newest first, then its current and voltage."""
    starts = snapshot.journal.starts()
    lines = [line for logged in starts for line in _start_lines(snapshot, logged)]
    return snapshot.report("MOTOR START REPORT", lines or ["No Motor Start Data Available"])


def _start_lines(snapshot: RelaySnapshot, logged: LoggedStart) -> Iterator[str]:
    start = logged.start
    lasted = "did not end" if start.duration_s is None else f"{start.duration_s:.2f} s"
    yield f"Date of start          {snapshot.stamp(logged.time_ns)}"
    yield f"Start time             {lasted}"
    yield f"Maximum start current  {start.current_A.max():.2f} A"
    yield f"Minimum start voltage  {start.voltage_V.min():.1f} V"
    yield ""
    yield "   TIME(s)     I(A)   I(%FLA)     V(V)"
    for time_s, current_A, voltage_V in zip(start.time_s, start.current_A, start.voltage_V, strict=True):
        share = 100 * current_A / snapshot.rated_current_A
        yield f"{time_s:>10.2f} {current_A:>8.2f} {share:>9.1f} {voltage_V:>8.1f}"
    yield ""


def motor_statistics(snapshot: RelaySnapshot) -> bytes:
    """Make MOT.TXT: running hours, starts, currents and trips."""
    found = snapshot.journal.statistics
    total_s = found.running_s + found.stopped_s
    share = 100 * found.running_s / total_s if total_s else 0.0
    mean_A = found.current_time_As / found.loaded_s if found.loaded_s else 0.0
    lines = [
        f"Since                      {snapshot.stamp(found.since_ns)}",
        f"Running time               {_hours(found.running_s)}",
        f"Stopped time               {_hours(found.stopped_s)}",
        f"Time running               {share:.1f} %",
        f"Number of starts           {found.starts}",
        f"Average running current    {mean_A:.2f} A",
        f"Peak running current       {found.highest_current_A:.2f} A",
        f"Peak start current         {found.highest_start_current_A:.2f} A",
        f"Longest start              {found.longest_start_s:.2f} s",
        f"Trips, overcurrent         {found.trips['overcurrent']}",
        f"Trips, current unbalance   {found.trips['unbalance']}",
        f"Trips, thermal overload    {found.trips['thermal']}",
    ]
    return snapshot.report("MOTOR OPERATING STATISTICS", lines)


def _hours(duration_s: float) -> str:
    minutes, seconds = divmod(int(duration_s), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{seconds:02d} (h:mm:ss)"
