"""What the uncertain inputs do: each set again with one input changed, on the coarser mesh."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fem_impact.compare import Row
from fem_impact.outcome import KEY_TABLE, Num, Outcome, known
from fem_impact.scale import Failure, Job
from fem_impact.scene import replace_all

if TYPE_CHECKING:
    from fem_impact.scene import Scene

SHOWN = {
    "e": KEY_TABLE["e_paper"],
    "mu": KEY_TABLE["mu"],
    "Omega": KEY_TABLE["Omega_rad_per_s"],
    "E_ln/E_0": KEY_TABLE["E_ln_paper_over_E_0"],
    "E_lt/E_0": KEY_TABLE["E_lt_paper_over_E_0"],
    "E_r/E_0": KEY_TABLE["E_r_over_E_0"],
    "vibration/E_0": KEY_TABLE["E_vib_over_E_0"],
    "friction/E_0": KEY_TABLE["W_friction_over_E_0"],
}
STRONGER = 1.5  # hardness and tensile test of the two steels bound the yield stress within this factor
WIDER = 1.5


@dataclass(frozen=True, slots=True)
class Input:
    """An uncertain input: its name, what it is changed to, in words, and the changed keys of a scene."""

    name: str
    words: str
    changes: Callable[[Scene], dict[str, Any]]


def strengths(scene: Scene, factor: float) -> dict[str, Any]:
    """Return the changed keys of a scene whose steels have so many times the yield and ultimate stress."""
    bodies = {"projectile": scene.projectile.material, "barrier": scene.barrier.material}
    return {
        f"{body}.material.{key}": f"{factor * getattr(steel, key) / 1e6:.9g} MPa"
        for body, steel in bodies.items()
        for key in ("yield_stress", "ultimate_stress")
    }


INPUTS = (
    Input(
        "friction-low",
        "lowest friction of its interval",
        lambda s: {"surface.friction": s.surface.friction_low},
    ),
    Input(
        "friction-high",
        "highest friction of its interval",
        lambda s: {"surface.friction": s.surface.friction_high},
    ),
    Input(
        "yield",
        f"yield and ultimate stress of both steels times {STRONGER:g}",
        lambda s: strengths(s, STRONGER),
    ),
    Input(
        "rate", "no hardening with the strain rate", lambda s: {"effects": [*s.effects, "-rate-hardening"]}
    ),
    Input(
        "block",
        f"barrier block with {WIDER:g} times the margin around the fine zone",
        lambda s: {"accuracy.block_margin": f"{WIDER * s.accuracy.block_margin * 1e3:.9g} mm"},
    ),
)
# the same run read with other lever arms of the impulse: no run of its own
ARMS = {"arms-edge": "arms of the tip's edge radius", "arms-impulse": "arms of the impulse"}
WORDS = {i.name: i.words for i in INPUTS} | ARMS


def sensitivity_jobs(coarse: Job, out: Path) -> dict[str, Job]:
    """Return the coarser job with each input changed, by the input's name."""
    scenes = {i.name: replace_all(coarse.scene, i.changes(coarse.scene)) for i in INPUTS}
    names = {name: f"{coarse.name}-{name}" for name in scenes}
    return {name: Job(names[name], scene, out=out / names[name]) for name, scene in scenes.items()}


def sensitivity_rows(coarse: Outcome | Failure, changed: Mapping[str, Outcome | Failure]) -> list[Row]:
    """Return one row an input and quantity: set, input, quantity, base and changed value."""
    if not isinstance(coarse, Outcome):
        return []
    runs = {name: run for name, run in changed.items() if isinstance(run, Outcome)}
    rows = [
        _row(coarse, name, words, key.of(run)) for name, run in runs.items() for words, key in SHOWN.items()
    ]
    arms = {"arms-edge": coarse.restitution.edge, "arms-impulse": coarse.restitution.impulse}
    return rows + [
        _row(coarse, name, words, value)
        for name, read in arms.items()
        for words, value in (("e", read.e), ("E_ln/E_0", read.E_ln), ("E_lt/E_0", read.E_lt))
    ]


def _row(coarse: Outcome, name: str, quantity: str, changed: Num) -> Row:
    return {
        "set": coarse.provenance.scene_id,
        "input": name,
        "quantity": quantity,
        "base": known(SHOWN[quantity].of(coarse)),
        "changed": known(changed),
    }


def explanations(comparison: Iterable[Row], sensitivities: Iterable[Row]) -> list[Row]:
    """Return, for each quantity outside its 95 % interval, what share of the miss each input makes up.

    A share of 1 brings the model to the measured mean; one below 0 takes it further away. Inputs that reach
    the interval could explain the miss, since they may lie anywhere up to what they were changed to. The
    change is that of the coarser mesh, carried over to the finer one's value.
    """
    found: dict[tuple[str, str], dict[str, float]] = {}
    for row in sensitivities:
        change = row["changed"] - row["base"]
        found.setdefault((row["set"], row["quantity"]), {})[row["input"]] = change
    measured = [row for row in comparison if row["measured_mean"] is not None]
    outside = [row for row in measured if row["verdict"] != "inside"]
    return [
        _explanation(row, found[key]) for row in outside if (key := (row["set"], row["quantity"])) in found
    ]


def _explanation(row: Row, changes: Mapping[str, float]) -> Row:
    model, mean = row["model"], row["measured_mean"]
    edge = row["measured_low"] if model < row["measured_low"] else row["measured_high"]
    shares = {name: change / (mean - model) for name, change in changes.items()}
    enough = (edge - model) / (mean - model)
    return {
        "set": row["set"],
        "quantity": row["quantity"],
        "model": model,
        "measured_mean": mean,
        "shares": shares,
        "could": [name for name, share in shares.items() if share >= enough],
    }
