"""The page of take-over times, which is written section by section."""

from pathlib import Path

from benchmarks.reporting import Section, write_sections

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "takeover.md"
WAKE_UP = "wake-up"
PREAMBLE = """\
# Take-over times

How long until other hosts do the work of one that is lost, with what [several
hosts](../how-to/several-hosts.md) describes: one PostgreSQL server, one folder, a service, and beside it
two hosts of gateways (`mcc collect`), then two of workers (`mcc work`); in the sections of services two more
services (`mcc serve`) in their place. All are real processes on one machine with two cores, which others
used too; the relays are six simulated ones.

- **Killed**: all processes of the host end by SIGKILL. It is started again after the take-over.
- **Frozen**: all of them stop by SIGSTOP, and go on after the take-over.
- **Frozen inside a transaction**: the same, and the database has given it the lock of a row: that of its
  gateway, as it renews its leases, or that of its job, as it stores the result. What others want of the row
  waits until the server has ended the transaction (`transaction_idle_s`, a third of the lease).
- **Cut off from the database**: its connections stand, and nothing passes. What was sent meanwhile arrives
  after the take-over.

What is counted begins with the fault.

- **Relays**: each relay that the host held makes a record right after the fault. The time ends when the
  first of them is stored.
- **Jobs**: the host has a job under way. The time ends when the recording of this job is diagnosed.

The service takes part, so others are two of three. After each fault the lost host has to work again. Then
each record that a relay made has to be stored once and diagnosed once, each queued recording diagnosed
once, and the job of the lost host begun twice. A host of workers that was frozen inside a transaction has
to say so in its log. Otherwise the command ends with 1. In the runs below nothing was lost, and nothing
came twice.

Who is lost is found by its lease (`lease_s`), so a shorter one shortens all times. It also makes a host
lose its work that is merely slow for so long. Hosts on machines of their own, with a network file system
between them, have not been tried.
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
