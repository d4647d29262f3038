"""Run the command line as ``python -m fem_impact``."""

import sys

from fem_impact.cli.main import main

sys.exit(main())
