import json

import numpy as np
import pytest

from fem_impact import load
from rigid import Projectile, solve
from rigid.experiments import measured_set

ROD = ("--length", "80 mm", "--diameter", "19 mm", "--angle", "45 deg")
HEADER = "test,v_n_m_per_s,v_t_m_per_s,V_n_m_per_s,V_t_m_per_s,Omega_rad_per_s"
GOOD = (
    "1,-1.572,-1.602,0.381,-0.371,3.607",
    "2,-1.516,-1.507,0.271,-0.369,1.019",
    "3,-1.475,-1.475,0.340,-0.338,2.933",
)


def rows_of(id):
    s = measured_set(id)
    columns = [s.printed["test"].astype(int), *(s.motion[k] for k in ("v_n", "v_t", "V_n", "V_t", "Omega"))]
    return [",".join(str(x) for x in row) for row in zip(*columns, strict=True)]


def found(cli, path, *more):
    code, out, err = cli("coefficients", path, *ROD, *more, "--json")
    assert (code, err) == (0, "")
    return json.loads(out)


def test_the_papers_own_table_comes_back(cli, camera_file):
    document = found(cli, camera_file(*rows_of("t5b")), "--d-c", "22.6 mm", "--d-d", "35 mm")
    s = measured_set("t5b")
    for i, row in enumerate(document["rows"]):
        assert row["e"] == pytest.approx(s.printed["e"][i], abs=2e-3)
        assert row["mu"] == pytest.approx(s.printed["mu"][i], abs=2e-3)
    assert document["scatter"]["e"]["mean"] == pytest.approx(0.327, abs=1e-3)
    assert document["arms"] == {"d_c_m": 0.0226, "d_d_m": 0.035, "source": "as stated"}
    e = document["coefficients"]["e"]
    for way in ("first_order", "bootstrap"):
        assert e[way]["low"] < e["value"] < e[way]["high"]
    assert e["first_order"]["sd"] == pytest.approx(e["bootstrap"]["sd"], rel=0.15)


def test_known_coefficients_are_found(cli, camera_file):
    """Made with the package's own rod and arms, so that only the way through the file is in doubt."""
    rod = Projectile(0.08, 0.019, "B", 0.003, 7850.0)
    arms = rod.arms(np.radians(45.0))
    lines = []
    for i, v in enumerate((1.4, 1.5, 1.6)):
        after = solve(-v, -v, e=0.35, mu=0.5, e_m=-0.9, **arms._asdict(), k2=rod.k2)
        lines.append(",".join(repr(float(x)) for x in (i, -v, -v, *after)))
    document = found(cli, camera_file(*lines))
    for name, value in (("e", 0.35), ("mu", 0.5), ("e_m", -0.9)):
        assert document["coefficients"][name]["value"] == pytest.approx(value, rel=1e-9)
        assert document["coefficients"][name]["first_order"]["parts"]["scatter"] < 1e-6
    assert document["arms"]["source"].startswith("lowest point")
    centre = document["impulse_centre"]
    assert centre["from_contact_m"] == pytest.approx(-0.1 * (arms.d_c - 0.5 * arms.d_d), rel=1e-6)


def test_a_velocity_in_another_unit_is_refused_and_another_impact_than_the_scenes_is_told(cli, camera_file):
    """Tests in mm/s that were called m/s had e to three digits, without a word."""
    thousands = [
        ",".join([row[0], *(f"{1e3 * float(x):g}" for x in row[1:])]) for row in (r.split(",") for r in GOOD)
    ]
    code, _, err = cli("coefficients", camera_file(*thousands), *ROD)
    assert code == 5 and "line 2, column v_n_m_per_s: -1572" in err and "is its unit right?" in err
    other = "--scene", "t5b", "--set", "impact.v_t=-0.4 m/s"
    told = json.loads(cli("coefficients", camera_file(*GOOD), *other, "--json")[1])["notes"][0]
    assert "Test 1 of 3, the first of 3 like it, has v_t = -1.602 m/s, the scene -0.4 m/s" in told


def test_a_scene_states_the_projectile_that_was_tested(cli, camera_file):
    """A tube has other inertia than the solid rod of its size; its own coefficients come back."""
    body, alpha = load("tube").projectile.rigid_body, load("tube").impact.angle
    arms = body.arms(alpha)
    lines = []
    for i, v in enumerate((1.4, 1.5)):
        after = solve(-v, -v, e=0.35, mu=0.5, e_m=-0.9, **arms._asdict(), k2=body.k2)
        lines.append(",".join(repr(float(x)) for x in (i, -v, -v, *after)))
    asked = ("coefficients", camera_file(*lines), "--scene", "tube", "--json")
    document = json.loads(cli(*asked)[1])
    assert document["rod"]["mass_kg"] == pytest.approx(body.mass)
    for name, value in (("e", 0.35), ("mu", 0.5), ("e_m", -0.9)):
        assert document["coefficients"][name]["value"] == pytest.approx(value, rel=1e-9)
    steep = json.loads(cli(*asked, "--set", "impact.angle=40 deg")[1])
    assert steep["rod"]["alpha_rad"] == pytest.approx(np.radians(40.0))


