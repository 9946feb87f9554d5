"""SVG turned into PNG, for mail programs, few of which show SVG.

Typst does it, which brings fonts of its own: the same picture comes out on a machine without any, and reports
are made with it anyway. The picture is data to it, never part of its program.
"""

import typst

PAGE = b"""
#set page(width: auto, height: auto, margin: 0pt)
#image(bytes(sys.inputs.picture), format: "svg")
"""
PIXELS_PER_INCH = 144.0
"""Twice those of the SVG, for screens with small pixels."""


class PictureError(RuntimeError):
    """A picture could not be made."""


def png(svg: str) -> bytes:
    """Return a picture as PNG. Raises PictureError."""
    try:
        made = typst.compile(PAGE, format="png", ppi=PIXELS_PER_INCH, sys_inputs={"picture": svg})
    except (RuntimeError, ValueError) as error:
        raise PictureError(f"the picture cannot be turned into PNG: {error}") from error
    if not isinstance(made, bytes):
        raise PictureError("the picture cannot be turned into PNG: expected one page")
    return made
