"""The study of verdicts: its scenes, which checks follow, what counts as decided and as right."""

import re
from collections import Counter

from study_fakes import published

from fem_impact.answers.report import Request
from fem_impact.evidence.studies import verdicts as study
from fem_impact.evidence.studies.coverage.run import ASSESS, CHECK, CoverageResult
from fem_impact.jobs.job import Failure


def verdict(answer="yes", levels=0, change=0.01):
    told = {"answer": answer, "model": "solid" if levels else "modal", "levels": levels}
    words = {"tried": "the reduced model", "missing": "", "next": ""}
    return CoverageResult(None, changes={"e": (change, 0.02)}, verdict=told | words)


def test_every_family_has_as_many_scenes_as_every_other(tmp_path):
    scenes = study.scenes(Request(tmp_path))
    families = Counter(one.family for one in scenes)
    assert len(scenes) == study.COUNT and len(families) == study.GROUPS
    assert max(families.values()) - min(families.values()) == 1
    few = study.scenes(Request(tmp_path, first=1))
    assert few == scenes[: study.GROUPS] and not any(
        one in scenes for one in study.scenes(Request(tmp_path, first=1, seed=7))
    )


def test_a_decided_scene_is_checked_on_two_levels_more(tmp_path):
    request = Request(tmp_path, first=1)
    verdicts = study.plan(request, {})
    answers = [verdict(), verdict("no", 3), verdict("undecided", 4), CoverageResult(None, "stopped", "why")]
    answers += [verdict("probably no", 4)]
    results = dict(zip((run.name for run in verdicts), answers, strict=False))
    results[verdicts[5].name] = Failure("lost", "killed")
    checks = [run for run in study.plan(request, results) if run.model == CHECK]
    assert [(run.drawn.name, run.levels) for run in checks] == [
        (verdicts[0].drawn.name, 3),
        (verdicts[1].drawn.name, 5),
        (verdicts[4].drawn.name, 6),
    ]
    assert {run.model for run in study.plan(Request(tmp_path, quick=True), results)} == {ASSESS}


def test_right_is_what_the_finer_run_says_by_its_value(tmp_path):
    request = Request(tmp_path, first=1)
    answers = [*[verdict()] * 3, verdict("no", 2, 0.1), *[verdict("probably no", 3, 0.06)] * 2]
    answers += [verdict("undecided", 3)] * 5
    runs = study.plan(request, {})
    results = {run.name: answer for run, answer in zip(runs, answers, strict=False)}
    results[runs[-1].name] = CoverageResult(None, "stopped", "no model gives e.")
    found = {0: (0.01, 0.01), 1: (0.06, 0.02), 3: (-0.09, 0.01), 4: (0.04, 0.02), 5: (0.07, 0.01)}
    for number, change in found.items():
        results[study.plan(request, results)[len(runs) + number].name] = CoverageResult(
            None, changes={"e": change}
        )
    text = published(study.conclude, request, results).text
    assert "decided 6 of 12 (25 to 75 %), of these 4 surely and 2 probably: 5 undecided, 3 yes" in text
    same = (
        "say the same of 3 of 5 ({}) of the decided, 2 of 3 ({}) of the sure and 1 of 2 ({}) of the probable"
    )
    assert re.search(re.escape(same).replace(r"\{\}", "[^)]*"), text)
    assert "in 2 the half-width of the finer run" in text
    assert "1 were decided and not checked" in text and "no model gives e." in text
    held = r"told of 1 of 2 \([^)]*\) by the reduced model and of 2 of 3 \([^)]*\) by finite elements"
    assert re.search(held, text)
