"""Pages are executed: scenes read, marked Python run, outputs compared, command lines understood."""

import re
import shlex
import tomllib

import pytest
from page_blocks import PAGES, ROOT, blocks, marked, without_code

import rigid
from fem_impact.cli.parser import build_parser, every_command, read_line
from fem_impact.pages.bibliography import references
from fem_impact.scene.library import surfaces
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import to_dict

QUICK = (
    "fem-impact --version",
    "fem-impact check my-rod.toml",
    'fem-impact coefficients tests.csv --length "80 mm" --diameter "19 mm" --tip B --angle "45 deg"',
    "fem-impact verify modes --parameters",
    'fem-impact verify modes --set length="120 mm"',
)
OWN_SCENE, CAMERA = "docs/tutorials/own-projectile.md", "docs/how-to/camera-data.md"
COMMAND_PARSERS = dict(every_command(build_parser()))


def _leaves(part, above=""):
    """Return the values of a part of a scene by their keys with dots."""
    leaves = {}
    for name, value in part.items():
        inner = isinstance(value, dict) and name not in ("material", "sliding_law")
        leaves |= _leaves(value, f"{above}{name}.") if inner else {f"{above}{name}": value}
    return leaves


@pytest.mark.parametrize("block", blocks("toml"), ids=str)
def test_every_scene_is_valid(block):
    stated = tomllib.loads(block.text)
    scene = read_dict(stated, block.page) if "id" in stated else replace_all(load("t5b"), _leaves(stated))
    assert read_dict(to_dict(scene)) == scene


@pytest.mark.parametrize("block", blocks("python", "run", "python", "rigid-python"), ids=str)
def test_python_that_is_marked_to_run_runs(block, capsys):
    shapes = dict(rigid.SHAPES)
    try:
        exec(compile(block.text, block.page, "exec"), {})
    finally:
        rigid.SHAPES.clear()
        rigid.SHAPES.update(shapes)
    assert capsys.readouterr().out


@pytest.mark.parametrize("block", blocks("python"), ids=str)
def test_all_python_is_python(block):
    assert compile(block.text, block.page, "exec")


def test_pages_have_python_that_runs():
    assert len(blocks("python", "run", "python", "rigid-python")) > 5


LINES = [line for block in blocks("sh") for line in block.text.splitlines()]
OWN = sorted({line for line in LINES if line.startswith("fem-impact ")})


@pytest.mark.parametrize("line", OWN)
def test_every_command_line_is_understood(line, capsys):
    words = shlex.split(line.partition(" > ")[0], comments=True)[1:]
    if words[-1] == "--help":
        with pytest.raises(SystemExit) as stop:
            read_line(words)
        assert (stop.value.code, "usage:" in capsys.readouterr().out) == (0, True)
        return
    options = read_line(words)
    assert options.version or options.handler


@pytest.fixture
def files(tmp_path):
    """The files that pages tell to write."""
    (tmp_path / "my-rod.toml").write_text(marked("scene", OWN_SCENE))
    (tmp_path / "tests.csv").write_text(marked("file: tests.csv", CAMERA) + "\n")


@pytest.mark.long
@pytest.mark.parametrize("line", QUICK)
def test_quick_command_lines_do_what_they_say(line, cli, files):
    assert line in OWN
    code, out, _ = cli(*shlex.split(line)[1:])
    assert (code, bool(out)) == (0, True)


NUMBER = r"-?\d+\.?\d*(?:e[+-]\d+)?"
OUTPUTS = [block for block in blocks("text") if block.marker.startswith("output: ")]


@pytest.mark.parametrize(
    "block",
    [pytest.param(b, marks=pytest.mark.long) if b.page == "README.md" else b for b in OUTPUTS],
    ids=str,
)
def test_every_output_shown_is_that_of_its_command(block, cli, files):
    """Words to the letter, numbers within what processors differ by."""
    _, out, err = cli(*shlex.split(block.marker.removeprefix("output: "))[1:])
    found = (out + err).rstrip()
    squeezed = [re.sub(r" +", " ", re.sub(NUMBER, "#", text)) for text in (found, block.text)]
    assert squeezed[0] == squeezed[1]
    for a, b in zip(re.findall(NUMBER, found), re.findall(NUMBER, block.text), strict=True):
        assert float(a) == pytest.approx(float(b), rel=0.02, abs=2e-3)