def test_coefficients_count_the_spin_before_and_the_motion_of_the_barrier(cli, camera_file):
    """The same impact over the ground and as seen from the barrier, and with its spin in either place."""
    rows = [f"{i},-1.5,-1.48,-1.14,{v},61" for i, v in enumerate((-1.26, -1.25))]
    spun = ("--scene", "t5b", "--set", "impact.omega=60 rad/s")
    plain = json.loads(cli("coefficients", camera_file(*rows), *spun, "--json")[1])
    assert 0.8 < plain["coefficients"]["e"]["value"] < 1.0
    assert not any("more kinetic energy" in note for note in plain["notes"])
    with_spin = camera_file(*(f"{row},60" for row in rows), header=f"{HEADER},omega_rad_per_s")
    column = json.loads(cli("coefficients", with_spin, "--scene", "t5b", "--json")[1])
    assert column["coefficients"] == plain["coefficients"]
    assert not any("not used" in note for note in column["notes"])
    moved = [f"{i},-0.5,-1.48,-0.14,{v},61" for i, v in enumerate((-1.26, -1.25))]
    moving = (*spun, "--set", "impact.v_n=-0.5 m/s", "--set", "barrier.v_n=1 m/s")
    seen = json.loads(cli("coefficients", camera_file(*moved), *moving, "--json")[1])
    assert seen["coefficients"]["e"]["value"] == pytest.approx(plain["coefficients"]["e"]["value"])
    assert not any("not the scene's impact" in note for note in seen["notes"])
    turning = [f"barrier.{one}" for one in ("mass=0.3 kg", "inertia=1e-4 kg m2", "centre_depth=10 mm")]
    asked = (word for one in turning for word in ("--set", one))
    code, _, err = cli("coefficients", camera_file(*rows), *spun, *asked)
    assert code == 3 and "The barrier turns" in err


@pytest.mark.parametrize(
    ("more", "words"),
    [(ROD[:2], "--diameter, --angle are missing"), (("--scene", "tube", *ROD), "describes a rod")],
)
def test_a_solid_rod_is_stated_in_full_or_a_scene_is_named(cli, camera_file, more, words):
    code, _, err = cli("coefficients", camera_file(*GOOD), *more)
    assert code == 2
    assert words in err


def test_units_in_the_header_are_converted(cli, camera_file):
    turned = [
        "1,-1572,-1.602,0.381,-0.371,206.666",
        "2,-1516,-1.507,0.271,-0.369,58.3844",
        "3,-1475,-1.475,0.34,-0.338,168.0485",
    ]
    header = "test,v_n [mm/s],v_t (m/s),V_n_m_per_s,V_t [m/s],Omega_deg_per_s"
    other = found(cli, camera_file(*turned, header=header, name="units.csv"))
    for a, b in zip(found(cli, camera_file(*GOOD))["rows"], other["rows"], strict=True):
        assert [b[k] for k in ("e", "mu", "e_m")] == pytest.approx(
            [a[k] for k in ("e", "mu", "e_m")], rel=1e-4
        )


def test_a_spreadsheets_file_is_read(cli, camera_file):
    """Byte-order mark, blank lines, remarks, another column."""
    path = camera_file(
        "a,-1.5,-1.5,0.3,-0.4,5,wet",
        "",
        "# second day",
        "b,-1.5,-1.5,0.4,-0.4,4,dry",
        header=f"{HEADER},note",
    )
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    document = found(cli, path)
    assert [row["test"] for row in document["rows"]] == ["a", "b"]
    assert document["notes"][0] == "columns not used: note"


@pytest.mark.parametrize(("mark", "encoding"), [(";", "cp1252"), ("\t", "utf-16")])
def test_tables_of_spreadsheets_are_read_as_they_are_saved(cli, camera_file, mark, encoding):
    """Semicolons or tabs, decimal commas, empty cells at the ends, another encoding of the comment."""
    path = camera_file(*GOOD)
    plain = found(cli, path)
    rows = "\n".join(line.replace(",", mark).replace(".", ",") + mark for line in GOOD)
    text = f"# at 20 \u00b0C\n{HEADER.replace(',', mark)}{mark}\n{rows}\n"
    path.write_bytes(text.encode(encoding))
    assert found(cli, path)["rows"] == plain["rows"]


