"""The page of take-over times, which is written section by section."""

from pathlib import Path

from benchmarks.reporting import Section, write_sections

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "takeover.md"
WAKE_UP = "wake-up"
PREAMBLE = """\
# Take-over times

Asked: how long until other hosts do the work of one that is lost, with what [several
hosts](../how-to/several-hosts.md) describes? One PostgreSQL server, one folder, a service, and beside it
two hosts of gateways (`mcc collect`), of workers (`mcc work`), or two more services (`mcc serve`). All are
real processes on one machine with two cores; the relays are six simulated ones.

A host is killed (SIGKILL), frozen (SIGSTOP), frozen while its transaction holds a row (which the server
ends after `transaction_idle_s`), or cut off from the database. It works again after the take-over. Time
runs from the fault until the first record of its relays is stored, or its job's recording is diagnosed. The
command ends with 1 unless each record was stored and diagnosed once. In these runs nothing was lost and
nothing came twice.

A loss is found by its lease (`lease_s`): medians are 28 to 33 s with a lease of 30 s, and 10 to 15 s with
10 s. A short lease also takes work from a host that is merely slow. **Not tried**: hosts on machines of
their own, and a network file system between them.
"""


def of_lease(lease_s: float) -> str:
    """Return the subject of the times with a lease."""
    return f"lease-{lease_s:g}"


def of_services(lease_s: float) -> str:
    """Return the subject of the times of services with a lease."""
    return f"services-{lease_s:g}"


ORDER = (of_lease(30.0), of_lease(10.0), of_services(30.0), of_services(10.0), WAKE_UP)
"""The sections of the page, in their order."""


def write(section: Section) -> None:
    """Put a section into the page; the others stay as they are."""
    write_sections(PAGE, PREAMBLE, ORDER, [section])
