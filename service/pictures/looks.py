"""Colours of pictures: fixed ones for mails and reports, those of the page's own style sheet for pages.

What is normal is grey. Watch, fault and unknown differ in colour, in the shape of their marks and in words,
so a picture without colours tells the same.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Look:
    """Colours by what they are for.

    ink: what matters.  muted: axes, and what is normal.  line: the grid.  band: areas behind.  surface: the
    background; "none" shows that of the page.
    """

    ink: str
    muted: str
    line: str
    band: str
    surface: str
    watch: str
    fault: str
    unknown: str
    accent: str

    def of_state(self, state: str) -> str:
        """Return the colour of a motor's state; that of what is normal for any other word."""
        return {"watch": self.watch, "fault": self.fault, "unknown": self.unknown}.get(state, self.ink)


PRINT = Look(
    ink="#1f2933",
    muted="#66737f",
    line="#e4e7eb",
    band="#eef1f4",
    surface="#ffffff",
    watch="#b7791f",
    fault="#c53030",
    unknown="#52708f",
    accent="#2b5c8a",
)
"""For mails and reports, on white."""

PAGE = Look(
    ink="var(--ink)",
    muted="var(--muted)",
    line="var(--line)",
    band="var(--band)",
    surface="none",
    watch="var(--watch)",
    fault="var(--fault)",
    unknown="var(--unknown)",
    accent="var(--accent)",
)
"""For a picture inside a page, light or dark: the page's style sheet has these properties."""
