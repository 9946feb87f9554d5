"""A follower as a document, and back."""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from core.machines.parameters import Motor
from core.tracking.drift import Drift
from core.tracking.follower import Follower, Noise


def document_of(follower: Follower) -> dict[str, object]:
    """Return all that a follower knows, but its motor.

    Parameters
    ----------
    follower : Follower
        The follower.

    Returns
    -------
    dict of str to object
        What JSON takes.
    """
    return {
        "x": follower.x.tolist(),
        "P": follower.P[np.tril_indices(follower.x.size)].tolist(),
        "records": follower.records,
        "time_ns": follower.time_ns,
        "recorder": follower.recorder,
        "impedance_noise": asdict(follower.impedance_noise),
        "asymmetry_noise": asdict(follower.asymmetry_noise),
        "drop_mean": [follower.drop_mean.real, follower.drop_mean.imag],
        "drop_variance": follower.drop_variance,
        "drop_noise": follower.drop_noise,
        "loads": follower.loads,
        "drifts": [asdict(one) for one in follower.drifts],
    }


def follower_of(motor: Motor, document: Mapping[str, Any]) -> Follower:
    """Return the follower that a document is of.

    Parameters
    ----------
    motor : Motor
        Its motor.
    document : mapping of str to object
        What `document_of` returned.

    Returns
    -------
    Follower
        The follower.
    """
    x = np.array(document["x"])
    lower = np.zeros((x.size, x.size))
    lower[np.tril_indices(x.size)] = document["P"]
    loads = document["loads"]
    return Follower(
        motor=motor,
        x=x,
        P=lower + lower.T - np.diag(np.diag(lower)),
        records=document["records"],
        time_ns=document["time_ns"],
        recorder=document["recorder"],
        impedance_noise=Noise(**document["impedance_noise"]),
        asymmetry_noise=Noise(**document["asymmetry_noise"]),
        drop_mean=complex(*document["drop_mean"]),
        drop_variance=document["drop_variance"],
        drop_noise=document["drop_noise"],
        loads=None if loads is None else (loads[0], loads[1]),
        drifts=[Drift(**one) for one in document["drifts"]],
    )
