"""The study of coverage: its scenes, how a run is kept, which truths lie inside what was told."""

import json
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import outcome_maker
import pandas
import pytest
from study_fakes import published

import fem_impact
import meshes
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.report import Request
from fem_impact.errors import ResultError, SceneError
from fem_impact.evidence.studies import coverage as study
from fem_impact.evidence.studies.coverage import report
from fem_impact.evidence.studies.coverage import run as coverage_run
from fem_impact.evidence.studies.coverage.bodies import BODIES, write
from fem_impact.evidence.studies.coverage.families import FAMILIES, TWELVE
from fem_impact.evidence.studies.coverage.judge import (
    KEYS,
    LEVELS,
    REDUCED,
    coverage,
    ends,
    times,
    told_errors,
)
from fem_impact.evidence.studies.coverage.run import (
    DEFAULT,
    FINER,
    FINEST,
    MODAL,
    MOST,
    CoverageResult,
    CoverageRun,
)
from fem_impact.evidence.studies.coverage.scenes import (
    BENCH,
    BRITTLE,
    GENTLE,
    KINDS,
    OWN,
    RANGES,
    DrawnScene,
    drawn,
)
from fem_impact.jobs.job import Failure
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.progress import Notice, Progress
from fem_impact.scene.types import MEASURED_SETS

pytestmark = pytest.mark.usefixtures("unrendered")

SCENE = DrawnScene("tube-0", "tube", {"barrier": {"material": "copper"}}, "", {})


def banded(values=(), halves=(), **changed):
    """An outcome with limits and half-widths of some keys."""
    return outcome_maker.outcome(
        **{
            "mu": 0.3,
            "finished": True,
            "tip_size_m": 4e-4,
            "mesh_limit": dict(values),
            "mesh_band": dict(halves),
            **changed,
        }
    )


def finer(**changed):
    """An outcome of a finer mesh."""
    return banded(**{"tip_size_m": 2e-4, **changed})


def judged(default, truth, model=FINER):
    """The told errors of one scene."""
    results = {(SCENE.name, DEFAULT): CoverageResult(default), (SCENE.name, model): CoverageResult(truth)}
    return told_errors([SCENE], results)


def test_every_family_has_as_many_scenes_and_more_of_them_hold_the_fewer():
    few, many = drawn(2, 1), drawn(9, 5)
    families = [scene.family for scene in many]
    assert all(families.count(name) == 9 for name in FAMILIES)
    assert families.count(OWN) == 5 * len(TWELVE) == 60
    assert families.count(GENTLE) == 4 * (len(FAMILIES) - 1) and GENTLE in {scene.family for scene in few}
    assert all(scene in many for scene in few)
    assert len({scene.name for scene in many}) == len(many)
    assert {scene.group for scene in many} == set(KINDS)


def test_motion_and_friction_cover_both_signs_and_their_ranges():
    scenes = [scene.tables for scene in drawn(16, 0) if scene.family != GENTLE]
    numbers = {
        name: np.array([float(tables["impact"][name].split()[0]) for tables in scenes])
        for name in ("angle", "v_n", "v_t", "omega")
    }
    speed = np.hypot(numbers["v_n"], numbers["v_t"])
    assert RANGES["speed"][0] * 0.999 < speed.min() < 0.2 and 10 < speed.max() < RANGES["speed"][1] * 1.001
    assert numbers["v_n"].max() < 0
    for name in ("angle", "v_t", "omega"):
        assert (numbers[name] > 0).mean() > 0.2 and (numbers[name] < 0).mean() > 0.2
    friction = np.array([tables["surface"]["friction"] for tables in scenes])
    assert friction.min() == 0 and friction.max() > 0.9 and 0.03 < (friction == 0).mean() < 0.2
    assert BENCH["speed"] == (0.5, 5.0)


def test_gentle_scenes_are_brittle_or_slow():
    for scene in (scene for scene in drawn(16, 0) if scene.family == GENTLE):
        speed = np.hypot(*(float(scene.tables["impact"][name].split()[0]) for name in ("v_n", "v_t")))
        metals = {scene.tables["projectile"]["material"], scene.tables["barrier"]["material"]}
        assert metals <= {*BRITTLE} or 5e-3 * 0.999 < speed < 1.001


