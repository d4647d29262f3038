"""Sweeps: values with units, cases that fail as rows, a store to go on from, tables and data frames."""

import json
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas
import pytest
from outcome_maker import altered, outcome

import fem_impact
from fem_impact.answers.sweep import MOST_ROWS, publish_sweep, sweep
from fem_impact.answers.sweep_results import COLUMNS, SHORT, Results, SweepRow
from fem_impact.answers.vary import Variation, cases, in_unit, measure, quantity
from fem_impact.cli.values import read_values
from fem_impact.errors import SceneError, UsageError
from fem_impact.files.run_directory import earlier_runs
from fem_impact.jobs import run as jobs_run
from fem_impact.scene.shipped import load, replace, replace_all
from fem_impact.tables.table import read_csv
from fem_impact.tables.text import plain

pytestmark = pytest.mark.usefixtures("unrendered")


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("impact.angle=15..60:15deg", ["15 deg", "30 deg", "45 deg", "60 deg"]),
        ("impact.angle = 20 .. 10 : -5 deg", ["20 deg", "15 deg", "10 deg"]),
        ("surface.friction=0.1..0.4:0.1", [0.1, 0.2, 0.3, 0.4]),
        ("projectile.length=0.2,0.4,.8m", ["0.2 m", "0.4 m", ".8 m"]),
        ("projectile.length=200 mm, 40 cm", ["200 mm", "40 cm"]),
        ("accuracy.across=8,12", [8, 12]),
        (
            "impact.omega=-.5,+.5,1.e3,2.,07",
            [-0.5, 0.5, 1000.0, 2.0, 7],
        ),  # no TOML
        ("projectile.tip=A,B", ["A", "B"]),
        ("projectile.material=100cr6,42crmo4", ["100cr6", "42crmo4"]),
        ("projectile.material=s235,42crmo4", ["s235", "42crmo4"]),
        ("projectile.mesh=../a.msh,b.msh", ["../a.msh", "b.msh"]),
        (
            'x={name = "a, b", E = "1 GPa"},rod-steel,[["0 mm", "6 mm"], [1, 2]]',
            [{"name": "a, b", "E": "1 GPa"}, "rod-steel", [["0 mm", "6 mm"], [1, 2]]],
        ),
    ],
)
def test_lists_and_ranges_with_units(text, values):
    assert read_values(text) == (text.partition("=")[0].strip(), values)


@pytest.mark.parametrize(
    "text",
    [
        *("impact.angle", "impact.angle=", "x=10..60:0deg", "x=60..10:5deg"),
        *("x=15..60", "x=15..60deg", "x=15deg..60deg:5deg", "x=15-60..70"),
        *("x=20...60:5deg", "x=20.. .60:5deg.", "x=0...5:0.1", "x=0:0.6:5", "x=10:5:60deg"),
    ],
)
def test_what_names_no_values_is_refused(text):
    with pytest.raises(UsageError, match=r"Write impact.angle=15..60:5deg"):
        read_values(text)


@pytest.mark.parametrize(
    ("text", "nearest"),
    [
        ("x=20..60:7deg", "Write 20..55:7deg or 20..62:7deg or 20..60:8deg."),
        ("x=60..20:-7deg", "Write 60..25:-7deg or 60..18:-7deg or 60..20:-8deg."),
        ("x=20..22:7deg", "Write 20..27:7deg or 20..22:2deg."),
        ("x=0..1:0.3", "Write 0..0.9:0.3 or 0..1.2:0.3 or 0..1:0.25."),
    ],
)
def test_a_range_that_does_not_come_to_its_end_names_the_nearest_that_do(text, nearest):
    with pytest.raises(UsageError) as refused:
        read_values(text)
    assert str(refused.value).endswith(nearest)
    for ranged in nearest.removeprefix("Write ").removesuffix(".").split(" or "):
        first, _, last = ranged.partition(":")[0].partition("..")
        _, values = read_values(f"x={ranged}")
        assert [float(str(value).split()[0]) for value in (values[0], values[-1])] == [
            float(first),
            float(last),
        ]