def test_the_example_of_own_tests_is_compared(cli, tmp_path):
    """The page of own tests: its files, and its command lines but those that take minutes."""
    page = "docs/how-to/own-tests.md"
    for name in ("my_tests.csv", "my_means.csv", "my-tested-rod.toml"):
        (tmp_path / name).write_text(marked(f"file: {name}", page) + "\n")
    for name in ("sphere.csv", "sphere.toml"):
        (tmp_path / name).write_text(marked(f"file: {name}", page) + "\n")
    code, out, _ = cli(
        "validate",
        "sphere.toml",
        "--fidelity",
        "rigid",
        "--samples",
        "2",
        "--uncertain",
        "surface.friction=0.08,0.1",
    )
    assert (code, out.startswith("Measure better: surface.friction")) == (0, True)
    scene = (tmp_path / "my-tested-rod.toml").read_text()
    (tmp_path / "single.toml").write_text(scene.replace("my_means.csv", "my_tests.csv"))
    lines = [line.split()[1:] for line in marked_lines(page)]
    run, report = (next(line for line in lines if line[0] == name) for name in ("run", "report"))
    code, out, _ = cli(*run)
    assert (code, "beside 8 measured tests" in out) == (0, True)
    assert cli(*report)[0] == 0
    assert "beside 3 measured tests" in cli("run", "single.toml", "--fidelity", "modal")[1]


def marked_lines(page):
    """Return the command lines of a page."""
    return [line for block in blocks("sh") if block.page == page for line in block.text.splitlines()]


def test_outputs_are_shown():
    assert {block.page for block in OUTPUTS} >= {"README.md", OWN_SCENE}


PROSE = "".join(map(without_code, PAGES.values()))


@pytest.mark.parametrize("words", sorted(set(re.findall(r"`fem-impact ([a-z]\w* [^`]*-[^`]*)`", PROSE))))
def test_options_named_in_the_text_exist(words):
    command, *rest = words.split()
    command = f"{command} {rest[0]}" if f"{command} {rest[0]}" in COMMAND_PARSERS else command
    named = {word.strip("[]") for word in rest if word.startswith(("--", "[--"))}
    assert named <= {name for action in COMMAND_PARSERS[command]._actions for name in action.option_strings}


def test_every_file_named_is_there():
    named = set(re.findall(r"`(?:python )?((?:fem_impact|tests|rigid|meshes|docs)/[\w./-]+\.\w+)`", PROSE))
    missing = [one for one in named if not (ROOT / one).exists() and not one.startswith("docs/_build/")]
    assert len(named) > 20 and not missing


def _anchors(path):
    titles = re.findall(r"^#+ (.*)$", without_code(path.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


DOCS = ROOT / "docs"
MADE = {DOCS / "tutorials" / "notebook": DOCS / "notebooks", DOCS / "gallery": DOCS / "plots"}
LINKS = {
    page: [one for one in set(re.findall(r"\]\(([^)\s]+)\)", without_code(text))) if "://" not in one]
    for page, text in PAGES.items()
}


@pytest.mark.parametrize("page", [page for page, targets in LINKS.items() if targets])
def test_every_link_leads_somewhere(page):
    for target in LINKS[page]:
        place, _, anchor = target.partition("#")
        path = ((ROOT / page).parent / place).resolve() if place else ROOT / page
        if source := MADE.get(path.parent):  # made from a script with the pages
            path = source / ("GALLERY_HEADER.rst" if path.stem == "index" else f"{path.stem}.py")
        elif source := MADE.get(path.parent.parent):
            path = source / f"{path.stem.removeprefix('sphx_glr_').partition('_001')[0]}.py"
        assert path.exists(), target
        cited = set() if place else {one.key for one in references()}
        assert not anchor or anchor in _anchors(path) | cited, target


def test_the_words_that_the_trouble_table_quotes_are_the_programs():
    table = PAGES["docs/how-to/troubleshoot.md"].partition("| what you see |")[2].partition("\n\n")[0]
    quoted = [words for row in table.splitlines()[2:] for words in re.findall("`([^`]+)`", row.split("|")[1])]
    ours = [
        words for words in quoted if "=" not in words and not words.startswith(("fem-impact:", "ensurepip"))
    ]
    sources = "".join(path.read_text() for path in (ROOT / "fem_impact").rglob("*.py"))
    assert len(ours) > 6
    assert [words for words in ours if words not in sources] == []


def test_the_table_of_friction_is_the_data():
    text = PAGES["docs/explanation/friction-and-heat.md"]
    for state, surface in surfaces().items():
        (row,) = re.findall(rf"^\| {state} \| ([^|]*) \| ([^|]*) \|", text, re.MULTILINE)
        f, (low, high) = float(row[0]), map(float, row[1].split("-"))
        assert (f, low, high) == (surface.friction, surface.friction_low, surface.friction_high)


def test_every_key_at_the_top_of_a_scene_is_on_its_page():
    from fem_impact.scene.read import PARTS, TOP

    tables = {"projectile", "barrier", "surface", "impact", "save", "heating"}
    text = PAGES["docs/reference/scene.md"].partition("## Numbers")[0]
    assert set(re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE)) == set((*TOP, *PARTS)) - tables
