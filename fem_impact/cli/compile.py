"""The command ``compile``: the kernels of the models turned into machine code before the first run."""

from fem_impact import RunOptions, load, replace_all, simulate
from fem_impact.cli.parser import Options
from fem_impact.cli.terminal import chosen_meter, print_answer
from fem_impact.fem.kernels import COMPILING

SCENE = "quick"
"""It yields, rubs and vibrates; a loop that it does not need takes a second of another first run."""


def compile(options: Options) -> int:
    """Run the scene in both models that are compiled and tell what compiling took."""
    scene = replace_all(load(SCENE), {"accuracy.levels": 1, "save.frames": 0})
    for fidelity in ("solid", "modal"):
        simulate(scene, fidelity, RunOptions(progress=chosen_meter(options)))
    took = COMPILING.wall
    text = f"compiled in {took:.0f} s; what is compiled is kept on disk\n"
    print_answer(options, {"compiling_s": took}, text)
    return 0