@pytest.mark.parametrize(
    ("changes", "vary", "words"),
    [
        (["impact.angle=20 deg"], "impact.angle=30,45deg", '--set "impact.angle": is given beside --vary'),
        (
            ["projectile.length=0.1 m"],
            "projectile.length_m=0.1",
            "is given beside --vary projectile.length_m",
        ),
        (
            ["projectile.material.E=200 GPa"],
            "projectile.material=rod-steel",
            "beside --vary projectile.material",
        ),
        (["surface.friction=0.3"], "surface.state=machined,contaminated", "beside --vary surface.state"),
        (["surface.friction_low=0.1"], "surface.friction=0.3,0.4", "beside --vary surface.friction"),
        (["accuracy.tip_size=0.5 mm"], "accuracy.target=5 %,10 %", "beside --vary accuracy.target"),
        (["impact.height=1 m"], "impact.speed=1,2m/s", "states the velocity twice, by height and by speed"),
        (["impact.height=1 m"], "impact.v_n=-1,-2m/s", "states the velocity twice, by height and by v_n"),
    ],
)
def test_a_value_that_is_set_and_varied_is_refused(cli, changes, vary, words):
    line = [word for change in changes for word in ("--set", change)]
    code, out, err = cli("sweep", "t5b", *line, "--vary", vary, "--fidelity", "rigid")
    assert code in (2, 3) and out == ""
    assert words in err
    assert not Path("results").exists()


BRONZE = 'name = "my-bronze"\nE = "110 GPa"\nnu = 0.34\nrho = "8800 kg/m3"\n'


def test_own_materials_are_swept_from_files_and_tables_and_told_by_their_names(cli):
    Path("bronze.toml").write_text(BRONZE, encoding="utf-8")
    soft = '{name = "soft", E = "70 GPa", nu = 0.3, rho = "2700 kg/m3"}'
    vary = f"barrier.material=plate-steel,@bronze.toml,{soft}"
    line = (
        "sweep",
        "t5b",
        "--vary",
        vary,
        "--fidelity",
        "rigid",
        "--workers",
        "1",
        "--out",
        "here",
        "--quiet",
    )
    code, out, _ = cli(*line)
    assert code == 0 and "| case-00002 | my-bronze | yes |" in out
    table = pandas.read_csv("here/sweep.csv")
    assert list(table["barrier.material"]) == ["plate-steel", "my-bronze", "soft"]
    own = replace(
        load("t5b"), "barrier.material", {"name": "b", "E": "110 GPa", "nu": 0.34, "rho": "8800 kg/m3"}
    )
    assert table["e_edge"][1] == fem_impact.simulate(own, "rigid").restitution.edge.e
    code, out, _ = cli("check", "t5b", "--set", "barrier.material=@bronze.toml")
    assert code == 0 and "changed: barrier.material = my-bronze" in out
    assert "there is no such file" in cli("sweep", "t5b", "--vary", "barrier.material=@brass.toml")[2]
    assert "no table or list in TOML" in cli("sweep", "t5b", "--vary", "barrier.material={name = }")[2]


def test_arrays_and_columns_are_values_as_lists_are():
    scene, f = load("t5b"), [0.1, 0.2]
    for values in (np.array(f), pandas.Series(f), tuple(f), iter(f)):
        made = cases(scene, {"surface.friction": values})
        assert [case.values["surface.friction"] for case in made] == f
    bore = [["3 mm", np.str_("6 mm")], ["150 mm", "6 mm"]]
    assert replace(load("tube"), "projectile.bore", np.array(bore)).projectile.bore[0] == (0.003, 0.006)


def test_a_wanted_error_is_left_out_where_there_is_no_mesh_and_said_so():
    told = []
    scene = replace(load("quick"), "accuracy", "10 %")
    (row,) = sweep(scene, {"surface.friction": [0.4]}, "rigid", progress=told.append)
    assert row.outcome.restitution.mu > 0
    assert "accuracy = 10 % is for finite elements" in told[0].text


@pytest.mark.parametrize(
    ("fidelity", "changes", "why"),
    [
        ("rigid", {}, "not known in this sweep: E_vib_over_E_0, W_skin_over_E_0"),
        (
            "solid",
            {"effects": ["barrier-elastic", "friction"]},
            "flash_temperature_K (the contact-heating effect is off: effects =",
        ),
        ("solid", {"barrier.material": tomllib.loads(BRONZE)}, "state heating.barrier_conductivity"),
    ],
)
def test_columns_that_cannot_be_filled_are_told_before_the_runs(fidelity, changes, why, monkeypatch):
    told = []

    def stop(*_):
        raise RuntimeError("a run")

    monkeypatch.setattr("fem_impact.answers.sweep.run_jobs", stop)
    scene = replace_all(load("quick"), changes)
    with pytest.raises(RuntimeError, match="a run"):
        sweep(scene, {"surface.friction": [0.4]}, fidelity, progress=told.append)
    assert why in told[-1].text


