"""The hard cases, each a scene on a coarse mesh, some with a start that no scene file can state."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from fem_impact import Scene, load, replace_all
from fem_impact.evidence.data import read_stated, scene_keys

Expected = Literal["closed", "refused", "detected"]


@dataclass(frozen=True, slots=True)
class HardCase:
    """One hard case of cases.toml.

    Attributes
    ----------
    difficulty : what is hard about it
    changes : of the base scene, as a scene file writes them
    expected : ``closed`` run, ``refused`` before the run, or trouble ``detected`` during it
    gap : height of the lowest point at the start, m
    shifted : place of the rod along t, m
    step : share of the stable step
    bounces : between two walls instead of a scene, 0 for none
    """

    name: str
    difficulty: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    expected: Expected = "closed"
    gap: float = 2e-6
    shifted: float = 0.0
    step: float = 0.9
    bounces: int = 0

    def scene(self) -> Scene:
        """Return its scene (SceneError if it is refused already here)."""
        named = {"id": f"stress-{self.name.replace('.', '-')}"}
        return replace_all(load("t5b"), scene_keys(_BASE) | scene_keys(self.changes) | named)


_STATED = read_stated("hard_cases/cases.toml")
_BASE = _STATED.pop("base")
CASES = {name: HardCase(name, **stated) for name, stated in _STATED.items()}
