"""Whether currents and voltages belong together: every channel there, in its place, the right way round.

The diagnosis's own checks, on the part of the record in which the motor turns. Where the voltages were there
all along, only the phase of the currents tells their delay, and a delay of half a cycle looks like currents
reversed, one of a third like phases exchanged in a ring: then the motor can be estimated all the same
(core.commissioning.plausibility says what it may be).
"""

from dataclasses import replace
from math import ceil

from core.commissioning.errors import CommissioningError
from core.commissioning.prior import prior_of
from core.machines.parameters import Motor, Nameplate
from core.quality import wired_well
from core.quantity_text import plain
from core.signals.terminals import Terminals

INRUSH_CYCLES = 1.0
"""After the switching, left out: in them the currents' direct part is greatest."""
SUM_OF_A_START = 0.3
"""Sum of the currents, over one of them: transformers that the direct part saturates leave one, whatever the
wiring; what is beyond it is a channel's ratio."""


def check_wiring(
    measured: Terminals, nameplate: Nameplate, source: str, *, onset: float, live: int, hint_s: float | None
) -> None:
    """Check that the channels are connected as a motor's can be.

    Parameters
    ----------
    measured : Terminals
        Quantities at the terminals.
    nameplate : Nameplate
        Rated values of the motor.
    source : str
        Name of the recording, for messages.
    onset : float
        Sample at which the current begins.
    live : int
        Sample at which the voltage begins.
    hint_s : float or None
        T_d between the two [s], None where the voltage was there before.

    Raises
    ------
    CommissioningError
        If they are connected as no motor's can be.
    """
    if measured.voltage_ab is None:
        raise ValueError("wiring can only be checked of a record with voltages")
    rate = measured.sample_rate_hz
    shift = 0 if hint_s is None else round(hint_s * rate)
    first = max(live, 0, -shift, ceil(onset - shift + INRUSH_CYCLES * rate / nameplate.rated_frequency_Hz))
    last = measured.current_abc.shape[1] - max(shift, 0)
    running = replace(
        measured,
        current_abc=measured.current_abc[:, first + shift : last + shift],
        voltage_ab=measured.voltage_ab[:, first:last],
        voltages=measured.voltages[:, first:last],
    )
    motor = Motor(source, nameplate, prior_of(nameplate, None).expected)
    for finding in wired_well(running, motor, timed=hint_s is not None):
        saturated = finding.name == "current sum" and finding.value <= SUM_OF_A_START
        if not finding.passed and not saturated:
            raise CommissioningError(
                source,
                finding.name,
                expected=f"currents and voltages of one motor, each in its place (limit {finding.limit:g} "
                f"{finding.unit})",
                found=f"{plain(finding.value)}: {finding.message}",
            )