def test_a_sweep_in_python_writes_what_the_command_does(tmp_path):
    found = sweep(load("t5b"), {"impact.angle": ["30 deg", "45 deg"]}, "rigid", str(tmp_path / "here"))
    written = {path.name for path in (tmp_path / "here").rglob("*")}
    assert {"sweep.csv", "sweep.svg", "summary.md", "study.json", "store.sqlite"} <= written
    assert len(read_csv(tmp_path / "here" / "sweep.csv")) == len(found)


def test_all_combinations_with_the_last_key_changing_fastest():
    made = cases(load("t5b"), {"surface.friction": [0.1, 0.2], "projectile.length": ["80 mm", "90 mm"]})
    stated = [(case.scene.surface.friction, case.scene.projectile.length) for case in made]
    assert stated == [(0.1, 0.08), (0.1, 0.09), (0.2, 0.08), (0.2, 0.09)]


def test_values_of_other_units_come_in_that_of_the_first():
    assert in_unit("40 cm", "mm") == pytest.approx(400.0)
    assert in_unit("430 degC", "K") == pytest.approx(703.15)
    assert in_unit("A", "") == "A"


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({"impact.angel": ["15 deg"]}, "Did you mean angle"),
        ({"lenght": ["15 mm"]}, "Did you mean projectile.length"),
        (
            {"projectile.length": ["1 mm", "2 mm"]},
            "^vary=: Each of the 2 combinations is refused: projectile.shape: .* the body only 1 mm",
        ),
        ({}, "names no values"),
        ({"impact.angle": "15 deg"}, "one value, not a list"),
        ({"surface.friction": [0.1] * 400, "restitution": [0.1] * 400}, "160000 combinations"),
    ],
)
def test_what_cannot_run_at_all_is_refused_before_any_run(vary, words):
    with pytest.raises((SceneError, UsageError), match=words):
        sweep(load("t5b"), vary)


def test_a_wrong_fidelity_is_refused():
    with pytest.raises(UsageError, match="Did you mean modal"):
        sweep(load("t5b"), {"surface.friction": [0.1]}, fidelity="model")


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    out = tmp_path_factory.mktemp("swept")
    vary = {"surface.friction": [0.1, 0.5], "projectile.length": ["80 mm", "1 mm", "90 mm"]}
    return sweep(load("t5b"), vary, fidelity="rigid", out=out), out


@pytest.mark.long
def test_the_table_holds_every_scalar_of_an_outcome_once(swept):
    results, _ = swept
    table, outcome = results.table(), results.rows[0].outcome.to_dict()
    scalars = {name for name, value in outcome.items() if not isinstance(value, dict | list)}
    assert len(set(table.names)) == len(table.names)
    told_by_state = {
        "schema_version",
        "finished",
        "stopped_because",
        "mesh_limit",
        "mesh_band",
        "model_band",
        "effect_choices",
    }
    assert scalars - told_by_state - {"effects"} <= set(table.names)
    for name in (
        "W_radiated_over_E_0",
        "E_locked_rod_over_E_0",
        "flash_temperature_K",
        "tip_size_m",
        "contacts",
    ):
        assert name in COLUMNS
    assert results.table(["mu"]).names[-2:] == ("reason", "mu")
    with pytest.raises(UsageError, match="Did you mean W_skin_over_E_0"):
        results.table(["W_skn"])
    with pytest.raises(UsageError, match="Did you mean Omega_rad_per_s"):
        results.table(["omega"])
    with pytest.raises(UsageError, match=r"Did you mean e_paper or e_edge or e_impulse\?"):
        results.table(["e"])


def made_up(tips, **changed):
    """Results of cases that differ in the size of their cells."""
    rows = [
        SweepRow(
            Variation(f"case-{at}", {"projectile.diameter": f"{at} mm"}, None),
            outcome(tip_size_m=tip, **changed),
            "",
        )
        for at, tip in enumerate(tips, 1)
    ]
    return Results({"projectile.diameter": ["1 mm", "2 mm"]}, tuple(rows))


@pytest.mark.parametrize(
    ("tips", "told"), [((3e-4, 5e-4), True), ((3e-4, 3e-4), False), ((None, None), False)]
)
def test_cells_that_differ_between_the_cases_are_told_in_one_line(tips, told, tmp_path):
    document = publish_sweep(made_up(tips), "t", "fem-impact sweep", tmp_path).document
    lines = [line for line in document["findings"] if "cells of the meshes differ" in line]
    assert len(lines) == told
    assert not told or ("`tip_size_m` 0.3 to 0.5 mm" in lines[0] and "barrier_size_m" not in lines[0])


