"""How a run is carried out: where its files go, who is told, how it is kept. None of it changes a number."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from fem_impact.progress import Notice, Progress

FIDELITIES = ("rigid", "modal", "solid")  # models of a scene, the cheapest first
CHECKPOINT_INTERVAL = 30.0  # s of wall time


@dataclass(frozen=True, slots=True)
class RunOptions:
    """Options of a run.

    Attributes
    ----------
    out : directory for the files of the run; None keeps the outcome only
    progress : called every few hundred steps of the solid fidelity; None shows the time left in IPython and
        notebooks, `fem_impact.silent` nothing
    resume : go on from the checkpoint in ``out`` (solid), bit for bit as if the run had never stopped;
        without one there, start at the beginning
    checkpoint_s : wall time between checkpoints of the solid fidelity, s
    stamp : scene and program that a checkpoint must be of; `fem_impact.run.simulate` fills it in
    """

    out: Path | None = None
    progress: Callable[[Progress | Notice], None] | None = None
    resume: bool = False
    checkpoint_s: float = CHECKPOINT_INTERVAL
    stamp: str = ""
