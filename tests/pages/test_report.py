import base64
import gzip
import hashlib
import json
import os
import re
from html.parser import HTMLParser

import outcome_maker
import pytest
import result_maker

from fem_impact.errors import ResultError
from fem_impact.files.atomic import read_signed, signed, write_bytes
from fem_impact.outcome.check import SCHEMA_VERSION
from fem_impact.pages.html import bullets, paragraph, section, table
from fem_impact.pages.sections import contact_places, effects_section
from fem_impact.pages.study_page import draw_study, read_study
from fem_impact.pages.write import write_report
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace
from fem_impact.scene.types import digest, to_toml
from fem_impact.tables.table import Marked, Table, number

pytestmark = pytest.mark.usefixtures("unrendered")

VOID = {"meta", "link", "img", "source", "br"}


class Reader(HTMLParser):
    """Collects tags, addresses and text; fails on tags that do not close in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.addresses, self.words, self.scripts = [], [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.addresses += [
            value for name, value in attrs if name in ("src", "srcset", "href", "poster", "data")
        ]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        (self.scripts if self.open[-1:] == ["script"] else self.words).append(data)

    def figures(self):
        """Return the panels of each figure, after a check that no other script stands in the page."""
        *shown, library, own = self.scripts
        assert len(own) < 2000 and "Plotly.newPlot" in own
        assert len(gzip.decompress(base64.b64decode(library))) > 1e6
        assert self.tags.count("script") == len(shown) + 2
        return [json.loads(text) for text in shown]


@pytest.fixture
def run(tmp_path):
    """A run's folder that may be written to."""
    return result_maker.write_result(tmp_path)


def read(path):
    text = path.read_text(encoding="utf-8")
    reader = Reader(text)
    return reader, " ".join(" ".join(reader.words).split())


def test_run_report_is_whole_and_refers_to_nothing_outside(run):
    reader, words = read(write_report(run))
    assert all(address.startswith("data:") for address in reader.addresses)
    assert not {"link", "iframe"} & set(reader.tags)
    assert [len(panels) for panels in reader.figures()] == [1, 1, 1]  # shares, ledger, force
    titles = "Where the energy went", "Energy over time", "Contact force", "What is not known", "Sources"
    for told in (*titles, "0.597", "no damping effect was in the model", "−1.485"):
        assert told in words


def test_run_report_warns_and_says_when_a_run_was_cut_off(run):
    result_maker.write_result(run, finished=False, stopped_because="The time limit came first.")
    words = read(write_report(run))[1]
    assert "t5b was cut off: The time limit came first." in words
    assert "Where the energy went: at the stop of this unfinished run" in words
    assert "Yield stress is uncertain" in words


def test_figures_and_their_data_stay_beside_the_report(run):
    write_report(run)
    names = {path.name for path in (run / "figures").iterdir()}
    assert {"ledger.svg", "ledger.csv", "force.csv", "partition.csv", "partition.svg"} <= names


def test_film_is_embedded_when_there_is_one(run):
    assert "video" not in read(write_report(run))[0].tags
    write_bytes(run / "film.mp4", b"not really a film")
    reader, words = read(write_report(run))
    assert "video" in reader.tags
    assert any(address.startswith("data:video/mp4;base64,") for address in reader.addresses)
    assert "PyVista" in words


def test_rigid_theory_stands_beside_the_numbers(run):
    assert "rigid theory:" not in read(write_report(run))[1]
    scene = load("t5b")
    result_maker.write_result(run, scene_digest=digest(scene), e_paper=0.33)
    (run / "scene.toml").write_text(to_toml(scene))
    words = read(write_report(run))[1]
    predicted = simulate(scene, "rigid")
    assert f"rigid theory: {number(predicted.restitution.paper.e)}" in words
    assert f"rigid theory: {number(predicted.motion.Omega)} rad/s" in words
    assert "rigid theory: none" in words  # of vibration
    assert "All shares beside rigid theory" in words


