"""A control block of a relay, its frames, and strategies for them."""

from dataclasses import replace

from hypothesis import strategies as st

from mms.goose import GooseFrame, GooseMessage, SubscribedBlock
from mms.values import BitString, Timestamp, Value

NOW_NS = 1_760_000_000 * 10**9
BLOCK = SubscribedBlock(
    reference="A1_SEL710CFG/LLN0$GO$GPub01",
    data_set="A1_SEL710CFG/LLN0$DSet04",
    goose_id="A1_SEL710",
    configuration_revision=3,
    entries=1,
    destination=bytes.fromhex("010ccd010001"),
    application_id=0x3001,
)
MESSAGE = GooseMessage(
    control_block=BLOCK.reference,
    time_allowed_to_live_ms=2000,
    data_set=BLOCK.data_set,
    goose_id=BLOCK.goose_id,
    time=Timestamp(NOW_NS),
    state_number=5,
    sequence_number=0,
    simulation=False,
    configuration_revision=3,
    needs_commissioning=False,
    values=(False,),
)
SOURCE = bytes.fromhex("020000000001")


def frame(**changes: object) -> GooseFrame:
    """A frame of the block; changes are fields of its message."""
    message = replace(MESSAGE, **changes)  # type: ignore[arg-type] # fields by name
    return GooseFrame(BLOCK.destination, SOURCE, BLOCK.application_id, message)


def _structures(values: st.SearchStrategy[Value]) -> st.SearchStrategy[Value]:
    return st.lists(values, max_size=4).map(tuple)


numbers = st.integers(0, 2**32 - 1)
names = st.text(st.characters(min_codepoint=0x20, max_codepoint=0x7E), max_size=129)
times = st.builds(Timestamp.of, st.binary(min_size=8, max_size=8))
values = st.recursive(
    st.booleans()
    | st.integers(-(2**31), 2**31 - 1)
    # The peer cannot round values close to the largest of 32 bits.
    | st.floats(-(2.0**120), 2.0**120, width=32)
    | st.sampled_from((float("inf"), float("-inf")))
    | st.text(max_size=20)
    | st.binary(max_size=20)
    | times
    | st.lists(st.booleans(), max_size=20).map(lambda bits: BitString(tuple(bits))),
    _structures,
    max_leaves=10,
)
messages = st.builds(
    GooseMessage,
    control_block=names,
    time_allowed_to_live_ms=numbers,
    data_set=names,
    goose_id=st.none() | names,
    time=times,
    state_number=numbers,
    sequence_number=numbers,
    simulation=st.booleans(),
    configuration_revision=numbers,
    needs_commissioning=st.booleans(),
    values=st.lists(values, max_size=8).map(tuple),
)
addresses = st.binary(min_size=6, max_size=6)
frames = st.builds(
    GooseFrame,
    destination=addresses,
    source=addresses,
    application_id=st.integers(0, 2**16 - 1),
    message=messages,
    vlan_id=st.integers(0, 4095),
    vlan_priority=st.integers(0, 7),
    simulated=st.booleans(),
) | st.builds(
    GooseFrame,
    destination=addresses,
    source=addresses,
    application_id=st.integers(0, 2**16 - 1),
    message=messages,
)
