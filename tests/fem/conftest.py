"""The tests of operators use the small meshes of the solver's tests."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent.parent / "solid"))
