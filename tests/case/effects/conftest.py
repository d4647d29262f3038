"""The tests of effects use the coarse scenes of the solver's tests."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[2] / "solid"))
