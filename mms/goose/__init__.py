"""GOOSE (IEC 61850-8-1 clause 18, annex A): frames, what a subscriber makes of them, how they are published.

Nothing here touches C, and only `socket` touches the network.
"""

from mms.goose.errors import GooseError, GooseFrameError, RawSocketError
from mms.goose.frame import ETHERTYPE, GooseFrame, decode_frame, encode_frame
from mms.goose.message import GooseMessage
from mms.goose.publisher import PublishedBlock, Publisher, PublisherThread
from mms.goose.socket import LONGEST_FRAME, RawSocket
from mms.goose.subscription import Reception, SubscribedBlock, Subscription

__all__ = [
    "ETHERTYPE",
    "LONGEST_FRAME",
    "GooseError",
    "GooseFrame",
    "GooseFrameError",
    "GooseMessage",
    "PublishedBlock",
    "Publisher",
    "PublisherThread",
    "RawSocket",
    "RawSocketError",
    "Reception",
    "SubscribedBlock",
    "Subscription",
    "decode_frame",
    "encode_frame",
]