def test_the_waves_have_a_diagram_with_data(run):
    assert "Waves along the projectile" not in read(write_report(run))[1]
    result_maker.write_waves(run / "waves.h5")
    assert "Waves along the projectile" in read(write_report(run))[1]
    assert (run / "figures" / "waves.csv").is_file()
    (run / "waves.h5").write_bytes(b"no waves")
    assert "No diagram of the waves" in read(write_report(run))[1]


SITE = ("start_s", "end_s", "impulse_n_Ns", "impulse_t_Ns", "low_t_m", "high_t_m", "width_m", "depth_m")
HERE = dict(zip(SITE, (1e-6, 161e-6, 0.2918, 0.1354, -1.14e-3, 1.02e-3, 3.38e-3, 61.9e-6), strict=True))
FOOT = dict(zip(SITE, (4e-6, 30e-6, 0.05, -0.01, 2e-3, 3e-3, 1.1e-3, 12e-6), strict=True))


def places(**values):
    text = contact_places(outcome_maker.outcome(contact_sites=[HERE, FOOT], **values)).text
    return " ".join(" ".join(Reader(text).words).split())


def test_the_places_of_contact_are_told():
    words = places(tip_size_m=3e-4)
    assert "known to about a cell, 0.3 mm" in words
    assert "1 1.0 161.0 0.29 0.14 −1.14 to 1.02 3.38 61.9 2 4.0 30.0 0.05 −0.01 2 to 3 1.1 12" in words


def test_a_rigid_barrier_is_not_said_to_be_indented():
    assert "−1.14 to 1.02 3.38 – 2" in places(elements_barrier=None)


def test_a_run_without_places_of_contact_has_no_table_of_them(run):
    assert "Places of contact" not in read(write_report(run))[1]


def test_everything_from_outside_is_escaped(run):
    evil = '<script>alert("x")</script>&'
    result_maker.write_result(
        run,
        scene_title=evil,
        limitations=result_maker.limited(run=evil, range=evil),
        stopped_because=evil,
        effects=[evil],
        versions={evil: evil},
        reasons={**result_maker.REASONS, "mesh_band": evil},
    )
    (run / "scene.toml").write_text(f"title = '{evil}'")
    reader, words = read(write_report(run))
    assert reader.figures()
    assert words.count('<script>alert("x")</script>&') >= 8


def test_a_page_runs_its_own_scripts_only(run):
    text = write_report(run).read_text()
    reader = Reader(text)
    reader.figures()
    policy = re.search(r"script-src ([^;\"]*)\"", text)[1]
    library, own = gzip.decompress(base64.b64decode(reader.scripts[-2])), reader.scripts[-1].encode()
    digests = [base64.b64encode(hashlib.sha256(script).digest()).decode() for script in (library, own)]
    assert policy == " ".join(f"'sha256-{digest}'" for digest in digests)


def test_a_page_with_figures_is_small_enough_beside_a_film(run):
    result_maker.write_waves(run / "waves.h5")
    assert write_report(run).stat().st_size < 3e6


def test_a_rigid_impact_is_said_to_have_no_curves(tmp_path):
    run = result_maker.write_result(tmp_path, fidelity="rigid")
    (run / "history.csv").unlink()
    assert "No curves over time: a rigid impact takes no time." in read(write_report(run))[1]


def test_missing_history_is_said_and_not_fatal(run):
    (run / "history.csv").unlink()
    words = read(write_report(run))[1]
    assert "No curves over time" in words
    assert "Coefficients and losses" in words


