"""Four numbers at once are four numbers, and a product with them has the bits of one in plain loops."""

import numpy as np
import pytest
import scipy.sparse as sp

from fem_impact.fem.kernels import kernel
from fem_impact.fem.sparse import NodeProduct
from fem_impact.fem.vectors import add_product, load, spread, store, sum_of_three


@kernel
def _blend(values, place, share, out):
    store(out, place, add_product(load(values, place), spread(share), load(values, place + 1)))
    return sum_of_three(load(out, place))


@pytest.mark.parametrize("place", range(4))
@pytest.mark.parametrize("shape", [(8,), (2, 4)])
def test_fours_begin_anywhere_and_leave_the_rest_alone(place, shape):
    values, out = np.random.default_rng(1).normal(size=8), np.full(shape, -7.0)
    total = _blend(values.reshape(shape), place, 0.5, out)
    expected = np.full(8, -7.0)
    expected[place : place + 4] = values[place : place + 4] + 0.5 * values[place + 1 : place + 5]
    assert out.ravel() == pytest.approx(expected, rel=1e-15)
    assert total == pytest.approx(expected[place : place + 3].sum(), rel=1e-14)


def test_a_bad_number_stays_in_its_lane():
    values, out = np.array([1.0, 2.0, 3.0, 4.0, np.nan]), np.zeros(4)
    assert _blend(values, 0, 1.0, out) == 3.0 + 5.0 + 7.0
    assert np.isnan(out[3])


@kernel
def multiply_plainly(start, columns, kinds, blocks, d, f):
    """`fem_impact.fem.sparse.multiply_nodes` from the node values ``d`` on, without vectors."""
    f[:] = 0.0
    for i in range(len(d)):
        t, b, n = d[i, 0], d[i, 1], d[i, 2]
        tt, tb, tn, bt, bb, bn, nt, nb, nn = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for entry in range(start[i], start[i + 1]):
            j, K = columns[entry], blocks[kinds[entry]]
            x, y, z = d[j, 0], d[j, 1], d[j, 2]
            tt, tb, tn = tt + K[0] * x, tb + K[1] * y, tn + K[2] * z
            bt, bb, bn = bt + K[3] * x, bb + K[4] * y, bn + K[5] * z
            nt, nb, nn = nt + K[6] * x, nb + K[7] * y, nn + K[8] * z
            if j != i:
                f[j, 0] = f[j, 0] + K[0] * t + K[3] * b + K[6] * n
                f[j, 1] = f[j, 1] + K[1] * t + K[4] * b + K[7] * n
                f[j, 2] = f[j, 2] + K[2] * t + K[5] * b + K[8] * n
        f[i, 0] += tt + tb + tn
        f[i, 1] += bt + bb + bn
        f[i, 2] += nt + nb + nn


def test_a_product_of_nodes_has_the_bits_of_plain_loops():
    random, nodes = np.random.default_rng(2), 40
    some = sp.random(3 * nodes, 3 * nodes, 0.2, random_state=3).tocsr()
    stiffness = sp.csr_matrix(some + some.T + 3 * sp.identity(3 * nodes))
    product = NodeProduct.of(stiffness, np.arange(3 * nodes).reshape(-1, 3))
    x = random.normal(size=3 * nodes)
    product.multiply(x)
    plain = np.zeros_like(product.product)
    multiply_plainly(product.start, product.columns, product.kinds, product.blocks, product.moved, plain)
    assert (plain[:, :3] == product.product[:, :3]).all()
    assert plain[:, :3].ravel() == pytest.approx(stiffness @ x, rel=1e-12)