def test_the_summary_shows_a_short_table_and_the_csv_all(tmp_path):
    contacts = [{"start_s": 0.0, "end_s": 1e-4, "impulse_n_Ns": 1.0, "impulse_t_Ns": 0.1}] * 2
    results = made_up((3e-4, 3e-4), contacts=contacts, flash_temperature_K=None)
    made = publish_sweep(results, "t", "fem-impact sweep", tmp_path)
    (sheet,) = made.document["sheets"]
    known = [name for name in SHORT if name != "flash_temperature_K"]
    assert sheet["columns"] == ["case", "projectile.diameter [mm]", "finished", *known]
    assert dict(zip(sheet["columns"], sheet["rows"][0], strict=True))["contacts"] == 2
    assert "Not known in any case: `flash_temperature_K` (not in the test)." in made.text
    assert "| case-1 | 1 | yes |" in made.text
    assert read_csv(tmp_path / "sweep.csv").names[-len(COLUMNS) :] == COLUMNS


def test_what_is_not_known_in_some_cases_is_told_with_its_reason(tmp_path):
    known, unknown = made_up((3e-4, 3e-4)).rows
    lost = {"e_edge": "too coarse.", "mu": "too coarse."}
    other = altered(unknown.outcome, **dict.fromkeys(lost), reasons=lost)
    results = Results({"projectile.diameter": ["1 mm", "2 mm"]}, (known, SweepRow(unknown.case, other, "")))
    findings = publish_sweep(results, "t", "fem-impact sweep", tmp_path).document["findings"]
    told = [line for line in findings if line.startswith("Not known")]
    assert told == ["Not known in 1 of 2 cases, the first of them case-2: `e_edge`, `mu` (too coarse)."]


def test_a_sweep_by_the_reduced_model_tells_rows_that_are_too_wide_and_what_has_no_half_width(tmp_path):
    found = sweep(load("quick"), {"impact.angle": ["30 deg", "45 deg"]}, "modal", out=tmp_path)
    half = [row.outcome.estimate("e_edge")[1] for row in found]
    text = (tmp_path / "summary.md").read_text(encoding="utf-8")
    e, mu = (line for line in text.splitlines() if "`e_edge`)" in line or "`mu`)" in line)
    assert (
        f"; 2 of 2 cases have a half-width larger than that range, the largest {plain(max(half), 2)} (" in e
    )
    assert "larger than" not in mu
    assert "`W_skin_over_E_0` has no half-width: in case-00001 it lies between " in text


def test_a_wanted_error_that_is_not_reached_is_the_reason_of_its_row():
    (row,) = made_up((3e-4,)).rows
    for achieved, told in ((0.17, "known to 17 %, not to the wanted 10 %"), (0.08, "")):
        ended = altered(row.outcome, accuracy_target=0.1, achieved_error=achieved, achieved_wall_s=1.0)
        results = Results({"projectile.diameter": ["1 mm"]}, (SweepRow(row.case, ended, ""),))
        assert results.table(["mu"]).texts("reason") == [told]


def test_chosen_columns_are_printed_and_drawn(tmp_path):
    chosen = ["E_r_over_E_0", "strikes_again", "W_plate_over_E_0"]
    results = made_up((3e-4, 5e-4), W_plate_over_E_0=None)
    made = publish_sweep(results, "t", "fem-impact sweep", tmp_path, chosen)
    assert made.document["sheets"][0]["columns"][-3:] == chosen
    assert "`E_r_over_E_0`: from" in made.text and "e_edge`: from" not in made.text
    assert "`W_plate_over_E_0` (not in the test)" in made.text


def test_a_long_table_is_cut_in_the_summary_alone(tmp_path):
    results = made_up([3e-4] * (MOST_ROWS + 1))
    made = publish_sweep(replace_vary(results), "t", "fem-impact sweep", tmp_path)
    (sheet,) = made.document["sheets"]
    assert sheet["caption"] == f"The first {MOST_ROWS} of {MOST_ROWS + 1} cases"
    assert len(sheet["rows"]) == MOST_ROWS
    assert len(read_csv(tmp_path / "sweep.csv").rows) == MOST_ROWS + 1


