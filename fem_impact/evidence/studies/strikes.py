"""The first three strikes of rods that yield: finite elements beside the reduced model.

How long their rattle lasts is told by the reduced model and by rigid theory, each to the rest.
"""

from collections import Counter

from fem_impact import Scene, known, load, replace_all
from fem_impact.answers.report import Request, Sheet, StudyReport
from fem_impact.evidence.data import read_stated, scene_keys
from fem_impact.evidence.studies.declared import DeclaredSweep, Runs
from fem_impact.outcome.keys import Unknown, keys_of
from fem_impact.outcome.strikes import StrikeRecord, Strikes
from fem_impact.tables.table import Cell, Table

FOLLOWED = {
    "impact.slope": "0 deg",
    "impact.until": "3 strikes",
    "impact.v_t": "0 m/s",
    "accuracy.levels": 1,
    "accuracy.tip_size": "0.3 mm",
    "save.frames": 0,
}
"""What all scenes change of quick."""
SCENES = read_stated("studies/data/followed.toml")
LATER = read_stated("studies/data/followed_later.toml")
"""Scenes that no rule of the half-widths was chosen by."""
PARTS = ["tip", "tail", "tip"]
QUICK = ("75 degrees, 2.1 m/s",)
SPEED, SHARES = "approach_m_per_s", ("friction", "plastic")


def scene_of(name: str) -> Scene:
    """Return a scene of the study by its name."""
    return replace_all(load("quick"), FOLLOWED | scene_keys((SCENES | LATER)[name]))


def _scenes(request: Request) -> dict[str, Scene]:
    return {name: scene_of(name) for name in (QUICK if request.quick else SCENES | LATER)}


def _variants(name: str, scene: Scene) -> dict[str, tuple[Scene, str]]:
    """Return three strikes by finite elements and by modes, and all strikes by modes and by rigid theory."""
    meshed = replace_all(scene, {"strikes.fidelity": "solid for the first 3, then modal"})
    rest = replace_all(scene, {"impact.until": "rest"})
    return {
        "solid": (meshed, "solid"),
        "modal": (scene, "modal"),
        "modal-rest": (rest, "modal"),
        "rigid-rest": (rest, "rigid"),
    }


def _report(runs: Runs) -> StudyReport:
    """Return the speeds and shares of three strikes by both models, and how long all of them last."""
    whole = {name: {v: run.strikes for v, run in found.items()} for name, found in runs.items()}
    pairs = {name: (of["solid"], of["modal"]) for name, of in whole.items() if {"solid", "modal"} <= set(of)}
    both = {name: two for name, two in pairs.items() if all(_parts(one) == PARTS for one in two)}
    ends = {
        name: (known(of["modal-rest"].time), known(of["rigid-rest"].time))
        for name, of in whole.items()
        if all(variant in of and of[variant].end == "rests" for variant in ("modal-rest", "rigid-rest"))
    }
    findings = [
        f"Tip, tail, tip strike in this order by both models in {len(both)} of {len(pairs)} scenes; in "
        f"these they differ though the reduced model is certain of the part: {_wrong(pairs)}.",
        *_speeds(both),
        *_held_told(pairs),
        *_rattle(ends),
    ]
    return StudyReport(
        study="strikes",
        title="The first three strikes, and how long the rattle lasts",
        findings=findings,
        sheets=[
            Sheet(
                "strikes",
                "Speed of the second and third strike, m/s, with the half-width told of modes where it is "
                "certain what strikes; friction and plastic work of all three, of the first energy.",
                Table.of(_HEAD, [_row(name, *two) for name, two in pairs.items()]),
            ),
            Sheet(
                "held",
                "How many half-widths of modes hold the number by finite elements, of the strikes that are "
                "certain.",
                Table.of(("number", *(f"strike {number}" for number in (1, 2, 3))), _held_rows(pairs)),
            ),
            Sheet(
                "rest",
                "Time from the first strike to the rest, s, and the ratio of both.",
                Table.of(
                    ("scene", "modes", "rigid theory", "ratio"),
                    [(name, modal, rigid, rigid / modal) for name, (modal, rigid) in ends.items()],
                ),
            ),
        ],
        assumptions=[
            "Finite elements on one mesh, cells of 0.3 mm at tip and tail, whose own error is not told.",
            "All scenes are changes of the scene quick on a level plate; modes compute every strike.",
            f"The last {len(LATER)} scenes were drawn after the rules of the half-widths were chosen.",
        ],
    )


