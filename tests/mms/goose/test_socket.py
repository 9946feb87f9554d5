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


TAGGED = """
import socket
import struct
import subprocess
from dataclasses import replace
from mms.goose import RawSocket, decode_frame, encode_frame
from tests.mms.goose.blocks import BLOCK, frame

SOL_PACKET, PACKET_AUXDATA, ALL_ETHERTYPES, VLAN_VALID = 263, 8, 3, 1 << 4

for words in ("link add left type veth peer name right", "link set left up", "link set right up"):
    subprocess.run(["ip", *words.split()], check=True)
with RawSocket("left") as sender, RawSocket("right", [BLOCK.destination]) as receiver:
    receiver.wait_at_most(10)
    wire = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, 0)
    wire.setsockopt(SOL_PACKET, PACKET_AUXDATA, 1)
    wire.bind(("right", ALL_ETHERTYPES))
    wire.settimeout(10)
    for number, tag in enumerate((None, 0, 7), start=10):
        sent = replace(frame(state_number=number), vlan_id=tag, vlan_priority=5)
        sender.send(encode_frame(sent))
        received = decode_frame(receiver.receive())
        assert (received.message, received.destination) == (sent.message, BLOCK.destination)
        while True:
            octets, ancillary, _, _ = wire.recvmsg(2048, 1024)
            if octets[12:14] == bytes.fromhex("88b8"):
                break
        ((_, _, told),) = ancillary
        status, _, _, _, _, information, _ = struct.unpack("IIIHHHH", told)
        print("none" if not status & VLAN_VALID else f"{information >> 13} {information & 0xFFF}")
"""


def test_frames_with_and_without_a_tag_cross_and_are_taken() -> None:
    """Linux tells the tag to a socket of all Ethertypes: it was on the wire."""
    require_network_namespace()
    done = subprocess.run(
        [*IN_NAMESPACE, sys.executable, "-c", TAGGED], capture_output=True, text=True, check=False
    )
    assert (done.stdout, done.returncode) == ("none\n5 0\n5 7\n", 0), done.stderr


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