def replace_vary(results):
    """The results with all their values named as varied."""
    return Results(
        {"projectile.diameter": [row.case.values["projectile.diameter"] for row in results]}, results.rows
    )


def test_each_row_is_the_run_of_its_scene(swept):
    results, _ = swept
    row = results.select({"surface.friction": 0.5, "projectile.length": "9 cm"}).rows[0]
    scene = replace(replace(load("t5b"), "surface.friction", 0.5), "projectile.length", "90 mm")
    alone = fem_impact.simulate(scene, "rigid")
    assert row.outcome.to_dict()["e_edge"] == alone.to_dict()["e_edge"]
    assert np.isfinite(results.numbers("mu")).sum() == 4
    after = [row.outcome.motion.V_t for row in results if row.outcome]
    numbers = results.numbers("V_t_m_per_s")
    assert list(numbers[np.isfinite(numbers)]) == after


def test_a_case_that_cannot_run_is_a_row_with_its_reason(swept):
    results, _ = swept
    failed = [row for row in results if row.outcome is None]
    assert len(failed) == 2 and len(results) == 6
    assert all("the nose is 3 mm long, the body only 1 mm" in row.reason for row in failed)
    assert "2 failed" in repr(results) and "<code>e_edge</code>" in results._repr_html_()


CLOSED = [["40 mm", "6 mm"], ["150 mm", "6 mm"]]
STEPPED = [["0 mm", "6 mm"], ["150 mm", "6 mm"], ["200 mm", "4 mm"]]


@pytest.mark.parametrize(
    ("name", "changes", "short", "words"),
    [
        ("tube", {"projectile.bore": CLOSED}, "0.1 m", "projectile.bore that ends at the tail or before"),
        ("tube", {"projectile.bore": STEPPED}, "0.1 m", "projectile.bore that ends at the tail or before"),
        ("ogive", {}, "20 mm", "projectile.nose_length, calibre_radius"),
        ("ogive", {"projectile.nose_length": "30 mm"}, "20 mm", "projectile.nose_length, calibre_radius"),
        ("sphere-cone", {}, "20 mm", "projectile.nose_length, cone_angle"),
        ("heavy-tail", {}, "60 mm", 'segments[1].to = "80 mm": leaves no room for the next segment'),
    ],
)
def test_a_length_that_the_rest_does_not_fit_names_the_remedy(name, changes, short, words):
    scene = replace_all(load(name), changes)
    rows = sweep(scene, {"projectile.length": [short, "180 mm"]}, "rigid").rows
    assert rows[0].outcome is None and words in rows[0].reason
    assert rows[1].outcome is not None


def test_a_bore_that_is_open_at_the_tail_follows_it():
    swept = sweep(load("tube"), {"projectile.length": ["0.1 m", "0.2 m", "0.4 m"]}, "rigid")
    mass = [row.outcome.motion.mass for row in swept]
    assert mass[2] - mass[1] == pytest.approx(2 * (mass[1] - mass[0]), rel=1e-9)
    closed = replace_all(load("tube"), {"projectile.length": "0.4 m", "projectile.bore": CLOSED})
    assert closed.projectile.bore == ((0.04, 0.006), (0.15, 0.006))


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ({"profile": [["0 mm", "4 mm"], ["90 mm", "4 mm"]]}, "for a profile.*projectile.profile instead"),
        ({"shape": "ball", "diameter": "20 mm"}, "for a ball.*projectile.diameter instead"),
    ],
)
def test_a_length_that_is_not_stated_says_what_to_vary_instead(shape, words):
    scene = replace(load("tube"), "projectile", {"material": "rod-steel", **shape})
    with pytest.raises(SceneError, match=words):
        cases(scene, {"projectile.length": ["60 mm", "80 mm"]})


def test_a_second_call_takes_what_is_stored(swept, monkeypatch):
    results, out = swept
    monkeypatch.setattr(jobs_run, "_compute", None)  # would be called for a job that is not stored
    again = sweep(load("t5b"), results.vary, fidelity="rigid", out=out)
    assert again.table().rows == results.table().rows


def test_a_choice_of_what_is_not_there_is_refused(swept):
    results, _ = swept
    with pytest.raises(UsageError, match=r"Did you mean surface.friction"):
        results.select({"surface.fricton": 0.1})
    with pytest.raises(UsageError, match=r"There are: 0.1, 0.5"):
        results.select({"surface.friction": 0.3})


