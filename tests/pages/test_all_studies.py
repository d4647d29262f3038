"""One page over all studies: everything inside it, nothing outside; what the paper's conclusions come to."""

import csv
import json
import re
from dataclasses import replace

import pytest
from result_maker import values

from fem_impact.answers.compare import compare
from fem_impact.answers.report import Request, Sheet, StudyReport, publish
from fem_impact.errors import ResultError
from fem_impact.evidence.studies.sets import sets_report
from fem_impact.figures.panels import Panel, Picture, Series
from fem_impact.files.atomic import read_signed, signed
from fem_impact.outcome.record import Outcome
from fem_impact.pages.all_page import write_all
from fem_impact.pages.study_page import read_study
from fem_impact.pages.write import write_report
from fem_impact.tables.table import Table

pytestmark = pytest.mark.usefixtures("unrendered")


@pytest.fixture
def results(tmp_path):
    """A folder with one small study."""
    panel = Panel("a line", "x, m", "y, -", (Series("one", [0.0, 1.0], [2.0, 3.0]),))
    sheets = [
        Sheet("numbers", "Some numbers", Table.of(("name", "value_m"), [["<b>", 0.25], ["none", None]]))
    ]
    picture = Picture("line", "A rising line.", (panel,))
    report = StudyReport("gamma", "A study", ["It rises & falls."], [picture], sheets)
    report = replace(report, conclusions=[("line", "It rises & falls.")])
    publish(report, Request(tmp_path / "gamma", quick=True), {"run-1": Outcome.from_dict(values())})
    return tmp_path


def test_the_page_holds_findings_figures_data_and_ledger(results):
    page = write_all(results, results / "report").read_text()
    question = "When may a rod be called rigid, and how much energy does vibration take?"
    answer = f"<strong>{question}</strong> It rises &amp; falls."
    assert "1 studies, 1 runs, 0 of them failed." in page
    assert 0 < page.index(answer) < page.index("<details>") < page.index('<div id="gamma">')
    assert page.count('<figure class="live">') == 1 and '"x":[0.0,1.0],"y":[2.0,3.0]' in page
    assert "&lt;b&gt;" in page
    assert "<code>fem-impact study gamma --quick</code>" in page
    assert {"line.csv", "numbers.csv", "ledger.csv"} <= set(re.findall(r'download="([\w.-]+)"', page))
    assert not re.findall(r'(?:src|href)="(?!data:|#)', page)
    assert (
        set(re.findall(r'href="#([\w-]+)"', page))
        == set(re.findall(r'id="([\w-]+)"', page)) - {"library"}
        == {"gamma", "gamma-line"}
    )
    (row,) = csv.DictReader((results / "report" / "ledger.csv").read_text().splitlines())
    assert (row["study"], row["run"]) == ("gamma", "run-1")
    told = (results / "report" / "summary.md").read_text()
    assert "](../gamma/figures/line.png)" in told
    assert "- It rises & falls. ([figure](../gamma/figures/line.png))" in told


def test_a_study_alone_has_a_page_too(results):
    assert "A rising line." in write_report(results / "gamma").read_text()


def test_the_papers_conclusions_are_judged(results):
    row = Outcome.from_dict(values(scene_id="t5b", E_vib_over_E_0=0.03, mu=0.7, mu_c=0.5))
    publish(sets_report([row], compare(row)), Request(results / "sets"), {"t5b": row})
    page = write_all(results, results / "report").read_text()
    for words in (
        "while vibration took 3 to 3 %",
        "measured or computed, in t5b",
        "<sub>lt</sub> is not the",
    ):
        assert words in page
    for name in ("closure", "moment", "critical", "heat"):
        assert (results / "report" / "figures" / f"{name}.csv").stat().st_size > 100
    ledger = (results / "report" / "ledger.csv").read_text().splitlines()
    assert [line.split(",")[1] for line in ledger[1:]] == ["t5b", "run-1"]
    assert "<code>fem-impact study sets</code>" in page
    assert {"partition.csv", "closure.csv"} <= set(re.findall(r'download="([\w.-]+)"', page))
    assert set(re.findall(r'href="#([\w-]+)"', page)) <= set(re.findall(r'id="([\w-]+)"', page))
    assert "within 0.003 m/s along n, 0.003 m/s along t and 0.1 rad/s" in page


def test_a_folder_of_studies_is_told_how_to_get_its_page(results, cli):
    code, _, err = cli("report", str(results))
    assert code != 0
    assert (
        f"holds studies. Name one, or write a page over all: fem-impact study report --out {results}" in err
    )


def test_an_empty_folder_is_refused_with_a_remedy(tmp_path):
    with pytest.raises(ResultError, match=r"holds no study\. Run one"):
        write_all(tmp_path, tmp_path / "report")


@pytest.mark.parametrize(
    "harm",
    [
        lambda held: held.pop("findings"),
        lambda held: held.update(figures=[{"name": "../../secret", "caption": "x"}]),
        lambda held: held["sheets"][0]["rows"][0].pop(),
    ],
)
def test_a_wrong_study_is_refused(results, harm):
    path = results / "gamma" / "study.json"
    held = read_signed(path.read_text(), "study.json")
    harm(held)
    path.write_text(json.dumps(signed(held)))
    with pytest.raises(ResultError, match=r"gamma/study\.json: .*(must|fit)"):
        read_study(results / "gamma")


def test_a_study_changed_by_hand_is_refused(results):
    path = results / "gamma" / "study.json"
    path.write_text(path.read_text().replace("It rises", "It falls"))
    with pytest.raises(ResultError, match="was damaged or edited"):
        read_study(results / "gamma")