def test_the_scenes_can_be_read_and_their_bodies_made(tmp_path):
    for drawn_scene in drawn(2, 1):
        scene = drawn_scene.scene(tmp_path)
        assert scene.id == drawn_scene.name and scene.projectile.body().mass > 0


def test_each_family_is_what_its_name_says():
    stated = {scene.family: scene for scene in drawn(1, 0)}
    tables = {family: scene.tables["projectile"] for family, scene in stated.items()}
    assert {family for family, table in tables.items() if "bore" in table} >= {"tube"}
    assert {tables[family].get("tip") for family in ("sharp edge", "flat pin", "disc, ring")} == {"plain"}
    assert (tables["rounded edge"]["tip"], tables["round nose"]["tip"]) == ("B", "A")
    assert {family for family, table in tables.items() if "profile" in table} == {"stepped", "tapered"}
    assert stated["own mesh"].body in BODIES and "mesh" in tables["own mesh"]
    disc = [float(tables["disc, ring"][key].split()[0]) for key in ("length", "diameter")]
    assert disc[0] < 0.36 * disc[1]


# area of half a section over width squared: square, hexagon over its corners, square over its diagonal
AREAS = {"square bar": 1 / 2, "hexagonal bar": 3 * 3**0.5 / 16, "corner bar": 1 / 4, "bent bar": 1 / 2}


@pytest.mark.parametrize("body", BODIES)
def test_bodies_are_whole_and_have_the_volume_of_their_section(body):
    sizes = {"width": 0.012, "length": 0.04, "thickness": 0.003, "bend": 0.004, "share": 0.5}
    points, cells = BODIES[body](sizes)
    volume = {
        "plate": 0.5 * 0.012 * 0.003 * 0.04,
        # of a frustum with a square base
        "tapered bar": 0.5 * 0.04 * 0.012**2 * (1 + 0.5 + 0.25) / 3,
    }.get(body, AREAS.get(body, 0.0) * 0.012**2 * 0.04)
    edges = points[cells]
    corner = np.linalg.det(np.stack([edges[:, k] - edges[:, 0] for k in (1, 3, 4)], axis=1))
    assert (corner > 0).all() and points[:, 1].min() == 0 and points[:, 2].min() == 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "body.vtu"
        write(body, sizes, path)
        half = meshes.read_own(path, 1.0, meshes.Stated("half", None, ())).half
    assert meshes.volume(half) == pytest.approx(volume, rel=2e-3)


class Chain(LevelChain):
    """Runs nothing; knows mu on no level by itself."""

    def run(self):
        assert self.scene.accuracy.levels == 4
        self.options.progress(Notice("a sentence"))
        for note, range_s in (("2", (5.0, 9.0)), ("3", (2.0, 4.0))):
            told = Progress(0.0, 1.0, 0, 0.0, "", 7.0, f"tube-0, level {note} of 3", range_s)
            self.options.progress(told)
        return banded({"mu": 0.31}, {"mu": 0.02})


def test_a_run_keeps_its_outcome_and_what_was_told(monkeypatch):
    monkeypatch.setattr(coverage_run, "LevelChain", Chain)
    monkeypatch.setattr(coverage_run, "own_limits", lambda levels: ({"mu": 0.31}, {"mu": 0.01}))
    job = CoverageRun(drawn(1, 0)[0], FINER)
    kept = job.read(job.run())
    assert kept.outcome.estimate("mu") == (0.31, 0.02) and kept.own_halves == {"mu": 0.01}
    assert kept.end == "finished" and kept.why == ""
    assert kept.notices == ("a sentence",) and 0 <= kept.left_s < 10
    assert kept.forecast_s[1] / kept.forecast_s[0] == pytest.approx(9 / 5)
    assert kept.planned_s is None or 0 < kept.planned_s[0] < kept.planned_s[1]
    with pytest.raises(ResultError, match="damaged"):
        job.read(json.dumps({"outcome": None}))


def test_a_forecast_is_told_in_processor_time():
    begun, wall = time.process_time() - 100.0, time.perf_counter() - 200.0  # two runs share a core
    listener = coverage_run._Listener(1000.0, begun=begun, wall=wall)
    for note, range_s in (("2", (5.0, 9.0)), ("3", (2.0, 4.0))):
        listener(Progress(0.0, 1.0, 0, 0.0, "", 7.0, f"tube-0, level {note} of 3", range_s))
    assert listener.forecast[0] == pytest.approx((2.5, 4.5), rel=0.05)


