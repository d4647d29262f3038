"""The heating tests use the coarse scenes of the solver's tests."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent.parent / "solid"))
