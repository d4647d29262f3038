"""The look of the pictures of the gallery."""

from cycler import cycler
from matplotlib import rcParams

from fem_impact.figures.still import COLOURS, PALETTE


def colour_blind_safe(_conf, _script):
    """Draw with the colours of the program's own figures; sphinx-gallery calls it before each script."""
    rcParams["axes.prop_cycle"] = cycler(color=[PALETTE[name] for name in COLOURS])