def test_files_that_are_not_of_the_run_are_told(run):
    scene = load("t5b")
    result_maker.write_result(run, scene_digest=digest(scene))
    (run / "scene.toml").write_text(to_toml(scene))
    assert "To keep in mind scene.toml" not in read(write_report(run))[1]
    (run / "scene.toml").write_text(to_toml(replace(scene, "impact.angle", "30 deg")))
    assert "scene.toml was changed after the run" in read(write_report(run))[1]
    rows = (run / "history.csv").read_text().splitlines()
    assert "it is not whole" not in read(write_report(run))[1]
    (run / "history.csv").write_text("\n".join(rows[: len(rows) // 4]) + "\n")
    assert "before the last contact does" in read(write_report(run))[1]


def test_vibration_below_its_floor_is_not_given_a_number(run):
    result_maker.write_result(run, E_vib_below_floor=True)
    assert "below floor" in read(write_report(run))[1]


def test_band_stands_beside_its_value(run):
    limits, bands = {"mu": 0.611, "e_paper": 0.24}, {"mu": 0.0123, "e_paper": 0.02}
    result_maker.write_result(run, mesh_limit=limits, mesh_band=bands)
    words = read(write_report(run))[1]
    assert words.count("0.611 ± 0.013") == 2  # first figures, motion
    assert "0.240 ± 0.020" in words
    assert "0.597" in words  # of the run itself, in the whole record


def test_folder_without_a_result(tmp_path):
    with pytest.raises(ResultError, match=r"neither outcome\.json nor study\.json"):
        write_report(tmp_path)


def test_damaged_outcome_gives_no_report(run):
    (run / "outcome.json").write_text((run / "outcome.json").read_text()[:500])
    with pytest.raises(ResultError, match=r"outcome\.json: not a readable JSON record"):
        write_report(run)
    assert not (run / "report.html").exists()


@pytest.fixture
def study(tmp_path):
    """A study's folder with one run's histories."""
    (tmp_path / "t4").mkdir()
    result_maker.write_result(tmp_path / "t4", scene_id="t4")
    return result_maker.write_study(tmp_path, ("t4", "t5b"))


def edit(study, **changes):
    path = study / "study.json"
    path.write_text(json.dumps(signed(read_signed(path.read_text(), "study.json") | changes)))


def test_study_report_compares_every_row(study):
    reader, words = read(write_report(study))
    assert all(address.startswith("data:") for address in reader.addresses)
    rows = json.loads((study / "study.json").read_text())["comparison"]
    inside = sum(row["verdict"].startswith("inside") for row in rows)
    assert f"{inside} of {len(rows)}" in words
    assert words.count("outside the 95 % interval") == len(rows) - inside
    assert re.search(r"t4: 0\.08 m rod", words)


def test_study_report_takes_pictures_that_are_younger_than_their_run(study):
    write_report(study)
    ledger, history = study / "t4" / "figures" / "ledger.svg", study / "t4" / "history.csv"
    drawn = ledger.stat().st_mtime_ns
    write_report(study)
    assert ledger.stat().st_mtime_ns == drawn
    os.utime(history)
    write_report(study)
    assert ledger.stat().st_mtime_ns > drawn


def test_a_study_drawn_beforehand_is_only_drawn_again_if_asked(study):
    draw_study(study)
    own = [study / "figures" / f"{name}.svg" for name in ("comparison", "partition")]
    drawn = [file.stat().st_mtime_ns for file in own]
    reader, _ = read(write_report(study, again=False))
    assert [file.stat().st_mtime_ns for file in own] == drawn
    assert reader.addresses == read(write_report(study))[0].addresses
    assert all(file.stat().st_mtime_ns > before for file, before in zip(own, drawn, strict=True))


def test_a_study_begins_with_its_answer_and_folds_the_rest(study):
    edit(study, findings=["The answer is 5.", "Another finding."], assumptions=["What it assumes."])
    text = write_report(study).read_text()
    start = text.index('<p class="answer">The answer is 5.</p>')
    assert start < text.index('class="cards"') < text.index("Model beside measurement</h2>")
    folded = text[text.index("<summary>What else was found") :]
    assert folded.index("Another finding.") < folded.index("</details>")


def test_study_report_names_failures_and_assumptions(study):
    edit(
        study,
        failures=[{"scene_id": "t2", "error": "the ledger did not close"}],
        assumptions=["Friction rule: 0.57."],
    )
    words = read(write_report(study))[1]
    assert "t2 the ledger did not close" in words
    assert "Friction rule: 0.57." in words


def test_texts_of_a_study_are_escaped(study):
    evil = "<script>x</script>"
    result_maker.write_result(study / "t4", scene_id="t4", scene_title=evil)
    rows = [result_maker.values(scene_id="t4", scene_title=evil)]
    compared = [
        row | {"quantity": evil, "set": evil, "verdict": evil} for row in result_maker.comparison(("t4",))
    ]
    failures = [{"scene_id": evil, "error": evil}]
    edit(study, title=evil, rows=rows, comparison=compared, failures=failures, findings=[evil])
    reader, words = read(write_report(study))
    assert reader.figures()
    assert words.count(evil) >= 8


def test_study_without_runs_or_comparison_still_reports(study):
    edit(study, rows=[], comparison=[], failures=[{"scene_id": "t2", "error": "stopped"}])
    assert "t2 stopped" in read(write_report(study))[1]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"schema": "other/2"}, '"schema" = "other/2" is not'),
        ({"rows": "none"}, "rows must be array"),
        ({"rows": [{"schema_version": SCHEMA_VERSION}]}, r"rows\[0\]: key .* is missing"),
        (
            {"rows": [{"schema_version": 3}]},
            rf"rows\[0\]: .* is not the version {SCHEMA_VERSION} .*; compute the run again",
        ),
        ({"comparison": [{"set": "t2"}]}, r"comparison\[0\] must contain .*quantity"),
    ],
)
def test_wrong_study_is_refused(study, change, message):
    edit(study, **change)
    with pytest.raises(ResultError, match=message):
        read_study(study)


