"""The maker of whole results lives with the tests of output files."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / "output"))
