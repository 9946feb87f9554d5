"""The sampling rates of a COMTRADE record (5.3.6), each with the number of the last sample taken at it.

Some recorders write how many samples were taken at each rate instead. The data tell: they hold as many
samples as the numbers add up to.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import accumulate

from core.recordings.comtrade.lines import Line, Lines
from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs

MAX_SAMPLES = 9_999_999_999
MAX_RATES = 999

Rates = tuple[tuple[float, int], ...]
"""Rates [Hz] with the numbers of their last samples, ascending; none where time stamps are all there is."""


@dataclass(frozen=True, slots=True)
class RateLines:
    """The lines of the rates, as written.

    Parameters
    ----------
    announced : int
        Number of rates; 0 where the time stamps are the only time base.
    lines : tuple of Line
        One for each, and one where 0 are announced.
    """

    announced: int
    lines: tuple[Line, ...]


def rate_lines(lines: Lines, repairs: Repairs) -> RateLines:
    """Take the lines of the rates.

    Parameters
    ----------
    lines : Lines
        The lines of the file, up to these.
    repairs : Repairs
        Collects what departs from the standard.

    Returns
    -------
    RateLines
        The lines.

    Raises
    ------
    RecordingError
        If there are fewer than announced, or their second field is no number of a sample.
    """
    announced = lines.next("number of sampling rates").of(1, repairs=repairs).integer(0, "", 0, MAX_RATES)
    numbered = [f"sampling rate {k} and last sample" for k in range(1, announced + 1)]
    what = numbered if announced > 1 else ["sampling rate and last sample"]
    taken = []
    for one in what:
        line = lines.next(one).of(2, repairs=repairs)
        line.integer(1, "last sample", 0, MAX_SAMPLES)
        taken.append(line)
    return RateLines(announced, tuple(taken))


def settled_rates(written: RateLines, held: Callable[[], int], repairs: Repairs) -> tuple[Rates, int]:
    """Return the rates with their last samples, and the number of samples.

    A lenient reader leaves out rates at which no sample was taken.

    Parameters
    ----------
    written : RateLines
        The lines.
    held : callable
        Number of samples in the data; called where there are several rates.
    repairs : Repairs
        Collects what was mended, and what departs from the standard.

    Returns
    -------
    rates : tuple of (float, int)
        The rates.
    samples : int
        Number of samples.

    Raises
    ------
    RecordingError
        If the numbers are no last samples.
    """
    if written.announced == 0:
        (line,) = written.lines
        samples = line.integer(1, "last sample", 1, MAX_SAMPLES)
        if line.real(0, "sampling rate [Hz]") != 0:
            raise line.refuse(
                "sampling rate [Hz]", "0, as the file announces 0 rates", quoted(line.fields[0])
            )
        return (), samples
    return _by_counts(written, held, repairs) or _by_last_samples(written, repairs)


def _by_counts(written: RateLines, held: Callable[[], int], repairs: Repairs) -> tuple[Rates, int] | None:
    """Where the numbers are those of samples at each rate; None where they are not, or may be either."""
    if written.announced < 2:
        return None
    counts = [line.integer(1, "last sample", 0, MAX_SAMPLES) for line in written.lines]
    lasts = list(accumulate(counts))
    if 0 in counts or held() != lasts[-1]:
        return None
    first = written.lines[0]
    repairs.warn(
        first.warned(
            f"the numbers of samples of {len(counts)} rates, {', '.join(map(str, counts))}, add up to the "
            f"{lasts[-1]} in the data: read as counts, not as last samples"
        )
    )
    return tuple(zip(map(_rate, written.lines), lasts, strict=True)), lasts[-1]


def _by_last_samples(written: RateLines, repairs: Repairs) -> tuple[Rates, int]:
    rates: list[tuple[float, int]] = []
    for line in written.lines:
        before = rates[-1][1] if rates else 0
        try:
            last = line.integer(1, "last sample", before + 1, MAX_SAMPLES)
        except RecordingError as fault:
            if written.announced < 2 or line.integer(1, "last sample", 0, MAX_SAMPLES) not in (0, before):
                raise
            repairs.mend(fault, "left out, as no sample was taken at this rate")
            continue
        rates.append((_rate(line), last))
    if not rates:
        raise written.lines[-1].refuse("last sample", "at least one sample at one of the rates", "none")
    return tuple(rates), rates[-1][1]


def _rate(line: Line) -> float:
    return line.positive(0, "sampling rate [Hz]", 1e-3, 1e9)
