"""The command ``compile``: the kernels of the models turned into machine code before the first run."""

from fem_impact.cli.parser import CommandParser, Options
from fem_impact.cli.terminal import chosen_meter, print_answer

ABOUT = (
    "Compile the loops of finite elements and of the reduced model, which the first run would do otherwise. "
    "The scene `quick` is run with both. It takes half a minute after an installation or a change of the "
    "sources, and some seconds where all is compiled."
)
SCENE = "quick"
"""It yields, rubs and vibrates; a loop that it does not need takes a second of another first run."""


def add_options(parser: CommandParser) -> None:
    """State the command."""
    parser.state(compile_kernels, "fem-impact compile", about=ABOUT)


def compile_kernels(options: Options) -> int:
    """Run the scene in both models that are compiled and tell what compiling took."""
    from fem_impact import RunOptions, load, replace_all, simulate
    from fem_impact.fem.kernels import COMPILING

    scene = replace_all(load(SCENE), {"accuracy.levels": 1, "save.frames": 0})
    for fidelity in ("solid", "modal"):
        simulate(scene, fidelity, RunOptions(progress=chosen_meter(options)))
    took = COMPILING.wall
    text = f"compiled in {took:.0f} s; what is compiled is kept on disk\n"
    print_answer(options, {"compiling_s": took}, text)
    return 0
