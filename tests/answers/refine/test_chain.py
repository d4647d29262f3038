"""Levels of a run: what they find, which of them run, their bands, files, repeats and budget."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fem_impact.answers.refine import level as level_module
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.extrapolate import MeshRuns, level_limit, level_limits, own_limits
from fem_impact.answers.refine.forecast import Turns
from fem_impact.answers.refine.level_meshes import LevelMeshes, steps_between
from fem_impact.answers.simulate import compiled, simulate
from fem_impact.case.case import Case
from fem_impact.case.record import ContactRecord
from fem_impact.errors import ResultError, SceneError
from fem_impact.evidence.studies.coverage.scenes import drawn
from fem_impact.fem.geometry import build_geometry
from fem_impact.files.atomic import write_digests
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown, known
from fem_impact.outcome.record import Outcome
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import digest
from fem_impact.solid.build import build
from meshes import SKIN, thicknesses

BASE = {
    "barrier": {"material": "plate-steel"},
    "surface": {"state": "custom", "friction": 0.2, "source": "assumed"},
    "save": {"frames": 0},
}
PIN = {"shape": "flat", "length": "40 mm", "diameter": "10 mm", "material": "rod-steel"}
QUICK = replace_all(load("quick"), {"save.frames": 0})
SHORT = replace_all(QUICK, {"projectile.length": "40 mm", "accuracy.levels": 2})


def scene_of(name, projectile, impact, **more):
    return read_dict({"id": name, **BASE, "projectile": projectile, "impact": impact, **more})


@pytest.fixture(scope="module")
def quick():
    levels = LevelChain(Case(QUICK))
    return levels, levels.run()


@pytest.mark.long
def test_a_pilot_and_two_finer_levels_end_on_the_stated_size(quick):
    levels, outcome = quick
    assert [level.splits for level in levels.done] == [0, 1, 2]
    sizes = [level.size for level in levels.done]
    assert sizes == sorted(sizes, reverse=True)
    assert known(outcome.cost.tip_size) == pytest.approx(sizes[-1])
    assert outcome.provenance.scene_digest == digest(QUICK)


@pytest.mark.parametrize(("levels", "splits"), [(2, [1, 2]), (3, [0, 1, 2]), (4, [0, 1, 2, 3])])
def test_a_stated_size_is_that_of_the_last_level_unless_more_are_asked_for(levels, splits):
    chained = LevelChain(Case(replace(QUICK, accuracy=replace(QUICK.accuracy, levels=levels))))
    assert chained.meshes.first == splits[0] and chained.finest == splits[-1]
    assert steps_between(splits[0], splits[-1], levels - 1) == splits[1:]


def test_a_contact_found_wider_than_before_takes_no_level_away_that_is_stated():
    """The second of three levels skipped a halving for a narrow contact: a third one halves its cells."""
    chained = LevelChain(Case(load("t5b")))
    wide = chained.meshes.expected(0)
    wide = replace(wide, rod=replace(wide.rod, touched=5 * wide.rod.touched))
    record, first = replace(wide, resolved=True), chained.meshes.first
    chained.done = [SimpleNamespace(splits=splits, record=record) for splits in (first, first + 2)]
    assert chained.finest == first + 2 and chained.following == first + 3
    chained.done += [SimpleNamespace(splits=first + 3, record=record)]
    assert chained.following is None


def test_the_pilot_of_a_bar_that_lands_on_its_edge_has_a_face_to_touch_in_the_barrier(tmp_path):
    """Its only row of nodes lies over the middle of a row of cells of the block."""
    bar = next(one for one in drawn(2, 0, 20261226) if one.name == "own-mesh-1")
    model = build(LevelMeshes(Case(bar.scene(tmp_path))).pilot)
    assert len(model.contact.rod.quads) and len(model.contact.barrier.quads)


def test_every_level_closes_its_ledger(quick):
    assert max(abs(level.outcome.energy.residual) for level in quick[0].done) < 1e-5


def test_thin_rows_lie_under_the_skin_that_was_pressed(quick):
    level = quick[0].done[-1]
    bodies, zones = (case := level.cases[0]).bodies, case.zones
    assert zones.rod_rows == 2
    pressed = level.record.rod.touched.mean(axis=0)
    thick = {}
    for rows in (0, 2):
        mesh = build_geometry(bodies, replace(zones, rod_rows=rows), 0.0, True).rod.mesh
        skin = mesh.finest & np.isin(mesh.cells, np.unique(mesh.faces_with(SKIN))).any(axis=1)
        away = np.linalg.norm(mesh.points[mesh.cells].mean(axis=1) - pressed, axis=1)
        thick[rows] = thicknesses(mesh)[skin][away[skin].argsort()]
    assert (thick[2][:4] < 0.6 * thick[0][:4]).all()
    assert thick[2][-10:] == pytest.approx(thick[0][-10:])


def test_columns_of_the_barrier_are_narrow_where_the_contact_ended(quick):
    levels, _ = quick
    assert levels.done[0].cases[0].zones.ends is None  # nothing is known yet
    case = levels.done[-1].cases[0]
    (low, high), h = case.zones.ends, case.zones.barrier_size
    assert low == levels.done[-2].record.barrier.touched[:, 0].min() < 0 < high
    mesh = build_geometry(case.bodies, case.zones, 0.0, True).barrier
    line = np.isclose(mesh.points[:, 1:], 0.0, atol=1e-12).all(axis=1)
    t = np.sort(mesh.points[line, 0])
    for end in (low, high):
        assert np.diff(t)[np.searchsorted(t, end) - 1] < 0.75 * h
        assert mesh.finest[(np.abs(mesh.points[mesh.cells, 0] - end) < 0.3 * h).any(axis=1)].any()


def test_rods_that_do_not_yield_have_no_thin_rows():
    elastic = replace_all(QUICK, {"effects": ["auto", "-rod-plasticity"]})
    assert LevelChain(Case(elastic)).meshes.pilot.zones.rod_rows == 0


def test_flow_and_contact_stay_in_the_zones_of_the_last_level(quick):
    levels, outcome = quick
    assert not levels.done[-1].record.left
    assert not [one for one in outcome.validity.limitations if "fine zone" in one.text]


def test_the_place_of_contact_has_the_impulse_and_the_time_of_the_contacts(quick):
    levels, outcome = quick
    (site,) = levels.done[-1].record.sites
    contacts = known(outcome.contact.intervals)
    total = sum(contact.impulse_n for contact in contacts)
    assert site.impulse_n == pytest.approx(total, rel=0.03)  # it is sampled every few steps
    assert site.start == pytest.approx(contacts[0].start, abs=2e-6)
    assert site.end == pytest.approx(contacts[-1].end, abs=2e-6)
    assert site.low[0] < 0 < site.high[0] and 0 < site.depth < 2e-4
    (told,) = known(outcome.contact.sites)
    assert (told.start, told.impulse_n, told.depth) == (site.start, site.impulse_n, site.depth)
    assert told.width == 2 * site.high[1]


@pytest.mark.long
def test_fewer_cells_yield_than_about_an_estimated_contact_and_the_numbers_agree(quick):
    _, outcome = quick
    alone = simulate(replace(QUICK, accuracy=replace(QUICK.accuracy, levels=1)))
    assert outcome.cost.elements_yielding < 1.2 * alone.cost.elements_yielding
    assert known(outcome.restitution.edge.e) == pytest.approx(known(alone.restitution.edge.e), abs=0.02)
    # thin rows and narrow columns of the levels bring mu nearer to that of finer meshes
    fine = 0.445
    assert abs(known(outcome.restitution.mu) - fine) < abs(known(alone.restitution.mu) - fine) < 0.06
    assert isinstance(alone.validity.mesh_band, Unknown)


def test_two_levels_that_resolve_the_contact_give_bands():
    """An elastic flat pin that lands upright on a rigid plane gives back all but its waves."""
    impact, elastic = {"angle": "0 deg", "speed": "1 m/s"}, ["vibration", "barrier-rigid"]
    scene = scene_of("pin", PIN, impact, effects=elastic, accuracy={"levels": 2})
    outcome = LevelChain(Case(scene)).run()
    bands, limits = known(outcome.validity.mesh_band), known(outcome.validity.mesh_limit)
    assert 0 < bands["e_edge"] < 0.1
    assert limits["e_edge"] == pytest.approx(known(outcome.restitution.edge.e), abs=bands["e_edge"])


def test_no_band_is_narrower_than_the_changes_from_level_to_level():
    """Two levels that agree by chance say nothing; a steady fall keeps the band of its last two."""
    outcome = simulate(QUICK, "rigid")

    def levels(*values):
        edges = (replace(outcome.restitution.edge, e=value) for value in values)
        runs = (replace(outcome, restitution=replace(outcome.restitution, edge=edge)) for edge in edges)
        return [MeshRuns(2.0**-at, [run]) for at, run in enumerate(runs)]

    def band(meshes, *wide):
        return known(own_limits(narrowed(meshes, wide))[1])["e_edge"]

    def narrowed(meshes, wide):
        return [replace(mesh, wide=is_wide) for mesh, is_wide in zip(meshes, wide, strict=True)]

    chance = levels(0.4, 0.3, 0.3001)
    assert band(chance, True, True, True) == pytest.approx(0.1)
    assert band(chance, False, True, True) == pytest.approx(0.05)  # what a pilot gives is far off by itself
    twice = [MeshRuns(mesh.size, mesh.runs * 2) for mesh in chance]
    assert band(twice, True, True, True) == pytest.approx(0.05)
    falling = levels(0.4, 0.3, 0.25)
    limits, bands = own_limits(narrowed(falling, (False, False, True)))
    assert known(limits)["e_edge"] == 0.25  # nothing is extrapolated from a level that resolves nothing
    assert known(bands)["e_edge"] == pytest.approx(1.5 * 0.05)
    assert band(falling, False, True, True) == known(own_limits(falling[-2:])[1])["e_edge"] > 0.05


def test_two_narrow_levels_that_agree_have_the_change_before_them_in_their_band():
    """They may agree by chance: a bent bar had e 0.634, 0.483 and 0.486, and 0.599 on one level more."""
    found = level_limit([8.0, 2.0, 1.0], [[0.634], [0.483], [0.486]], [False] * 3)
    assert found == (0.486, pytest.approx(3 * (0.634 - 0.483) / 2))


def limits_of(*levels):
    return level_limits([level.runs for level in levels])


def test_shares_that_flow_and_friction_take_have_half_of_the_widest_band_at_least():
    """What one takes less, the others take; a body that does not yield takes nothing, whatever the mesh."""
    outcome = simulate(QUICK, "rigid")
    energy = replace(outcome.energy, friction=0.1, plastic_rod=0.0, plastic_barrier=0.5)
    less = replace(energy, plastic_barrier=0.4)
    meshes = [MeshRuns(size, [replace(outcome, energy=of)]) for size, of in ((2.0, energy), (1.0, less))]
    bands = known(own_limits(meshes)[1])
    assert bands["E_plastic_barrier_over_E_0"] > 0.1 and bands["E_plastic_rod_over_E_0"] == 0.0
    assert bands["W_friction_over_E_0"] == bands["E_plastic_barrier_over_E_0"] / 2


def test_a_contact_a_few_nodes_wide_has_three_times_the_last_changes_by_halved_cells_as_its_band(quick):
    """A line of contact one cell wide is pressed as hard as its cells are large, and agrees with itself."""
    pilot, before, last = quick[0].done
    assert last.record.rows >= 4
    (site,) = last.record.sites
    h = last.record.rod.edge
    line = replace(site, low=(0.0, 0.0), high=(h, 20 * h))
    narrow = replace(last, record=replace(last.record, sites=(line,)))
    assert narrow.record.rows == 2
    limits, bands = map(known, own_limits([level.runs for level in (pilot, before, narrow)]))
    values = [known(level.outcome.restitution.mu) for level in (pilot, before, last)]
    assert limits["mu"] == values[-1]
    by_halving = abs(np.diff(values)) / abs(np.diff(np.log2([pilot.size, before.size, last.size])))
    assert bands["mu"] == pytest.approx(3 * max(by_halving))
    levels = LevelChain(Case(QUICK), done=[pilot, before, narrow])
    told = [one.text for one in levels._stated().validity.limitations]
    assert any("is 2 nodes wide across its narrow side" in text for text in told)
    coarse = replace(before, record=replace(before.record, sites=(line,)))
    wide = replace(before, record=last.record)
    alone = [known(limits_of(one, last)[0])["mu"] for one in (coarse, wide)]
    assert alone[0] == values[-1] != alone[1]


@pytest.mark.long
def test_a_chamfered_tube_runs_which_one_mesh_refuses():
    tube = {
        "profile": [["0 mm", "8.5 mm"], ["1 mm", "9.5 mm"], ["60 mm", "9.5 mm"]],
        "bore": [["0 mm", "6 mm"], ["60 mm", "6 mm"]],
        "material": "rod-steel",
    }
    scene = scene_of("tube", tube, {"angle": "44 deg", "speed": "1 m/s"})
    with pytest.raises(SceneError, match=r"presses in a flank of 1\.41 mm, 1 deg from level"):
        Case.of(scene)
    assert compiled(scene, "solid").scene == scene
    coarse = replace(scene.accuracy, levels=2, unresolved="report")
    outcome = LevelChain(Case(replace(scene, accuracy=coarse))).run()
    assert outcome.validity.finished and 0 < known(outcome.restitution.edge.e) < 1


def test_a_budget_ends_the_levels_and_tells_what_is_missing():
    notices = []
    levels = LevelChain(Case(QUICK), RunOptions(progress=notices.append))
    levels._run_level(levels.meshes.first, Turns())
    levels.budget_s = 1e-3
    outcome = levels.run()
    assert len(levels.done) == 1
    assert any("give a budget of" in getattr(one, "text", "") for one in notices)
    assert any(
        "times more: a larger budget adds a finer level" in one.text for one in outcome.validity.limitations
    )


@pytest.mark.long
def test_a_level_that_leaves_its_zones_is_repeated_with_more_room(monkeypatch):
    run, rooms = level_module.simulate_recorded, []

    def narrow(scene, fidelity, options, case):
        rooms.append(case.record.rod.spread)
        outcome, record = run(scene, fidelity, options, case)
        return outcome, replace(record, left=len(rooms) == 2)

    monkeypatch.setattr(level_module, "simulate_recorded", narrow)
    scene = replace(QUICK, accuracy=replace(QUICK.accuracy, tip_size=1.2e-3, barrier_size=None))
    levels = LevelChain(Case(scene))
    levels.run()
    assert [level.repeats for level in levels.done] == [0, 1]
    assert rooms[2] > rooms[1]


@pytest.mark.parametrize("size, first, held", [("0.002", "0.0092", "0.037"), ("0.0005", "0.0023", "0.037")])
def test_a_size_that_no_machine_holds_is_told_as_it_was_stated(size, first, held):
    """It said 0.0093 mm, the cells of the first level, where 0.002 mm stood; 0.0005 mm took all memory."""
    fine = LevelMeshes.of(Case(replace_all(load("t5b"), {"accuracy.tip_size": f"{size} mm"})))
    with pytest.raises(SceneError, match=rf"a level of cells of {first}\d+ mm, which makes") as refused:
        _ = fine.pilot
    assert (refused.value.key, refused.value.value) == ("accuracy.tip_size", f"{size} mm")
    assert refused.value.remedy == f"Give at least {held} mm."


@pytest.mark.long
def test_the_files_of_the_last_level_stand_above_all_and_a_run_that_ended_computes_nothing_again(
    tmp_path, monkeypatch
):
    outcome = simulate(SHORT, options=RunOptions(tmp_path))
    assert Outcome.read(tmp_path / "outcome.json") == outcome
    assert Outcome.read(tmp_path / "level-1" / "outcome.json") != outcome
    record = ContactRecord.read(tmp_path / "contact.npz")
    assert len(record.sites) == 1 and record.resolved
    monkeypatch.setattr(level_module, "simulate_recorded", None)
    again = simulate(SHORT, options=RunOptions(tmp_path, resume=True))
    assert again.restitution == outcome.restitution and again.energy == outcome.energy
    assert Outcome.read(tmp_path / "outcome.json") == again


@pytest.mark.long
def test_levels_that_are_done_are_not_run_again(quick, tmp_path, monkeypatch):
    whole = quick[1]
    run, ran = level_module.simulate_recorded, []

    def counted(scene, fidelity, options, case):
        ran.append(scene)
        if len(ran) == 2:
            raise KeyboardInterrupt
        return run(scene, fidelity, options, case)

    monkeypatch.setattr(level_module, "simulate_recorded", counted)
    with pytest.raises(KeyboardInterrupt):
        simulate(QUICK, options=RunOptions(tmp_path / "cut"))
    resumed = simulate(QUICK, options=RunOptions(tmp_path / "cut", resume=True))
    assert len(ran) == 4  # the first, the second twice, the third
    numbers = resumed.restitution.edge.e, resumed.restitution.mu, resumed.energy.vibration
    assert numbers == (whole.restitution.edge.e, whole.restitution.mu, whole.energy.vibration)


def test_a_record_is_read_back_as_it_was_written(quick, tmp_path):
    record = quick[0].done[-1].record
    record.write(tmp_path / "contact.npz")
    again = ContactRecord.read(tmp_path / "contact.npz")
    assert again.digest() == record.digest() and again.sites == record.sites
    assert np.array_equal(again.rod.touched, record.rod.touched)
    assert again.wider().digest() != record.digest()


@pytest.mark.parametrize("damaged", [b"", b"no record", b"PK", None])
def test_a_damaged_record_is_refused(quick, tmp_path, damaged):
    path = tmp_path / "contact.npz"
    quick[0].done[-1].record.write(path)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2] if damaged is None else damaged)
    with pytest.raises(ResultError, match="holds no record of a contact"):
        ContactRecord.read(path)


def test_a_record_of_another_run_is_refused(quick, tmp_path):
    first, *_, last = [level.record for level in quick[0].done]
    first.write(tmp_path / "contact.npz")
    write_digests(tmp_path, ["contact.npz"])
    assert ContactRecord.read(tmp_path / "contact.npz").digest() == first.digest()
    last.write(tmp_path / "contact.npz")
    with pytest.raises(ResultError, match="is not the file that the run wrote"):
        ContactRecord.read(tmp_path / "contact.npz")
