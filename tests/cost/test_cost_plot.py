"""The plot of error against time as a reader sees it."""

import pytest

from fem_impact.cost.document import cost_picture
from fem_impact.cost.judge import Judged
from fem_impact.figures import still, style


def setting(kind, cpu_s, error):
    return Judged(
        name=kind,
        kind=kind,
        fidelity=kind,
        meshes=[],
        tip_size_m=None,
        value={},
        error=dict.fromkeys(("e", "mu", "E_vib"), error),
        scatter={},
        band={},
        wall_s=cpu_s,
        cpu_s=cpu_s,
        two_cores_s=cpu_s,
        element_steps=None,
        peak_memory_MB=None,
    )


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Return the plot of a rigid run and a mesh whose errors, of 1, lie so far apart."""
    kept = []
    monkeypatch.setattr(style, "save", lambda figure, path: kept.append(figure))

    def draw(rigid, mesh, names=("e",)):
        settings = [setting("rigid", 1e-4, rigid), setting("mesh", 30.0, mesh)]
        still.draw(cost_picture(settings, names), tmp_path / "x.svg")
        kept[0].draw_without_rendering()
        return [axes for axes in kept[0].axes if axes.get_visible()]

    return draw


def shown(axis):
    """Return the words at the ticks that lie within the axis."""
    low, high = axis.get_view_interval()
    both = zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True)
    return [label.get_text() for at, label in both if low <= at <= high]


@pytest.mark.parametrize("errors", [(0.275, 0.115), (0.27, 0.085), (2.1, 0.8), (0.5, 0.004), (0.9, 0.00002)])
def test_ticks_are_at_least_two_plain_numbers(drawn, errors):
    (axes,) = drawn(*errors)
    words = shown(axes.yaxis)
    assert len(words) > 1
    assert [f"{float(word):g}" for word in words] == words
    assert not any(label.get_text() for label in axes.yaxis.get_minorticklabels())
    assert {"0.001", "10"} <= set(shown(axes.xaxis))


def test_every_panel_has_its_times_and_no_panel_is_empty(drawn):
    panels = drawn(0.2, 0.1, ("e", "mu", "E_vib"))
    assert [axes.get_title(loc="left") for axes in panels] == ["e", "µ", r"$E_{\mathrm{vib}}$"]
    assert all(axes.xaxis.get_tick_params()["labelbottom"] for axes in panels)