def test_a_data_frame_holds_the_table(swept):
    results, _ = swept
    frame = results.to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame["projectile.length [mm]"]) == [80.0, 1.0, 90.0] * 2
    assert frame["mu"].notna().sum() == 4
    assert frame["flash_temperature_K"].dtype == frame["mu"].dtype == np.float64
    assert "W_radiated_over_E_0" in frame
    assert list(results.to_dataframe(["mu", "e_edge"]).columns)[-2:] == ["mu", "e_edge"]


def test_the_files_of_a_sweep(swept, tmp_path):
    results, _ = swept
    made = publish_sweep(results, "t5b", "fem-impact sweep t5b", tmp_path)
    assert made.document["command"] == "fem-impact sweep t5b"
    assert len(made.document["failures"]) == 2
    table = read_csv(tmp_path / "sweep.csv")
    assert len(table.rows) == 6
    data = read_csv(tmp_path / "figures" / "sweep.csv")
    drawn = {float(row[data.names.index("x")]) for row in data.rows}
    assert drawn == {80.0, 90.0}


def test_the_command(cli):
    line = ("sweep", "t5b", "--vary", "impact.angle=30,45deg", "--fidelity", "rigid", "--workers", "1")
    code, out, _ = cli(*line, "--out", "here", "--quiet")
    assert code == 0
    assert "2 cases of impact.angle; 0 failed" in out
    code, out, _ = cli(*line, "--out", "here", "--quiet", "--json")
    assert [row["impact.angle [deg]"] for row in json.loads(out)["rows"]] == [30.0, 45.0]
    assert cli("report", "here")[0] == 0
    assert "Sweep" in Path("here/report.html").read_text(encoding="utf-8")
    assert cli("sweep", "t5b", "--vary", "impact.angle=3", "--vary", "impact.angle=4")[0] == 2


def swept_here(cli, vary, *more):
    """Files of the directory ``here`` after a sweep there, of the older ones, and what was told."""
    line = ("sweep", "t5b", "--vary", vary, "--fidelity", "rigid", "--workers", "1", "--out", "here")
    code, _, err = cli(*line, *more)
    assert code == 0
    names = ("sweep.csv", "runs.csv", "summary.md", "figures/sweep.csv")
    return [
        {name: (d / name).read_text() for name in names} for d in (Path("here"), *earlier_runs(Path("here")))
    ], err


def test_another_sweep_in_the_directory_sets_the_report_of_the_first_aside(cli):
    (first,), err = swept_here(cli, "impact.angle=30,45deg")
    cli("report", "here")
    assert "Older results" not in err
    (second, kept), err = swept_here(cli, "surface.friction=0.2,0.4")
    assert kept == first and second["sweep.csv"] != first["sweep.csv"]
    (place,) = earlier_runs(Path("here"))
    assert f"Older results that were in here are kept in {place}" in err
    assert (place / "report.html").exists() and not Path("here/report.html").exists()
    other_fidelity = ("--fidelity", "modal")
    (_, *kept), _ = swept_here(cli, "surface.friction=0.2,0.4", *other_fidelity)
    assert len(kept) == 2 and second in kept


def test_the_same_sweep_goes_on_in_its_directory_after_a_kill_and_with_other_columns(cli):
    line = ("sweep", "t5b", "--vary", "impact.angle=30,45,50deg", "--fidelity", "rigid", "--workers", "1")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "fem_impact.answers.sweep.publish", raises(KeyboardInterrupt)
        )  # killed before its tables
        assert cli(*line, "--out", "here")[0] == 130
    assert Path("here/store.sqlite").exists() and not Path("here/sweep.csv").exists()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(jobs_run, "_compute", None)  # would be called for a job that is not stored
        assert cli(*line, "--out", "here")[0] == 0
        assert cli(*line, "--out", "here", "--columns", "mu")[0] == 0
    assert not earlier_runs(Path("here"))


def test_the_sweep_of_a_command_goes_on_in_python_however_its_numbers_are_written(cli):
    line = ("sweep", "t5b", "--vary", "surface.friction=0..0.4:0.2", "--fidelity", "rigid", "--out", "here")
    assert cli(*line)[0] == 0
    sweep(load("t5b"), {"surface.friction": [0, 0.2, 0.4]}, "rigid", "here")
    assert not earlier_runs(Path("here"))
    sweep(load("t5b"), {"surface.friction": [0, 0.2, 0.5]}, "rigid", "here")
    assert len(earlier_runs(Path("here"))) == 1


def raises(error):
    """A function that raises an error."""

    def call(*_):
        raise error

    return call


