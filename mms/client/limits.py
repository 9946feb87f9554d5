"""How much a client takes from a relay that keeps answering."""

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class ClientLimits:
    """Limits on exchanges that the timeout of a single request does not end.

    Parameters
    ----------
    names_s : float
        Longest time for the names of the logical devices, which is the first request, and for those of all
        variables of one device, listed part by part [s]. The default allows some 10 000 names over a serial
        line of 9600 baud, twice what a motor relay has.
    directory_s : float
        Longest time for the names of a device's data sets, listed part by part [s]. The default allows a
        thousand of them over a serial line of 9600 baud.
    listing_s : float
        Longest time for a listing of files that comes in parts [s]. The default allows some 5000 names over a
        serial line of 9600 baud.
    listed_files : int
        Largest number of files in one listing.
    bytes_per_s : float
        Least throughput of a download [byte/s]. A serial line of 9600 baud carries 960 bytes a second; the
        default leaves a tenth of it to a line that is shared or noisy.
    throughput_window_s : float
        Time over which the throughput is averaged [s]. It spans several requests, so that a pause at the
        relay or on the way ends nothing.
    command_termination_s : float
        Longest wait for the command termination of a control with enhanced security [s].
    loss_notice_s : float
        Wait, after a request that timed out, for the library's notice that the association was lost [s].
    """

    names_s: float = 300.0
    directory_s: float = 30.0
    listing_s: float = 300.0
    listed_files: int = 100_000
    bytes_per_s: float = 100.0
    throughput_window_s: float = 30.0
    command_termination_s: float = 10.0
    loss_notice_s: float = 0.1


DEFAULT_LIMITS: Final = ClientLimits()
