"""The picture of a confusion matrix."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from core.diagnosis.causes import IN_WORDS, Cause, Causes

OPEN, TWO = "not told apart", "two causes"
mpl.use("Agg")
mpl.rcParams["svg.hashsalt"] = "classification"


class Answer(NamedTuple):
    """The truth, the likeliest explanation, and whether that is told."""

    truth: Causes
    likeliest: Causes
    told: bool


def draw_matrix(path: Path, truths: Sequence[Causes], answers: Sequence[Answer]) -> None:
    """Draw truths as rows and answers as columns, in percent of the row. truths: all that may be told."""
    columns = [*map(in_words, truths), TWO, OPEN]
    matrix = np.zeros((len(truths), len(columns)))
    for row, causes in enumerate(truths):
        own = [one for one in answers if one.truth == causes]
        for one in own:
            if not one.told:
                column = columns.index(OPEN)
            elif len(one.likeliest) > 1:
                column = columns.index(TWO)
            else:
                column = truths.index(one.likeliest)
            matrix[row, column] += 100.0 / len(own)
    figure = Figure(figsize=(9.0, 6.0), layout="constrained")
    axes = figure.subplots()
    axes.imshow(matrix, cmap="Blues", vmin=0.0, vmax=100.0)
    axes.set_xticks(range(len(columns)), columns, rotation=45.0, ha="right")
    axes.set_yticks(range(len(truths)), [in_words(one) for one in truths])
    axes.set_xlabel("answer")
    axes.set_ylabel("truth")
    for row, column in np.argwhere(matrix >= 0.5).tolist():
        share = matrix[row, column]
        axes.text(column, row, f"{share:.0f}", ha="center", va="center", color="w" if share > 50.0 else "k")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None})


def in_words(causes: Causes) -> str:
    """Return causes in words, "healthy" for none."""
    return " with ".join(IN_WORDS[one] for one in sorted(causes)) or IN_WORDS[Cause.HEALTHY]