def test_each_sweep_has_a_directory_of_its_own_unless_one_is_named(cli):
    line = ("sweep", "t5b", "--workers", "1", "--quiet", "--vary")
    for more in (
        ("impact.angle=30deg",),
        ("impact.angle=45deg",),
        ("impact.angle=45deg", "--fidelity", "rigid"),
    ):
        assert cli(*line, *more)[0] == 0
    assert len(list(Path("results").iterdir())) == 3


def test_two_keys_make_all_combinations_and_a_parquet_file(cli, tmp_path):
    pytest.importorskip("pyarrow")
    line = (
        "--vary",
        "impact.angle=30,45deg",
        "--vary",
        "projectile.tip=A,B",
        "--vary",
        "projectile.length=1,80mm",
    )
    code, out, _ = cli(
        "sweep", "t5b", *line, "--fidelity", "rigid", "--workers", "1", "--out", "here", "--quiet"
    )
    assert code == 6  # rods of 1 mm are refused
    assert "8 cases of impact.angle, projectile.tip, projectile.length; 4 failed" in out
    kept, listed = pandas.read_parquet("here/sweep.parquet"), pandas.read_csv("here/sweep.csv")
    assert list(kept["impact.angle [deg]"]) == [30.0] * 4 + [45.0] * 4
    assert list(kept["projectile.tip"]) == ["A", "A", "B", "B"] * 2
    assert list(kept.columns) == list(listed.columns)
    assert kept["mu"].to_numpy() == pytest.approx(listed["mu"].to_numpy(), rel=1e-15, nan_ok=True)
    assert list(kept["finished"]) == [False, True] * 4


@pytest.mark.parametrize("there", [True, False])
def test_parquet_is_written_where_pyarrow_is(swept, tmp_path, monkeypatch, there):
    written = []
    monkeypatch.setattr(
        pandas.DataFrame, "to_parquet", lambda frame, path: written.append((len(frame), path))
    )
    monkeypatch.setattr("fem_impact.answers.sweep.find_spec", {"pyarrow": there}.__getitem__)
    publish_sweep(swept[0], "t5b", "fem-impact sweep t5b", tmp_path)
    assert written == ([(6, tmp_path / "sweep.parquet")] if there else [])


def test_a_sweep_runs_on_a_cluster(cli):
    distributed = pytest.importorskip("distributed")
    line = ("sweep", "t5b", "--vary", "surface.friction=0.2,0.4", "--fidelity", "rigid", "--quiet", "--json")
    options = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster:
        code, out, err = cli(*line, "--scheduler", cluster.scheduler_address)
    assert (code, err) == (0, "")
    assert [row["mu"] for row in json.loads(out)["rows"]] == pytest.approx([0.2, 0.4])


def test_an_executor_that_is_lent_stays_open():
    with ThreadPoolExecutor(1) as lent:
        sweep(load("t5b"), {"surface.friction": [0.2]}, fidelity="rigid", executor=lent)
        assert lent.submit(int, 3).result() == 3


def test_a_wrong_column_is_answered_with_the_nearest_before_a_directory_is_made(cli):
    line = ("sweep", "t5b", "--vary", "impact.angle=15,20deg")
    code, out, err = cli(*line, "--columns", "mu,flash_temprature")
    assert (code, out) == (2, "")
    assert '--columns "flash_temprature"' in err and "Did you mean flash_temperature_K?" in err
    assert not Path("results").exists()
    code, out, _ = cli(
        *line, "--columns", "mu, E_r_over_E_0", "--fidelity", "rigid", "--workers", "1", "--quiet"
    )
    assert code == 0 and "| finished | mu | E_r_over_E_0 |" in out and "--columns 'mu, E_r_over_E_0'" in out


@pytest.mark.parametrize(
    ("vary", "nearest"),
    [("impact.angel=15,20deg", "Did you mean angle?"), ("angle=15deg", "Did you mean impact.angle?")],
)
def test_a_wrong_key_is_answered_with_the_nearest_before_a_directory_is_made(cli, vary, nearest):
    code, out, err = cli("sweep", "t5b", "--vary", vary)
    assert (code, out) == (3, "")
    assert nearest in err and "--set" not in err
    assert not Path("results").exists()


def test_the_example_of_the_page_prints_what_it_shows(capsys):
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "sweep.md").read_text(encoding="utf-8")
    code, told = (
        page.partition(f"<!-- {mark} -->\n```{kind}\n")[2].partition("```")[0]
        for mark, kind in (("run", "python"), ("prints", "text"))
    )
    exec(compile(code, "sweep.md", "exec"), {})
    assert capsys.readouterr().out == told


