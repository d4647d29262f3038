"""Ways to spoil a file, as hypothesis strategies, and what the command must answer."""

import contextlib
import io
import json
from collections import Counter

from hypothesis import strategies as st

from fem_impact.cli.main import main

INF = float("inf")
TRIED = Counter()

HOSTILE_TEXT = st.sampled_from(
    [
        *(
            "../../etc/passwd",
            "/etc/passwd",
            "/tmp/x",
            "..",
            ".",
            "",
            " ",
            "a/b",
            "a\\b",
            "C:\\x",
            "~",
            "-rf",
        ),
        *("nan", "inf", "-inf", "1e999", "240", "240 m", "240 kg", "24O mm", "2,1 m/s", "45 °", "1e400 mm"),
        *(
            "\x00",
            "a\nb",
            "é" * 400,
            "x" * 10_000,
            "__import__('os').system('true')",
            "${HOME}",
            "%s%n",
            "NaN m",
        ),
        *("!!python/object/apply:os.system ['true']", "auto", "-friction", "con", "1 m/s", "-1e-320 m/s"),
    ]
)
NUMBERS = st.sampled_from(
    [0, -1, 1, 2**63, -(2**63), 10**400, 1e308, -1e308, 5e-324, float("nan"), INF, -INF]
)
SCALARS = st.one_of(
    st.none(), st.booleans(), NUMBERS, HOSTILE_TEXT, st.floats(), st.integers(), st.text(max_size=9)
)
NAMES = HOSTILE_TEXT | st.text(max_size=5)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(NAMES, inner, max_size=3),
    max_leaves=6,
)


class Spoiled(bytes):
    """Bytes whose picture stays short."""

    def __repr__(self):
        return f"Spoiled({len(self)} bytes, {bytes(self[:40])!r}...)"


@st.composite
def spoiled_bytes(draw, whole):
    """Bytes of a file: cut off, with flipped bits, with pieces lost, doubled or overwritten, or made up."""
    kind = draw(st.sampled_from(["cut", "flip", "lose", "double", "garbage", "overwrite", "nothing like it"]))
    data = bytearray(whole)
    at = draw(st.integers(0, len(data) - 1))
    if kind == "cut":
        return Spoiled(data[:at])
    if kind == "flip":
        for place in draw(st.lists(st.integers(0, len(data) - 1), min_size=1, max_size=6)):
            data[place] ^= 1 << draw(st.integers(0, 7))
    length = draw(st.integers(1, 200))
    if kind == "lose":
        del data[at : at + length]
    if kind == "double":
        data[at:at] = data[at : at + length]
    if kind == "overwrite":
        data[at : at + length] = draw(st.binary(min_size=1, max_size=200))
    return Spoiled(data) if kind not in ("garbage", "nothing like it") else draw(st.binary(max_size=300))


@st.composite
def spoiled_tree(draw, tree):
    """A copy of nested tables with up to three places changed, added, removed or moved."""
    copy = json.loads(json.dumps(tree))
    for _ in range(draw(st.integers(1, 3))):
        table = copy
        while True:
            key = draw(st.sampled_from(sorted(table))) if table else "new"
            if not isinstance(table.get(key), dict) or draw(st.booleans()):
                break
            table = table[key]
        act = draw(st.sampled_from(["change", "change", "remove", "add"]))
        if act == "remove":
            table.pop(key, None)
        elif act == "add":
            table[draw(NAMES)] = draw(VALUES)
        else:
            table[key] = draw(VALUES)
    return copy


def call(*words):
    """Run the command in this process; return code, standard output and error."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = main([str(word) for word in words])
        except SystemExit as stop:
            code = stop.code
    return code, out.getvalue(), err.getvalue()


def check_answer(what, allowed, *words):
    """Check the answer to a spoiled input: done, or one clear refusal; return the exit code."""
    TRIED[what] += 1
    code, out, err = call(*words)
    assert code == 0 or code in allowed, (code, err)
    assert "Traceback" not in err
    if code:
        TRIED[f"{what}, refused"] += 1
        assert not out or ("--json" in words and json.loads(out)["error"]["exit_code"] == code)
        assert err.startswith(("fem-impact: error: ", "usage: "))
        assert len(err.strip()) > 25
    return code


def literal(value):
    """Return a value as TOML, also one that TOML cannot say (then the file is no TOML at all)."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {literal(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(literal, value)) + "]"
    return json.dumps(value) if isinstance(value, str) else repr(value).replace("None", "null")


def toml(tree):
    """Return nested tables as TOML with inline tables."""
    return "\n".join(f"{json.dumps(key)} = {literal(value)}" for key, value in tree.items()) + "\n"