@pytest.mark.parametrize(
    ("lines", "header", "words"),
    [
        (GOOD[:1], HEADER, ["holds 1 tests", "at least two"]),
        ((*GOOD, "4,-1.5,-1.5,0.3,abc,5"), HEADER, ["line 5, column V_t_m_per_s", "'abc'"]),
        ((*GOOD, "4,-1.5,-1.5,0.3,,5"), HEADER, ["line 5, column V_t_m_per_s: is empty"]),
        ((*GOOD, "4,-1.5,-1.5,0.3,nan,5"), HEADER, ["line 5, column V_t_m_per_s", "finite"]),
        ((*GOOD, "4,-1.5,-1.5,0.3,-0.4,1e150"), HEADER, ["line 5, column Omega_rad_per_s", "no speed"]),
        ((GOOD[0], "", "4,1.5,-1.5,0.3,-0.4,5"), HEADER, ["line 4, column v_n_m_per_s: 1.5 must be"]),
        ((*GOOD, "4,-1.5,-1.5,-1.6,-0.4,5"), HEADER, ["line 5, column V_n_m_per_s: -1.6 must exceed v_n"]),
        ((*GOOD, "4,-1.5,-1.5"), HEADER, ["line 5 has 3 cells, the header 6"]),
        ((*GOOD, "4,-1,5,-1,5,0,1,2"), HEADER, ["line 5 has 8 cells", "decimal commas need semicolons"]),
        (GOOD, HEADER.replace("Omega_rad_per_s", "spin"), ["lacks Omega"]),
        (GOOD, HEADER.replace("v_n_m_per_s", "v_n"), ["'v_n' names no unit", "v_n_m_per_s"]),
        (GOOD, HEADER.replace("v_n_m_per_s", "v_n [kn]"), ["'kn' is not a unit of speed", "mm/s"]),
        (GOOD, HEADER.replace("v_t_m_per_s", "v_n [m/s]"), ["v_n has two columns"]),
        (GOOD, HEADER.replace(",", ";"), ["line 2 has 1 cells, the header 6"]),
        (('1,"-1.5', "2"), HEADER, ["not CSV"]),
    ],
)  # fmt: skip
def test_bad_files_are_refused_by_file_line_and_column(cli, camera_file, lines, header, words):
    code, out, err = cli("coefficients", camera_file(*lines, header=header), *ROD)
    assert (code, out) == (5, "")
    for word in ("mine.csv", *words):
        assert word in err
    assert err.count("\n") == 1


def test_an_empty_or_missing_file(cli, tmp_path):
    (tmp_path / "empty.csv").write_text("")
    assert "is empty" in cli("coefficients", "empty.csv", *ROD)[2]
    assert cli("coefficients", "none.csv", *ROD)[0] == 5


@pytest.mark.parametrize(
    ("more", "wanted", "words"),
    [
        (("--d-c", "22 mm"), 2, "one arm alone"),
        (("--length", "80"), 2, '--length "240 mm"'),
        (("--angle", "95 deg"), 3, "from -90 to 90"),
        (("--tip-radius", "12 mm"), 3, "tip_radius"),
        (("--diameter", "-19 mm"), 3, "diameter must be positive"),
    ],
)
def test_bad_options_are_refused(cli, camera_file, more, wanted, words):
    code, _, err = cli("coefficients", camera_file(*GOOD), *ROD, *more)
    assert code == wanted
    assert words in err


def test_doubts_are_said(cli, camera_file):
    gaining = camera_file("x,-1.5,-1.5,1.6,-1.5,5", *GOOD)
    assert "after than before impact in test x" in cli("coefficients", gaining, *ROD)[1]
    up = camera_file("1,-1.5,1.5,0.3,0.4,-5", "2,-1.5,1.4,0.3,0.4,-5")
    assert "v_t > 0" in cli("coefficients", up, *ROD)[1]


def test_text_names_arms_intervals_and_sources(cli, camera_file):
    _, out, _ = cli("coefficients", camera_file(*GOOD), *ROD)
    for words in (
        "3 tests of a projectile 80 mm x 19 mm",
        "d_c = 21.70 mm",
        "first order",
        "contact  tracking",
        "from the contact point",
    ):
        assert words in out


def test_a_face_that_lands_flat_is_met_in_its_middle(cli, camera_file):
    """V_n of -2 and 0.8 m/s, and a spin of 10 rad/s that has no arm there: e = 0.4."""
    flat = [option if option != "45 deg" else "0 deg" for option in ROD]
    path = camera_file(*(f"{test},-2,0,0.8,0,10" for test in (1, 2, 3)))
    code, out, err = cli("coefficients", path, *flat, "--tip", "plain", "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    assert document["arms"]["d_c_m"] == 0.0
    assert document["arms"]["source"] == "middle of what lands flat"
    assert document["coefficients"]["e"]["value"] == pytest.approx(0.4, rel=1e-12)
