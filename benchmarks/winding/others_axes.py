"""Axes and linkages of coils against the star of slots of swat-em: python -m benchmarks.winding.others_axes.

swat-em (PyPI, 0.6.3) lays the windings out and gives the winding factor. It is not among this project's
requirements: run this where it is installed, with this repository on the path.
"""

from cmath import exp, phase
from math import degrees, pi

from swat_em import datamodel  # type: ignore[import-not-found]

from core.machines.stator_winding import StatorWinding, WindingKind

WINDINGS = (
    (24, 4, 5, 2), (36, 4, 8, 2), (48, 4, 10, 2), (54, 6, 8, 2), (36, 2, 15, 2), (36, 4, 9, 1), (36, 4, 9, 2),
    (72, 8, 8, 2), (24, 2, 10, 2), (27, 6, 4, 2), (30, 4, 6, 2), (45, 6, 7, 2), (54, 8, 6, 2),
)  # fmt: skip
"""Slots, poles, coil pitch in slots, layers."""
HEADER = "| slots/poles, pitch, layers | axes, deg | linkage | winding factor | axes apart | linkage apart |"


def compared(slots: int, poles: int, pitch: int, layers: int) -> str:
    """Return a row of the table."""
    winding = datamodel()
    winding.genwdg(Q=slots, P=poles, m=3, layers=layers, turns=1, w=pitch)
    factor = float(winding.get_fundamental_windingfactor()[0])
    phases = winding.get_phases()

    def side(number: int) -> complex:
        sign = 1.0 if number > 0 else -1.0
        return sign * exp(2j * pi * (poles // 2) * (abs(number) - 1) / slots)

    def sides(which: int) -> list[int]:
        return [number for layer in phases[which] for number in layer]

    axis, next_axis = (sum(side(number) for number in sides(which)) for which in (0, 1))
    sense = 1.0 if phase(next_axis / axis) > 0.0 else -1.0
    starts = phases[0][0] if layers == 2 else [number for number in sides(0) if number > 0]
    found = set()
    for start in starts:
        far = (abs(start) + pitch) * (-1 if start > 0 else 1)
        coil = (side(start) + side(far)) / 2.0
        found.add((round(sense * degrees(phase(coil / axis)), 6) + 0.0, round(abs(coil) / factor, 6)))
    theirs = sorted(found)
    ours = StatorWinding(WindingKind.LAP, slots, layers, pitch).coil_axes(poles // 2)
    apart = max(abs(a[0] - degrees(b.angle_rad)) for a, b in zip(theirs, ours, strict=True))
    linked = max(abs(a[1] - b.linkage) for a, b in zip(theirs, ours, strict=True))
    axes = ", ".join(f"{angle:+.1f}" for angle, _ in theirs)
    return (
        f"| {slots}/{poles}, {pitch}, {layers} | {axes} | {theirs[0][1]:.4f} | {factor:.4f} | {apart:.4f} "
        f"| {linked:.4f} |"
    )


if __name__ == "__main__":
    print(HEADER)
    print("| --- | --- | --- | --- | --- | --- |")
    for one in WINDINGS:
        print(compared(*one))