def test_comparison_with_a_text_for_a_number_is_refused(study):
    rows = result_maker.comparison(("t2",))
    rows[0]["model"] = "0.5"
    edit(study, comparison=rows)
    with pytest.raises(ResultError, match=r"comparison\[0\]\.model must be number or null"):
        read_study(study)


def test_an_interval_whose_ends_are_exchanged_is_refused(study):
    rows = result_maker.comparison(("t2",))
    rows[0] |= {"measured_low": 0.5, "measured_high": 0.25}
    edit(study, comparison=rows)
    with pytest.raises(
        ResultError, match=r"comparison\[0\]\.measured_low = 0.5 is above measured_high, 0.25"
    ):
        read_study(study)


def test_truncated_study_is_refused(study):
    text = (study / "study.json").read_text()
    (study / "study.json").write_text(text[: len(text) // 2])
    with pytest.raises(ResultError, match=r"study\.json: not a readable JSON record"):
        write_report(study)


@pytest.mark.parametrize(
    ("value", "text"),
    [(None, "–"), (True, "yes"), (40000, "40\u202f000"), (-1.48512, "−1.485"), (2e-6, "2e−06")],
)
def test_numbers_for_the_eye(value, text):
    assert number(value) == text


def test_pieces_escape_and_vanish_when_empty():
    assert paragraph("a < b").text == "<p>a &lt; b</p>"
    assert bullets([]).text == table(Table.of(("a",), [])).text == section("Title").text == ""
    assert '<td class="inside">&amp;</td>' in table(Table.of(("a",), [[Marked("&", "inside")]])).text


def test_an_effect_is_shown_with_its_number_threshold_and_whether_it_is_on():
    shared = {"forced": False, "needed": True, "measure": "m", "source": "s", "sentence": "t"}
    shared |= {"number": 1.25, "threshold": 0.5, "share": None}
    names = {"barrier-elastoplastic": True, "gravity": False}
    choices = [shared | {"name": name, "on": on} for name, on in names.items()]
    text = str(effects_section(outcome_maker.outcome(effect_choices=choices)))
    plastic, gravity = text.split("<tr>")[-2:]
    assert ">on<" in plastic and ">off<" in gravity
    assert all("1.25" in row and "0.5" in row for row in (plastic, gravity))
