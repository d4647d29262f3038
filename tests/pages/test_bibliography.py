"""The one bibliography: it is read whole, and a scene cites what its run rests on."""

import re
from importlib import resources

from fem_impact.case.effects.registry import EFFECTS
from fem_impact.pages.bibliography import behind, references

TEXT = resources.files("fem_impact.pages").joinpath("data", "references.bib").read_text(encoding="utf-8")


def test_every_entry_is_read_with_all_its_fields():
    assert len(references()) == TEXT.count("\n@")
    assert sum(len(one.fields) for one in references()) == len(re.findall(r"^  \w+ = ", TEXT, re.MULTILINE))
    assert len({one.key for one in references()}) == len(references())


def test_a_line_and_bibtex_of_an_entry():
    one = next(one for one in references() if one.key == "hughes1980")
    assert one.text.startswith("T. J. R. Hughes: Generalization of selective")
    assert one.text.endswith("15, 1413-1418, 1980. doi:10.1002/nme.1620150914 (mean dilatation)")
    assert one.bibtex.startswith("@article{hughes1980,\n  author = {T. J. R. Hughes},")
    assert "for =" not in one.bibtex


def test_what_an_entry_is_for_is_an_effect_or_a_known_word():
    words = {"always", "cite", "figures", "film", "modal", "solid", "rigid"}
    of_studies = {"convergence", "qmc", "slenderness", "sobol", "thornton"}
    named = {name for one in references() for name in one.used_for}
    assert named <= words | of_studies | set(EFFECTS)


def test_a_scene_cites_what_its_run_rests_on(cli):
    code, out, _ = cli("cite", "t5b", "--fidelity", "modal")
    assert code == 0
    keys = re.findall(r"^@\w+\{(\w+),", out, re.MULTILINE)
    assert {"fem_impact", "averill", "thornton1997"} <= set(keys) and "cremer2005" not in keys
    assert "hughes1980" in [one.key for one in behind(["rod-plasticity"])]