@pytest.mark.parametrize(
    ("error", "trouble"), [(SceneError("is too thin.", key="a"), "refused"), (KeyError("a"), "fault")]
)
def test_refusals_and_faults_are_results(monkeypatch, error, trouble):
    def fails(*_):
        raise error

    monkeypatch.setattr(coverage_run, "LevelChain", fails)
    job = CoverageRun(drawn(1, 0)[0], DEFAULT)
    kept = job.read(job.run())
    assert kept.end == kept.trouble == trouble and not kept.has_numbers
    assert ("Traceback" in kept.reason) == (trouble == "fault")


def test_ends_tell_numbers_from_none():
    later = CoverageResult(banded(finished=False, stopped_because="the tail strikes"))
    assert later.end == "strikes again" and later.has_numbers and later.why == "the tail strikes"
    reasons = {"mu": "too few nodes"}
    assert CoverageResult(banded(mu=None, reasons=reasons)).end == "not resolved"
    cut = CoverageResult(banded(mu=None, reasons=reasons, finished=False))
    assert cut.end == "cut off" and cut.why == "too few nodes"
    table = ends([SCENE], {(SCENE.name, DEFAULT): later}, DEFAULT)
    assert table[["family", "end", "reason"]].to_numpy().tolist() == [
        ["tube", "strikes again", "the tail strikes"]
    ]


def test_a_band_holds_the_limit_of_the_finer_run_or_not():
    default = banded({"mu": 0.30, "e_edge": 0.5}, {"mu": 0.02, "e_edge": 0.01})
    truth = finer(mu=0.33, e_edge=0.505, mesh_limit={"mu": 0.315}, mesh_band={"mu": 0.1})
    table = judged(default, truth).set_index("quantity")
    assert list(table.index) == ["e", "mu"] and set(table["told"]) == {LEVELS}
    assert table.loc["mu", "error"] == pytest.approx(0.015)
    assert table.loc["mu", "inside"] and not table.loc["mu", "inside_finest"]
    assert table.loc["e", "truth"] == 0.505 and table.loc["e", "inside"] and table.loc["e", "inside_finest"]
    assert not judged(default, finer(mu=0.5, e_edge=0.5)).set_index("quantity").loc["mu", "inside"]


def test_zeros_of_physics_runs_without_numbers_and_meshes_no_finer_are_left_out():
    default = banded({"mu": 0.0}, {"mu": 0.0})
    assert judged(default, finer(mu=1e-12)).empty and len(judged(default, finer(mu=1e-3))) == 1
    assert judged(default, banded(mu=0.1)).empty
    assert judged(default, finer(mu=None)).empty


def test_shares_have_wilson_intervals_and_the_factor_that_is_needed():
    default, errors = banded({"mu": 0.3}, {"mu": 0.01}), (0.002, 0.005, 0.02, 0.008)
    rows = [judged(default, finer(mu=0.3 + error)) for error in errors]
    (row,) = coverage(pandas.concat(rows), ["told", "quantity"]).to_dict("records")
    assert (row["n"], row["inside"], row["share"]) == (4, 3, 0.75)
    n, p, z = 4, 0.75, 1.959964
    centre, half = p + z**2 / (2 * n), z * (p * (1 - p) / n + z**2 / (4 * n**2)) ** 0.5
    assert row["low"] == pytest.approx((centre - half) / (1 + z**2 / n), rel=1e-5)
    assert row["high"] == pytest.approx((centre + half) / (1 + z**2 / n), rel=1e-5)
    assert row["half"] == pytest.approx(0.01) and row["error"] == pytest.approx(0.0065)
    assert row["needed"] == pytest.approx(2.0)
    # of a hundred errors as many as each told error is meant to hold
    hundred = pandas.DataFrame(
        {"inside": True, "inside_finest": True, "error": np.arange(1.0, 101), "half": 1.0}
    )
    for told, needed in ((LEVELS, 96.0), (REDUCED, 91.0)):
        (row,) = coverage(hundred.assign(told=told, quantity="e"), ["told", "quantity"]).to_dict("records")
        assert row["needed"] == needed


