"""The command ``completion``: a script by which the shell completes the command line."""

from fem_impact.cli.parser import Options, build_parser
from fem_impact.cli.terminal import print_answer
from fem_impact.errors import MissingLibraryError


def completion(options: Options) -> int:
    """Print the script of a shell.

    Raises
    ------
    MissingLibraryError
        The package shtab is not installed.
    """
    try:
        import shtab
    except ImportError:
        remedy = "Install it: pip install 'fem-impact[completion]'."
        raise MissingLibraryError(f"completion needs the package shtab. {remedy}") from None
    script = shtab.complete(build_parser(), options.shell)
    print_answer(options, {"shell": options.shell, "script": script}, script)
    return 0
