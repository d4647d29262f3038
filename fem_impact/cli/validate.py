"""The command ``validate``: a scene beside its own tests, and which input is worth measuring better."""

from contextlib import closing
from typing import Any

from fem_impact.answers.refine.level_meshes import LevelMeshes
from fem_impact.answers.v_and_v import LEVEL, TERMS
from fem_impact.answers.validate import Validation
from fem_impact.answers.validate import validate as validated
from fem_impact.case.case import Case
from fem_impact.cli.parser import Options
from fem_impact.cli.scene_options import asked_scene, command_line
from fem_impact.cli.terminal import chosen_meter, print_answer
from fem_impact.cli.values import read_all
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown, known, or_none
from fem_impact.progress import range_text
from fem_impact.run.tests import unused_columns
from fem_impact.tables.table import Table
from fem_impact.tables.text import wrapped


def validate(options: Options) -> int:
    """Compare a scene with its tests and print errors, their uncertainties and what these are made of."""
    scene = asked_scene(options)
    intervals: dict[str, Any] = read_all(options.uncertain, "--uncertain")
    with closing(chosen_meter(options)) as meter:
        kept = RunOptions(progress=meter)
        fidelities = {"fidelity": options.fidelity, "inputs_by": options.inputs_by}
        found = validated(scene, intervals or None, samples=options.samples, options=kept, **fidelities)
    line = f"{command_line(options, 'validate', 'uncertain')} --fidelity solid"
    solid = range_text(*LevelMeshes.of(Case(scene)).whole_s), line
    names = [one.quantity for one in found.comparisons]
    shares = dict(zip((*found.inputs, "tests", "model"), found.shares.tolist(), strict=True))
    document = {
        "comparisons": [
            {name: getattr(one, name) for name in ("quantity", *TERMS, "verdict")}
            for one in found.comparisons
        ],
        "not_known": dict(found.unknown),
        "shares": {key: dict(zip(names, row, strict=True)) for key, row in shares.items()},
        "joint": {
            "numbers": found.joined,
            "distance": or_none(found.distance),
            "p": or_none(found.p),
            "reason": found.p.reason if isinstance(found.p, Unknown) else None,
        },
        "measure_better": found.better[0],
        "inputs_by": found.varied,
    }
    print_answer(options, document, _text(found, options.fidelity, solid, unused_columns(scene)))
    return 0


def _text(found: Validation, fidelity: str, solid: tuple[str, str], notes: list[str]) -> str:
    """Return the answer; ``solid`` are the time and the command of finite elements."""
    parts = [
        (key, *(f"{100 * share:.0f} %" for share in row))
        for key, row in zip((*found.inputs, "tests", "model"), found.shares.tolist(), strict=True)
    ]
    names = tuple(one.quantity for one in found.comparisons)
    joint = f"Jointly ({', '.join(found.joined)}): "
    if isinstance(found.p, Unknown):
        joint += f"the distance is not known: {found.p.reason}."
    else:
        joint += f"distance squared {known(found.distance):.3g}, p = {found.p:.2g} that "
        joint += "a model without error would be as far away."
    doubt = (
        f"{', '.join(found.doubtful)}: the {found.varied} model, in which the inputs were varied, is off the "
        f"{fidelity} one by more than 2 u_val, so that u_input may be wrong. Give another --inputs-by."
    )
    sentences = [joint, *[doubt] * bool(found.doubtful)]
    sentences += [f"{name} is not compared: {why}" for name, why in found.unknown.items()]
    sentences += notes
    return "\n".join(
        [
            *_better(found, fidelity, solid),
            "",
            f"ASME V&V 20, {fidelity}; {found.runs} {found.varied} runs over the uncertain inputs",
            "",
            found.table().markdown(),
            "",
            "parts of u_val squared",
            "",
            Table.of(("of", *names), parts).markdown(),
            "",
            *(line for sentence in sentences for line in wrapped(sentence)),
            "",
        ]
    )


def _better(found: Validation, fidelity: str, solid: tuple[str, str]) -> list[str]:
    """Return what to know better; ``solid`` are the time and the command of finite elements."""
    name, part = found.better
    holds = f"holds {100 * part:.0f} % of u_val squared, mean of the numbers"
    if name != "model":
        return wrapped(f"Measure better: {name}. It {holds}.")
    together = not isinstance(found.p, Unknown) and found.p < LEVEL
    refuted = together or any(one.in_error for one in found.comparisons)
    begin = "T" if refuted else "Little can be refuted: t"
    if fidelity == "modal":
        what = f"{begin}he error told of the reduced model {holds}."
        return [*wrapped(f"{what} Finite elements know more, in {solid[0]} of computing:"), f"  {solid[1]}"]
    return wrapped(
        f"{begin}he band of the meshes {holds}. A smaller one: --set accuracy='5 %'; "
        "`fem-impact cost` says what it takes."
    )
