"""Layers as one material under a contact: limits, and the exact give of a layered half-space."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest

from fem_impact.physics.layered import elastic, hardness
from fem_impact.scene.material import Material

STEEL = Material("steel", 210e9, 0.3, 7850.0)
SOFT = replace(STEEL, E=70e9)


def give(metal):
    return (1 - metal.nu**2) / metal.E


def exact(layer, base, depth):
    """Return (1 - nu^2) / E, 1/Pa, of a half-space that gives as much as a layer on a base under a punch.

    Under a pressure (1 - r^2)^(-1/2) over a disc of radius 1 it is the mean of the give at each wave number,
    which Burmister (1945, J. Appl. Phys. 16, 89) knows of a bonded layer.
    """
    k = np.linspace(1e-6, 400.0, 800_001)
    n, a, b = base.E / layer.E * (1 + layer.nu) / (1 + base.nu), 3 - 4 * layer.nu, 3 - 4 * base.nu
    K, L, kh = (1 - n) / (1 + n * a), (b - n * a) / (b + n), k * depth
    e = np.exp(-2 * kh)
    ratio = (1 + 4 * K * kh * e - L * K * e**2) / (1 - (K + L + 4 * K * kh**2) * e + L * K * e**2)
    return give(layer) * 2 / pi * np.trapezoid(ratio * (np.sin(k) / k) ** 2, k)


@pytest.mark.parametrize(("layer", "base"), [(STEEL, SOFT), (SOFT, STEEL)])
def test_the_stiffness_is_that_of_a_layered_half_space(layer, base):
    for depth in (0.3, 1.0, 3.0, 10.0):
        E, nu = elastic([(depth, layer), (inf, base)], 1.0)
        assert (1 - nu**2) / E == pytest.approx(exact(layer, base, depth), rel=0.05)


def test_layers_of_one_material_are_that_material():
    for depth in (1e-4, 1e-3, 1.0):
        assert elastic([(depth, SOFT), (2 * depth, SOFT), (inf, SOFT)], 1e-3) == pytest.approx((70e9, 0.3))
        assert hardness(depth, 1e-3, (5e8, 7e10), (5e8, 7e10)) == pytest.approx(5e8)


def test_where_one_never_flows_the_layer_counts_alone():
    assert hardness(1e-3, 1e-3, (5e8, 7e10), (inf, 4e11)) == 5e8
    assert hardness(1e-3, 1e-3, (inf, 4e11), (5e8, 7e10)) == inf
