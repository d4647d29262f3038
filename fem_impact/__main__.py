"""Run the command line as ``python -m fem_impact``."""

from __future__ import annotations

import sys

from fem_impact.cli.main import main

sys.exit(main())
