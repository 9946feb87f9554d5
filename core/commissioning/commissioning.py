"""Commissioning: a motor's parameters, with intervals, from recordings of its starts (thesis chapter 5).

Each start is searched globally and refined from its best separated points. Then all starts are fitted
together; the load's law is chosen, and whether the motor changes from a start to running. At the end the
unknowns that the records do not identify are fixed and named in the result, and the others are fitted once
more.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from math import log
from time import perf_counter

import numpy as np

from core.commissioning.errors import DivergenceError
from core.commissioning.fit import COARSELY, CONVERGED, Fit, Records, every
from core.commissioning.fitted_result import fitted_result
from core.commissioning.identifiability import Unidentifiable, compensating, condition_number, unidentifiable
from core.commissioning.load_change import are_possible
from core.commissioning.model_choice import ROUGHLY, Chosen, choose
from core.commissioning.prior import PARAMETERS, Prior, prior_of
from core.commissioning.result import Commissioning
from core.commissioning.search import search
from core.commissioning.start import Start, thinned
from core.commissioning.start_detection import start_of
from core.commissioning.stepped_commissioning import commission_stepped
from core.commissioning.unknowns import OF_A_CHANGE, USUAL_CHANGE, Point
from core.machines.base import Array
from core.machines.candidates import LoadLaw
from core.machines.motor_file.reader import Plate
from core.numerical_threads import on_one_thread
from core.recordings import Recording

STARTING_POINTS = 6
"""Points of the global search from which the refinement begins."""

Progress = Callable[[float, str], None]


@on_one_thread
def commission(
    recordings: Sequence[Recording],
    plate: Plate,
    *,
    load_law: LoadLaw | None = None,
    span_s: tuple[float, float | None] = (0.0, None),
    progress: Progress | None = None,
) -> Commissioning:
    """Estimate a motor's parameters from recordings of its starts, all fitted together.

    Parameters
    ----------
    recordings : sequence of Recording
        Recordings of starts.
    plate : Plate
        What is known beforehand. The search is centred on its parameters, and what the records do not tell is
        taken from them; where it has none, values typical of the rating stand in.
    load_law : LoadLaw or None, optional
        How the load torque grows with speed; None chooses the one that fits.
    span_s : (float, float or None), optional
        Part of each record that is compared, after the motor is switched on [s].
    progress : callable or None, optional
        Called with the share that is done and with what is being done.

    Returns
    -------
    Commissioning
        Parameters with intervals, and what was found of each start.

    Raises
    ------
    RecordingError
        If a recording lacks channels.
    CommissioningError
        If a recording is no start, or none that a motor of this nameplate can make or its model can follow.
    """
    begun = perf_counter()
    report = progress or _no_progress
    prior = prior_of(plate.nameplate, plate.parameters, plate.wound_rotor)
    starts = [
        start_of(
            one,
            plate.nameplate,
            plate.channels,
            transformers=plate.transformers,
            span_s=span_s,
            by_steps=plate.wound_rotor is not None,
        )
        for one in recordings
    ]
    if not starts:
        raise ValueError("commissioning needs at least one recording of a start")
    stepped = None if plate.wound_rotor is None else commission_stepped(starts, plate, begun)
    if stepped is not None:
        return stepped
    vector, evaluations = _found(starts, prior, load_law or LoadLaw.CONSTANT, report)
    report(0.7, "choosing the law of the load")
    chosen = choose([thinned(one) for one in starts], prior, vector, load_law)
    report(0.8, "refining")
    try:
        records, whole, spent = _refined(starts, prior, chosen)
        fit, fixed = _fit_identifiable(records, whole)
        is_possible = chosen.steadily is None or are_possible(records, fit)
    except DivergenceError:
        if chosen.steadily is None:
            raise
        is_possible, spent = False, 0
    if chosen.steadily is not None and not is_possible:  # no change of the load explains the start
        chosen = chosen.steadily
        records, whole, more = _refined(starts, prior, chosen)
        fit, fixed = _fit_identifiable(records, whole)
        spent += more
    report(1.0, "done")
    return fitted_result(
        records,
        fit,
        fixed,
        plate,
        law_identified=chosen.law_identified,
        condition=condition_number(whole),
        evaluations=evaluations + spent + records.evaluations,
        seconds=perf_counter() - begun,
    )


def _refined(starts: list[Start], prior: Prior, chosen: Chosen) -> tuple[Records, Fit, int]:
    """Return the starts and their fit as they were chosen, and what that took beside the last fit."""
    records = Records(starts, prior, chosen.law, changes=chosen.changes, load_changes=chosen.load_changes)
    records, vector = _switched_on_again(records, chosen.fit.vector)
    near = records.fit(vector, every(vector), converged=ROUGHLY if chosen.changes else COARSELY)
    records, vector = _switched_on_again(records, near.vector)
    spent = chosen.evaluations + near.evaluations
    whole = records.fit(vector, every(vector), converged=COARSELY if chosen.changes else CONVERGED)
    return records, whole, spent


def _found(starts: list[Start], prior: Prior, law: LoadLaw, report: Progress) -> tuple[Array, int]:
    """Return a vector near the global minimum of all starts together; each start is searched on its own."""
    shared, own, evaluations = [], [], 0
    for k, start in enumerate(starts):
        records = Records([thinned(start)], prior, law)
        share = 0.7 / len(starts)
        report(k * share, f"searching {start.source}")
        candidates = search(records, most_points=STARTING_POINTS).vectors
        fits = []
        for number, candidate in enumerate(candidates):
            report((k + 0.3 + 0.6 * number / len(candidates)) * share, f"refining {start.source}")
            with suppress(DivergenceError):
                fits.append(records.fit(candidate, every(candidate), converged=COARSELY))
        if not fits:
            raise DivergenceError(start.source)
        best = min(fits, key=lambda fit: fit.squared_error)
        shared.append(best.vector[: len(PARAMETERS)])
        own.append(best.vector[len(PARAMETERS) :])
        evaluations += records.evaluations
    together = Records([thinned(start) for start in starts], prior, law)
    vectors = np.array([np.concatenate([one, *own]) for one in shared])
    best_of_all = vectors[int(np.argmin(together.squared_errors(vectors)))]
    return best_of_all, evaluations + together.evaluations


def _switched_on_again(records: Records, vector: Array) -> tuple[Records, Array]:
    """Return the starts with the switching instants that follow from the fitted fluxes, and their vector."""
    point = records.coordinates.point(vector)
    starts, own = [], point.starts.copy()
    for k, start in enumerate(records.starts):
        offset = float(own[k, 1])
        again = start.switched_on_again(own[k, 2:4], offset) if start.begins_with_the_start else start
        own[k, 2:4] = again.switching_flux(np.array([offset]))[0]
        starts.append(again)
    coordinates = records.coordinates
    moved = Records(
        starts,
        coordinates.prior,
        records.load_law,
        changes=coordinates.changes,
        load_changes=coordinates.load_changes,
    )
    return moved, moved.coordinates.vector(Point(point.machine, own, point.change))


def _fit_identifiable(records: Records, whole: Fit) -> tuple[Fit, list[Unidentifiable]]:
    """Fit the identifiable unknowns and fix the others at their expected values."""
    fixed: list[Unidentifiable] = []
    fit = whole
    names, prior = records.coordinates.names, records.coordinates.prior
    reach = np.array([log(prior.spread[name]) for name in PARAMETERS])
    while new := unidentifiable(records, fit) or (compensating(records, fit) if fixed else []):
        fixed += new
        vector, free = fit.vector.copy(), fit.free.copy()
        # Unidentifiable unknowns may have drifted anywhere and taken the others along, so the fit starts
        # again within the range that was searched.
        vector[: reach.size] = np.clip(vector[: reach.size], -reach, reach)
        for one in new:
            entry = names.index(one.name)
            vector[entry], free[entry] = _expected(one.name, records.starts), False
        fit = records.fit(vector, free)
    return fit, fixed


def _expected(name: str, starts: Sequence[Start]) -> float:
    """Return the coordinate at which an unknown is fixed.

    A parameter is fixed at its expected value, a change at the usual one, the load at none, and the delay at
    the one seen between the onsets of voltage and current, if there is one.
    """
    kind, _, number = name.partition("[")
    if kind in OF_A_CHANGE:
        return USUAL_CHANGE[OF_A_CHANGE.index(kind)]
    if kind != "time_offset_s":
        return 0.0
    start = starts[int(number.rstrip("]"))]
    return (start.offset_hint_s or 0.0) / start.cycle_s


def _no_progress(share: float, stage: str) -> None:
    del share, stage