def test_the_summary_names_the_column_of_e_and_explains_it(tmp_path):
    results = sweep(load("t5b"), {"impact.angle": ["30 deg", "45 deg"]}, fidelity="rigid")
    text = publish_sweep(results, "t", "fem-impact sweep", tmp_path).text
    assert "Coefficient of restitution e (`e_edge`): from" in text
    assert "`e_edge` is e at the point of the tip that touches first" in text


@pytest.mark.long
def test_finite_elements_of_a_sweep_run_on_levels_and_have_bands(monkeypatch, tmp_path):
    """A wanted error holds for each case, and the half-width stands beside each number."""
    scene = replace_all(load("quick"), {"save.frames": 0, "accuracy.levels": 2, "projectile.length": "40 mm"})
    found = sweep(scene, {"surface.friction": [0.2, 0.57]}, "solid", out=tmp_path)
    table = found.to_dataframe(["e_edge", "mu", "contacts"])
    of_mu = ["mu", "mu_low", "mu_high"]
    assert list(table.columns[4:]) == ["e_edge", "e_edge_low", "e_edge_high", *of_mu, "contacts"]
    for row, e, low, high in zip(
        found, *(table[f"e_edge{end}"] for end in ("", "_low", "_high")), strict=True
    ):
        limit, band = row.outcome.estimate("e_edge")
        assert e == limit and band > 0
        assert (low, high) == pytest.approx((e - band, e + band))
    assert found.numbers("mu_low") == pytest.approx(table["mu_low"])
    assert f"| {found[0].outcome.told('e_edge')} |" in (tmp_path / "summary.md").read_text(encoding="utf-8")
    assert "e_edge_low" not in sweep(scene, {"surface.friction": [0.2]}, "rigid").to_dataframe().columns


@pytest.mark.parametrize("ask", [fem_impact.simulate, fem_impact.assess, lambda name: sweep(name, {})])
def test_the_name_of_a_scene_is_told_to_be_loaded(ask):
    with pytest.raises(UsageError, match=r"""scene="t5b": is not a scene\. Load one.*fem_impact\.load"""):
        ask("t5b")


def test_a_friction_that_follows_the_materials_is_told(tmp_path):
    scene = fem_impact.replace(fem_impact.load("t5b"), "surface", {"state": "pair"})
    for key, values, told in (
        ("projectile.material", ["pmma", "copper"], True),
        ("impact.angle", ["30 deg", "40 deg"], False),
    ):
        found = fem_impact.sweep(scene, {key: values}, fidelity="rigid")
        document = publish_sweep(found, "t", "fem-impact sweep", tmp_path / key).document
        lines = [line for line in document["findings"] if line.startswith("The friction differs")]
        assert len(lines) == told
        low, high = sorted(found.numbers("friction_f"))
        assert not told or f"`friction_f` {low:.3g} to {high:.3g}" in lines[0]


def test_a_name_that_begins_with_digits_is_no_quantity():
    for name in ("42crmo4", "100cr6"):
        assert measure(name) == (name, "") and quantity(name) is None and in_unit(name, "") == name
    assert quantity("42 mm") == ("42", "mm") and measure("42mm") == (42.0, "mm")
    assert quantity("2 %") == ("2", "%") and quantity("1e-3") == ("1e-3", "") and quantity("A") is None


def test_a_column_of_names_that_begin_with_digits_has_no_unit():
    names = ["42crmo4", "100cr6"]
    rows = [
        SweepRow(Variation(f"case-{name}", {"projectile.material": name}, None), outcome(), "")
        for name in names
    ]
    table = Results({"projectile.material": names}, tuple(rows)).table(())
    assert table.names[:2] == ("case", "projectile.material") and [*table.cells(table.names[1])] == names


@pytest.mark.parametrize("end", ["low", "high"])
def test_numbers_of_a_key_that_ends_as_a_column_of_ends_does_are_its_own(end):
    name = f"strikes_other_end_over_first_{end}"
    found = made_up((None, None), **{name: 0.75}).numbers(name)
    assert found.tolist() == [0.75, 0.75]
    banded = made_up((None, None), mesh_limit={"mu": 0.5}, mesh_band={"mu": 0.125}, mu=0.5)
    assert [banded.numbers(f"mu_{side}").tolist() for side in ("low", "high")] == [2 * [0.375], 2 * [0.625]]