def test_each_told_error_is_judged_against_what_it_is_meant_for():
    counts = pandas.DataFrame({"quantity": ["e"], "inside": [85], "n": [100], "high": [0.93]})
    both = pandas.concat([counts.assign(told=LEVELS), counts.assign(told=REDUCED)])
    levels, reduced = report._held(both)
    assert levels.endswith("meant for 95%): e 85 of 100; surely below 95%: e.")
    assert reduced.endswith("meant for 90%): e 85 of 100.")


def test_causes_of_missed_bands_are_counted():
    """One that is 0, one off by little, one by much; one that holds."""
    keys = [KEYS[name] for name in ("plastic rod", "mu", "e", "friction")]
    halves = dict(zip(keys, (0.0, 0.01, 0.01, 0.01), strict=True))
    default = banded(dict.fromkeys(keys, 0.3), halves)
    off = dict(zip(keys, (0.1, 0.015, 0.1, 0.0), strict=True))
    errors = judged(default, finer(**{key: 0.3 + by for key, by in off.items()}))
    (said,) = report._causes(errors, coverage(errors, ["told", "family"]))
    assert "3 of 4 bands do not hold. Of these 1 had a half-width of 0 and 1 are off" in said
    assert said.endswith("least often of: tube 1 of 4.")


def both_models(modal=None, **solid):
    """Results of one scene by the reduced model and by finite elements; one place of contact each."""
    site = {name: 0.0 for name in SITE_KEYS}
    known = {"contact_sites": [site], "mesh_limit": None, "mesh_band": None}
    reduced = {"fidelity": "modal", "model_band": {"mu": 0.03, "e_edge": 0.07, "Omega_rad_per_s": 0.1}}
    default = {"contact_sites": [site], "fidelity": "solid", **solid}
    return {
        (SCENE.name, MODAL): CoverageResult(
            banded(**known | reduced | {"mu": 0.3, "e_edge": 0.5} | (modal or {}))
        ),
        (SCENE.name, DEFAULT): CoverageResult(
            banded({"mu": 0.34, "e_edge": 0.55}, {"mu": 0.01, "e_edge": 0.01}, **default)
        ),
    }


SITE_KEYS = [key.name for key in KEY_TABLE["contact_sites"].entries]


def test_half_widths_of_the_reduced_model_are_held_against_what_finite_elements_know():
    table = told_errors([SCENE], both_models()).set_index("quantity")
    assert set(table["told"]) == {REDUCED} and table["inside"].to_dict() == {"e": True, "mu": False}
    wide = both_models(mesh_band={"mu": 0.2, "e_edge": 0.01})
    assert told_errors([SCENE], wide)["quantity"].tolist() == ["e"]


def test_rows_for_the_stored_scenes_leave_out_those_unlike_them_by_kind(tmp_path):
    """An impulse far beyond friction, and what lands flat, and so sends waves."""
    scenes = [replace(drawn(1, 0)[0], name=name) for name in ("like", "digs", "flat")]
    unsent = {"W_radiated_over_E_0": None, "reasons": {"W_radiated_over_E_0": "no waves"}}
    results = {}
    for scene, changed in zip(scenes, (unsent, unsent | {"mu": 0.5}, {}), strict=True):
        found = both_models({"friction_f": 0.3} | changed)
        results |= {(scene.name, model): result for (_, model), result in found.items()}
    sheet = report._pairs(scenes, results)
    assert [row[0] for row in sheet.table.rows] == ["like"]
    assert "2 scenes left out" in sheet.caption and "1 for how an edge digs in" in sheet.caption
    assert "1 for what lands flat" in sheet.caption


def test_models_that_followed_other_strikes_are_not_compared():
    two = 2 * [{name: 0.0 for name in SITE_KEYS}]
    assert told_errors([SCENE], both_models({"contact_sites": two})).empty


def test_every_quantity_of_the_reduced_model_is_told_by_a_real_outcome():
    outcome = fem_impact.simulate(fem_impact.load("t5b"), "modal")
    told = {name: outcome.estimate(KEYS[name])[1] for name in ("e", "mu", "Omega", "E_vib", "friction")}
    assert all(half > 0 for half in told.values()) and told["e"] != told["mu"]


