"""The command ``cite``: what a paper that uses a run should cite, as BibTeX."""

from fem_impact.cli.parser import Options
from fem_impact.cli.scene_options import asked_scene
from fem_impact.cli.terminal import print_answer


def cite(options: Options) -> int:
    """Print the entries behind a scene."""
    from fem_impact.answers.simulate import compiled
    from fem_impact.pages.bibliography import behind

    case = compiled(asked_scene(options), options.fidelity)
    found = behind(["cite", options.fidelity, *case.active])
    text = "\n\n".join(one.bibtex for one in found) + "\n"
    print_answer(options, [{"key": one.key, **one.fields} for one in found], text)
    return 0
