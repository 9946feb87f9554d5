"""Raw sockets on a real pair of Ethernet interfaces, in a network namespace of the test's own."""

import subprocess
import sys

import pytest

from mms.goose import RawSocket, RawSocketError
from tests.mms.goose.network_namespace import IN_NAMESPACE, require_network_namespace

EXCHANGE = """
import subprocess
from dataclasses import replace
from mms.goose import RawSocket, decode_frame, encode_frame
from tests.mms.goose.blocks import BLOCK, frame

for words in ("link add left type veth peer name right", "link set left up", "link set right up"):
    subprocess.run(["ip", *words.split()], check=True)
with RawSocket("left") as sender, RawSocket("right", [BLOCK.destination]) as receiver:
    receiver.wait_at_most(0.05)
    sent = replace(frame(), source=sender.address)
    for _ in range(200):  # An interface that was just set up drops frames until its carrier is up.
        sender.send(encode_frame(sent))
        received = receiver.receive()
        if received is not None:
            break
    assert decode_frame(received) == sent
print("exchanged")
"""


def test_a_frame_crosses_a_pair_of_interfaces() -> None:
    require_network_namespace()
    done = subprocess.run(
        [*IN_NAMESPACE, sys.executable, "-c", EXCHANGE], capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.returncode) == ("exchanged\n", 0), done.stderr


def test_without_the_capability_it_says_which_is_missing() -> None:
    """In a user's namespace of its own a process has no rights over the machine's interfaces."""
    require_network_namespace()
    told = (
        "from mms.goose import RawSocket, RawSocketError\n"
        "try:\n    RawSocket('lo')\nexcept RawSocketError as error:\n    print(error)"
    )
    words = ["unshare", "--user", "--map-root-user", sys.executable, "-c", told]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout == (
        "lo: a raw socket needs the capability CAP_NET_RAW, which this process does not have\n"
    )


def test_an_interface_that_is_none_is_named() -> None:
    with pytest.raises(RawSocketError, match=r"nosuch0: expected a network interface .* lo"):
        RawSocket("nosuch0")
