"""Named arguments of the compiled functions.

numba takes a named tuple apart before the call, so a group of arrays costs no more than the arrays alone.
"""

from typing import NamedTuple

from core.machines.base import Array


class MachineRates(NamedTuple):
    """Coefficients that one machine, or a batch of machines, is stepped with.

    Parameters
    ----------
    decay : ndarray, shape (5, 5) or (candidates, 5, 5)
        Matrix of the flux's decay, -R inv(L) [1/s].
    current_from_flux : ndarray, shape (5, 5) or (candidates, 5, 5)
        Inverse of the inductances, inv(L) [1/H].
    load : ndarray, shape (3,) or (candidates, 3)
        Coefficients of T_load / p = l0 + l1 w + l2 w^2, w the electrical speed.
    gain : float
        Electrical acceleration over torque per pole pair, p^2 / J [1/(kg m^2)].
    """

    decay: Array
    current_from_flux: Array
    load: Array
    gain: float


class SteppedVoltage(NamedTuple):
    """Stator voltage and the columns of it that are stepped through.

    Parameters
    ----------
    voltage : ndarray, shape (columns, 2)
        Clarke voltages without delay [V].
    first, last : int
        Columns [first, last) are stepped through.
    step_s : float
        Time between two columns [s].
    substeps : int
        Columns in one sample of the record.
    angular_frequency : float
        Angular frequency w_s of the supply [rad/s].
    """

    voltage: Array
    first: int
    last: int
    step_s: float
    substeps: int
    angular_frequency: float


class InitialState(NamedTuple):
    """State at the first column that is stepped through.

    Parameters
    ----------
    flux : ndarray, shape (5, candidates)
        Flux of every circuit [V s].
    speed : ndarray, shape (candidates,)
        Electrical speed [rad/s].
    """

    flux: Array
    speed: Array


class Comparison(NamedTuple):
    """Measured current and the squared distance to it, which the stepping fills.

    Parameters
    ----------
    measured : ndarray, shape (samples, 2)
        Clarke currents at the samples of the record [A]; empty for no comparison.
    compare_from : int
        First column, counted from the first that is stepped through, whose distance counts.
    squared_error : ndarray, shape (candidates,)
        Sum of the squared distances [A^2].
    """

    measured: Array
    compare_from: int
    squared_error: Array


class Track(NamedTuple):
    """Currents and speeds that the stepping fills; both empty where they are not wanted.

    Parameters
    ----------
    current : ndarray
        Clarke currents [A], shape (candidates, 2, samples); in the kernel (2, columns, lanes).
    speed : ndarray
        Electrical speed [rad/s], shape (candidates, samples); in the kernel (columns, lanes).
    """

    current: Array
    speed: Array
