"""The command ``cite``: what a paper that uses a run should cite, as BibTeX."""

from fem_impact.cli.parser import CommandParser, Options
from fem_impact.cli.scene_options import add_scene, changed_scene
from fem_impact.cli.terminal import print_answer
from fem_impact.options import FIDELITIES

ABOUT = (
    "Print as BibTeX what a paper that uses a run should cite: this program, the publication, and the papers "
    "behind the libraries, effects and model of the run."
)


def add_options(parser: CommandParser) -> None:
    """State the command and its options."""
    parser.state(cite, "fem-impact cite t5b --fidelity modal > impact.bib", about=ABOUT)
    add_scene(parser)
    parser.add_argument("--fidelity", choices=FIDELITIES, default="solid", help="of the run (default: solid)")


def cite(options: Options) -> int:
    """Print the entries behind a scene."""
    from fem_impact.answers.simulate import compiled
    from fem_impact.pages.bibliography import behind

    case = compiled(changed_scene(options.scene, options.changes), options.fidelity)
    found = behind(["cite", options.fidelity, *case.active])
    text = "\n\n".join(one.bibtex for one in found) + "\n"
    print_answer(options, [{"key": one.key, **one.fields} for one in found], text)
    return 0
