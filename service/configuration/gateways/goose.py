"""The table [gateways.goose]."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Interface = Annotated[str, StringConstraints(pattern=r"^[^\s/:]{1,15}$")]
Reference = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_]{1,64}/[A-Za-z0-9_.]{1,64}$")]


class GooseTrigger(BaseModel):
    """A signal that has motors recorded when it rises.

    signal: its reference in the SCD, "A1_SEL710CON/RBGGIO1.SPCSO02".  motors: empty for those of the relay
    that sends it.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    signal: Reference
    motors: tuple[Annotated[str, Field(min_length=1, max_length=200)], ...] = ()


class GooseSettings(BaseModel):
    """What is received, and what it does. Nothing is sent.

    interface: network interface that GOOSE comes in on.  trips: whether trips of relays raise alarms.
    simulated: whether messages of test sets count.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    interface: Interface
    trips: bool = True
    triggers: tuple[GooseTrigger, ...] = Field(default=(), max_length=1000)
    simulated: bool = False