_HEAD = (
    "scene",
    *(f"{part}, {of}" for part in ("tail", "tip again") for of in ("elements", "modes", "half-width")),
    *(f"{share}, {of}" for share in SHARES for of in ("elements", "modes")),
)


def _parts(strikes: Strikes) -> list[str]:
    return [one.part for one in known(strikes.each)[: len(PARTS)]]


def _row(name: str, solid: Strikes, modal: Strikes) -> list[Cell]:
    row: list[Cell] = [name]
    for number in (2, 3):
        half = modal.half_width(number, SPEED)
        row += [known(of.each)[number - 1].approach for of in (solid, modal)]
        row.append(None if isinstance(half, Unknown) else half)
    for share in SHARES:
        row += [known(getattr(of, share)) / known(of.each)[0].before for of in (solid, modal)]
    return row


def _speeds(both: dict[str, tuple[Strikes, Strikes]]) -> list[str]:
    """Return how far the speeds of both models are apart, and how often the half-widths hold that."""
    found = []
    for number, part in ((2, "The tail"), (3, "The tip again")):
        off, held = list[float](), list[bool]()
        for solid, modal in both.values():
            own, other = (known(of.each)[number - 1].approach for of in (solid, modal))
            half = modal.half_width(number, SPEED)
            off.append(abs(other - own) / own)
            held += [] if isinstance(half, Unknown) else [abs(other - own) <= half]
        if off:
            found.append(
                f"{part} comes by modes within {max(off):.0%} of the speed by finite elements; of "
                f"{len(held)} half-widths told {sum(held)} hold it."
            )
    return found


def _wrong(pairs: dict[str, tuple[Strikes, Strikes]]) -> str:
    """Return the scenes in which another part strikes by finite elements, though modes are certain."""
    names = [
        name
        for name, (solid, modal) in pairs.items()
        if (sure := known(modal.certain)) and _parts(solid)[:sure] != _parts(modal)[:sure]
    ]
    return ", ".join(names) or "none"


def _held(pairs: dict[str, tuple[Strikes, Strikes]]) -> tuple[Counter[tuple[str, int]], ...]:
    """Return by key and number of the strike how many half-widths hold finite elements, of how many."""
    held, told = Counter[tuple[str, int]](), Counter[tuple[str, int]]()
    for solid, modal in pairs.values():
        for number, (own, other) in enumerate(zip(known(solid.each), known(modal.each), strict=False), 1):
            for key in keys_of(StrikeRecord):
                half = modal.half_width(number, key.name)
                if own.part == other.part and not isinstance(half, Unknown) and half > 0.0:
                    told[key.name, number] += 1
                    held[key.name, number] += abs(key.of(other) - key.of(own)) <= half
    return held, told


def _held_rows(pairs: dict[str, tuple[Strikes, Strikes]]) -> list[list[Cell]]:
    """Return a row a key: of each of the three strikes how many of how many half-widths hold."""
    held, told = _held(pairs)
    names = [key.name for key in keys_of(StrikeRecord) if any(told[key.name, number] for number in (1, 2, 3))]
    return [[name, *(f"{held[name, of]} of {told[name, of]}" for of in (1, 2, 3))] for name in names]


def _held_told(pairs: dict[str, tuple[Strikes, Strikes]]) -> list[str]:
    """Return how many half-widths of the second and third strike hold, by both groups of scenes."""
    sentences = []
    for scenes, called in ((SCENES, "the first"), (LATER, "the last")):
        group = {name: two for name, two in pairs.items() if name in scenes}
        counts = [sum(of[at] for at in of if at[1] > 1) for of in _held(group)]
        if counts[1]:
            sentences.append(
                f"Of {counts[1]} half-widths of the second and third strike of {called} {len(group)} scenes "
                f"{counts[0]} hold finite elements ({counts[0] / counts[1]:.0%})."
            )
    return sentences


def _rattle(ends: dict[str, tuple[float, float]]) -> list[str]:
    """Return between which factors rigid theory's rattle lasts longer than that of modes."""
    ratios = [rigid / modal for modal, rigid in ends.values()]
    if not ratios:
        return []
    factor = max(max(ratio, 1.0 / ratio) for ratio in ratios)
    return [
        f"The rattle of rigid theory lasts {min(ratios):.2g} to {max(ratios):.2g} times as long as that of "
        f"modes to the rest: within a factor of {factor:.2g} in {len(ratios)} scenes."
    ]


_SWEEP = DeclaredSweep(_scenes, _variants, _report)
plan, conclude = _SWEEP.plan, _SWEEP.conclude
