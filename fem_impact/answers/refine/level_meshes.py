"""The meshes of the levels of a scene: how often the cells at the contact are split on each."""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import log2

from fem_impact.case.bodies import Bodies
from fem_impact.case.case import Case
from fem_impact.case.cells import body_cell, level_size, levels_of, rod_cell
from fem_impact.case.mesh import SLICES
from fem_impact.case.record import ContactRecord, expected_record
from fem_impact.case.recorded import patch_radius
from fem_impact.errors import SceneError
from fem_impact.scene.fields import LEVELS, MOST_LEVELS
from fem_impact.scene.types import Scene

# least and most processor time of all levels of a run over what its last one takes by the estimated contact:
# 5 to 95 % of 193 scenes drawn by lot from the study of coverage (seeds 20262301 and 20262501; conformal,
# with the 53 that were broken off after 60 s counted by Kaplan and Meier, doi:10.1080/01621459.1958.10501452)
# The least was .9 by these, and is that of a fresh seed (20263002): 7 of 36 took .57 to .9
WHOLE = (0.6, 11.0)
JUMP = 2  # splits between two levels at most: a record holds the places of cells four times as large


@dataclass(frozen=True)
class LevelMeshes:
    """The meshes of a scene from coarse to fine, each named by how often its cells at the contact are split.

    Attributes
    ----------
    case : of the scene as stated
    """

    case: Case

    @classmethod
    @lru_cache(maxsize=1)
    def of(cls, case: Case) -> "LevelMeshes":
        """Return those of a case, the same ones again for the case that was asked for last."""
        return cls(case)

    @cached_property
    def pilot(self) -> Case:
        """The case of the first level.

        Raises
        ------
        SceneError
            Finite elements cannot compute the scene.
        """
        scene, stated = self.at(self.first), self.case.scene.accuracy.tip_size
        try:
            return Case.of(scene, "solid", self.expected(self.first))
        except SceneError as error:
            if stated is None or error.key != "accuracy.tip_size":
                raise
            own, first = (f"{(size or 0.0) * 1e3:.4g} mm" for size in (stated, scene.accuracy.tip_size))
            problem = f"begins with a level of cells of {first}, which {error.problem}"
            raise SceneError(problem, key=error.key, value=own, remedy=error.remedy) from None

    @cached_property
    def first(self) -> int:
        """Splits of the pilot: two fewer than those of a stated size, of two levels one; else none or one."""
        expected, rod = self.expected(0).rod, self._bodies.rod
        # a side that lands is a polygon of slices where its cells are not split, and slices cannot touch
        of_side = rod.own_mesh is None and expected.touched[:, 2].max() > SLICES * rod.diameter
        least = int(of_side and not rod.is_ball)
        if self.is_sized:
            return max(least, self.usual - (JUMP if self._levels > JUMP else 1))
        return max(least, min(1, self.wanted(patch_radius(expected)) - 1))

    def last(self, contact: ContactRecord | None) -> int:
        """Return the splits of the last level: as stated, or those that resolve the contact that was found.

        As many levels as wanted reach it, or it is not reached: the contact of a sharp edge is narrower on
        each finer mesh. ``contact`` is what the finest level so far recorded, None before the first.
        """
        if self.is_sized or contact is None:
            wanted = self.usual
        else:  # levels that were asked for are run, however well the pilot resolves its contact
            wanted = max(self.wanted(patch_radius(contact.rod)), self.first + 1)
        least = self.first + (0 if self.is_sized else LEVELS - 1)
        more = max(self._levels - LEVELS, 0) if self.is_sized else self._levels - LEVELS
        return min(max(wanted, least) + more, self.first + JUMP * max(self._levels - 2, 0) + 1)

    def likely(self, contact: ContactRecord | None) -> int:
        """Return the splits of the last level, by the estimated contact as long as none was resolved.

        One that presses a cell or two seems as wide as these are. Levels go on until it is resolved, which
        takes about a halving less than advised (`cells.LEAST`).
        """
        last = self.last(contact)
        return last if contact and contact.resolved else max(last, self.last(None), self.usual - 1)

    @property
    def whole_s(self) -> tuple[float, float]:
        """Least and most processor time, s, of all levels before any has run; nine of ten runs lie inside.

        Raises
        ------
        SceneError
            Finite elements cannot compute the scene.
        """
        try:
            last_s = Case.of(self.at(self.likely(None))).size.time
        except SceneError:  # finer than the scene's own mesh, and too large
            last_s = self.case.size.time
        least, most = WHOLE
        return least * last_s, most * last_s

    def remedy(self, asked: int, takes: str) -> str:
        """Say what in the scene adds a finer level to the ``asked`` ones that ran, or why nothing does.

        ``takes`` is the wall time of that level, as text.
        """
        if self.is_sized:
            return f"a smaller accuracy.tip_size adds a finer level (half of it: about {takes} more)"
        more = 1 + max(now := self._levels, asked)
        if more > MOST_LEVELS:
            return f"accuracy.levels is at most {MOST_LEVELS}"
        return f"accuracy.levels = {more} in place of {now} adds a finer level (about {takes} more)"

    def lacking(self, splits: int, contact: ContactRecord, finest: int) -> str:
        """Say how often cells that are split so often would be halved for the contact found; empty: never."""
        radius = patch_radius(contact.rod)
        wanted = self.wanted(radius) - splits
        if wanted <= 0 or (self.is_sized and splits >= finest):
            return ""
        return (
            f"The contact, {2e3 * radius:.2g} mm wide, would be resolved as advised by cells halved "
            f"{wanted} times more"
        )

    @property
    def is_sized(self) -> bool:
        """Whether the scene states the size of the last level's cells."""
        return self.case.scene.accuracy.tip_size is not None

    def wanted(self, radius: float) -> int:
        """Return the splits with which so many cells as advised lie over a contact's radius, m."""
        base = self._cells[1] if self._bodies.contact.compliant else self._cells[0]
        return max(0, round(log2(base / level_size(self._bodies, radius))))

    def at(self, splits: int) -> Scene:
        """Return the scene on cells that are split so often; rod and barrier are split alike.

        It tells all it finds, as the next level may have to be compared with it, and stores no frames.
        """
        sizes = zip(self._cells, self._splits, strict=True)
        rod, barrier = (cell / 2 ** (usual + splits - self.usual) for cell, usual in sizes)
        # a user's cells may be larger than a scene may state: they are left as they are
        rod = min(rod, self.case.scene.projectile.diameter / 4)
        scene = self.case.scene
        accuracy = replace(scene.accuracy, tip_size=rod, target=None, unresolved="report")
        if self._bodies.contact.compliant:
            accuracy = replace(accuracy, barrier_size=barrier)
        return replace(scene, accuracy=accuracy, save=replace(scene.save, frames=0, strain_samples=0))

    def expected(self, splits: int) -> ContactRecord:
        """Return what may touch on cells that are split so often."""
        more = splits - self.usual
        sizes = zip(self._cells, self._splits, strict=True)
        return expected_record(self._bodies, *(cell / 2 ** max(0, usual + more) for cell, usual in sizes))

    @property
    def _levels(self) -> int:
        return self.case.scene.accuracy.levels

    @property
    def _bodies(self) -> Bodies:
        return self.case.bodies

    @cached_property
    def _cells(self) -> tuple[float, float]:
        """Edges, m, of the unsplit cells of rod and barrier where they touch."""
        return rod_cell(self._bodies), body_cell(self._bodies)

    @cached_property
    def _splits(self) -> tuple[int, int]:
        """Splits of rod and barrier that resolve the contact estimated, or that the stated size asks for."""
        return levels_of(self._bodies)

    @property
    def usual(self) -> int:
        """Splits that resolve the contact estimated, or that the stated size asks for."""
        return self._splits[1] if self._bodies.contact.compliant else self._splits[0]


def steps_between(ran: int, finest: int, wanted: int) -> list[int]:
    """Return the splits of the levels from one that ran to the finest, which is one split after another.

    They are as many as ``wanted`` if there are so many splits between, else as few as `JUMP` lets them be.
    """
    steps: list[int] = []
    while ran < finest:
        single = finest - ran <= max(wanted - len(steps), 1)
        ran = ran + 1 if single else min(ran + JUMP, finest - 1)
        steps.append(ran)
    return steps
