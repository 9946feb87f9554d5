"""The speed of a recording as text for people."""

from collections.abc import Iterator

from core.speed.finding import SpeedFinding, SpeedSource, SpeedState


def speed_words(finding: SpeedFinding) -> Iterator[str]:
    """Yield the speed with its interval and source, what else is possible, and why."""
    if finding.speed_rpm is not None and finding.source is not None:
        words = f"{finding.speed_rpm:.1f} rpm"
        if finding.speed_rpm_ci95 is not None:
            low, high = finding.speed_rpm_ci95
            words += f" [{low:.1f}..{high:.1f}]"
        words += f", {finding.source.words}"
        if finding.source is SpeedSource.CURRENT and finding.model_speed_rpm is not None:
            words += f"; {finding.model_speed_rpm:.1f} rpm by the model"
        yield words
    if finding.state is SpeedState.ALTERNATIVES:
        yield "or, by the number of bars: " + ", ".join(
            f"{one.speed_rpm:.1f} rpm ({one.rotor_bars})" for one in finding.alternatives
        )
    yield from finding.reasons
