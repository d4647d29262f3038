"""The command ``completion``: a script by which the shell completes the command line."""

from __future__ import annotations

import sys

from fem_impact.cli.common import print_json
from fem_impact.cli.options import Options
from fem_impact.cli.parser import build_parser
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
    if options.json:
        print_json({"shell": options.shell, "script": script})
    else:
        sys.stdout.write(script)
    return 0
