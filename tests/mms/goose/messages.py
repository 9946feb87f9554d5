"""Messages and frames that the tests begin with."""

from dataclasses import replace

from mms.goose import GooseFrame, GooseMessage, SubscribedBlock
from mms.values import Timestamp, Value

DESTINATION = bytes.fromhex("010ccd010005")
SOURCE = bytes.fromhex("0030a7123456")
BLOCK = SubscribedBlock(
    reference="A1_SEL710CFG/LLN0$GO$GPub01",
    data_set="A1_SEL710CFG/LLN0$DSet04",
    goose_id="A1_TRIP",
    configuration_revision=3,
    entries=2,
    destination=DESTINATION,
    application_id=0x0005,
)
MESSAGE = GooseMessage(
    control_block=BLOCK.reference,
    time_allowed_to_live_ms=3000,
    data_set=BLOCK.data_set,
    goose_id=BLOCK.goose_id,
    time=Timestamp(1_760_000_000_000_000_000),
    state_number=7,
    sequence_number=1,
    simulation=False,
    configuration_revision=BLOCK.configuration_revision,
    needs_commissioning=False,
    values=(False, 5),
)
FRAME = GooseFrame(DESTINATION, SOURCE, BLOCK.application_id, MESSAGE)


def frame(state: int, sequence: int, values: tuple[Value, ...] = (False, 5), **other: object) -> GooseFrame:
    """A frame of the block; `other` are fields of its message."""
    changed = {"state_number": state, "sequence_number": sequence, "values": values, **other}
    return replace(FRAME, message=replace(MESSAGE, **changed))  # type: ignore[arg-type]  # as the tests name them
