"""Where the parameters of a motor come from, in words."""

from collections.abc import Mapping
from typing import Final

from core.machines.parameters import ParametersSource

SOURCES: Final[Mapping[ParametersSource, str]] = {
    ParametersSource.GIVEN: "given in the motors file",
    ParametersSource.COMMISSIONED: "estimated from a recorded start of this motor (mcc commission)",
    ParametersSource.DATA_SHEET: "from its data sheet (mcc parameters)",
    ParametersSource.TYPICAL: "typical of its rating: nobody measured this motor, so it is on watch at most",
}
"""As pages and reports say it."""