def test_told_times_are_judged_by_their_ranges():
    for took, left, held in ((9.0, 19.0, [False, True]), (50.0, 21.0, [True, False])):
        run = CoverageResult(banded(), cpu_s=took, planned_s=(10, 50), forecast_s=(5, 20), left_s=left)
        assert times([SCENE], {(SCENE.name, DEFAULT): run})["inside"].tolist() == held


def test_finer_runs_follow_where_there_are_numbers(tmp_path):
    request = Request(tmp_path)
    first = study.plan(request, {})
    names = {job.name: job for job in first}
    assert {job.model for job in first} == {DEFAULT, MODAL}
    results = {
        name: CoverageResult(banded() if job.model == DEFAULT else None) for name, job in names.items()
    }
    second = [job for job in study.plan(request, results) if job.name not in names]
    assert {job.model for job in second} == {FINER} and len(second) == len(study.scenes(request))
    for at, job in enumerate(second):
        results[job.name] = CoverageResult(finer(), cpu_s=(5.0, 500.0)[at % 2])
    third = [job for job in study.plan(request, results) if job.name not in results]
    assert {job.model for job in third} == {FINEST} and len(third) == -(-len(second) // 2)


def test_a_first_part_may_be_asked_for(tmp_path):
    part, whole = Request(tmp_path, first=2), Request(tmp_path)
    few, every = study.scenes(part), study.scenes(whole)
    count = 2 * (len(FAMILIES) + len(TWELVE)) + len(FAMILIES) - 1 + len(MEASURED_SETS)
    assert len(few) == count and all(scene in every for scene in few)
    assert part.command("coverage") == "fem-impact study coverage --first 2" and part.about != whole.about


def test_another_seed_draws_other_scenes(tmp_path):
    own, other = study.scenes(Request(tmp_path, first=1)), study.scenes(Request(tmp_path, first=1, seed=7))
    assert not any(scene in own for scene in other)
    assert {scene.name for scene in own} - {scene.name for scene in other} == {*MEASURED_SETS}


@pytest.mark.long
def test_the_report_counts_and_shows(tmp_path):
    request, results = Request(tmp_path, quick=True), {}
    for job in study.plan(request, {}):
        results[job.name] = CoverageResult(banded({"mu": 0.3}, {"mu": 0.02}), planned_s=(1.0, 9.0))
    for job in study.plan(request, results):
        results.setdefault(job.name, CoverageResult(finer(mu=0.31), cpu_s=60.0))
    lost = next(job.name for job in study.plan(request, {}) if job.model == DEFAULT)
    results[lost] = Failure(lost, "killed")
    found = published(study.conclude, request, results)
    assert "mu 9 of 9" in found.text and "1 fault" in found.text
    assert len((tmp_path / "misses.csv").read_text().splitlines()) == 1
    assert (tmp_path / "errors.csv").is_file() and (tmp_path / "figures" / "coverage.svg").is_file()


def test_a_run_that_takes_too_long_is_broken_off(monkeypatch):
    def endless(case, options):
        while True:
            options.progress(Progress(0.0, 1.0, 0, 0.0, "", None, "tube-0, level 2 of 3"))

    monkeypatch.setattr(coverage_run, "LevelChain", endless)
    monkeypatch.setitem(MOST, DEFAULT, 0.05)
    job = CoverageRun(drawn(1, 0)[0], DEFAULT)
    kept = job.read(job.run())
    assert kept.end == "too dear" and "level 2 of 3" in kept.why and 0.05 < kept.cpu_s < 5


@pytest.mark.long
def test_misses_stand_the_worst_first(tmp_path):
    request, results = Request(tmp_path, quick=True), {}
    for job in study.plan(request, {}):
        results[job.name] = CoverageResult(banded({"mu": 0.3}, {"mu": 0.02}))
    for at, job in enumerate(job for job in study.plan(request, results) if job.model == FINER):
        results[job.name] = CoverageResult(finer(mu=0.3 + 0.015 * at))
    sure = study.plan(request, {})[-1].name
    results[sure] = CoverageResult(banded({"mu": 0.3}, {"mu": 0.0}))
    published(study.conclude, request, results)
    misses = pandas.read_csv(tmp_path / "misses.csv")
    ratios = misses["error over half-width"]
    assert len(misses) == 8 and np.isnan(ratios[0]) and ratios[1:].is_monotonic_decreasing
    assert ratios[1] == pytest.approx(8 * 0.015 / 0.02)
