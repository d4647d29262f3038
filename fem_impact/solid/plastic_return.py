"""Return of the trial stress to the flow stress, for one Gauss point of a block of elements.

Points that flow as most do go together, lane beside lane, in plain arithmetic that the compiler turns into
vectors; the few others go one by one.
"""

from math import sqrt

import numpy as np

from fem_impact.fem.hexmodes import LANES
from fem_impact.fem.kernels import by_type, inlined, kernel
from fem_impact.physics.hardening import JohnsonCook, PowerLaw

SMALL = 0.01  # growth of the flow stress' base in one step up to which a few terms of its power are exact
# scratch rows: 1 for lanes that go together, trial stress, growth, unknown and its last change, increment,
# new over trial stress, stress before the increment along the trial stress
TOGETHER, SIZE, GROWTH, UNKNOWN, CHANGE, GAIN, SHARE, ALONG, RETURN_ROWS = 0, 1, 2, 3, 4, 5, 6, 7, 8
CLOSE = 1e-4  # change of the unknown after which one more term of its exponential is exact to 1e-12
LN2 = 0.6931471805599453
FEW, MOST = 8, 60  # steps of the iteration of lanes together, and of one


@inlined
def _series(d, n):  # type: ignore[no-untyped-def]
    """Return (1 + d)^n for abs(d) up to ``SMALL``."""
    tail = 1.0 + (n - 4.0) / 5.0 * d * (1.0 + (n - 5.0) / 6.0 * d)
    return 1.0 + n * d * (
        1.0 + (n - 1.0) / 2.0 * d * (1.0 + (n - 2.0) / 3.0 * d * (1.0 + (n - 3.0) / 4.0 * d * tail))
    )


@inlined
def _power(d, n):  # type: ignore[no-untyped-def]
    """Return (1 + d)^n; the plastic growth of one step is nearly always small."""
    return _series(d, n) if abs(d) <= SMALL else (1.0 + d) ** n


@inlined
def _exp(u):  # type: ignore[no-untyped-def]
    """Return e^u, to 1e-13 up to u = 60, in plain arithmetic: no call, so that lanes go together."""
    y = u / 256.0
    tail = 1.0 + y / 6.0 * (1.0 + y / 7.0 * (1.0 + y / 8.0 * (1.0 + y / 9.0 * (1.0 + y / 10.0))))
    z = 1.0 + y * (1.0 + y / 2.0 * (1.0 + y / 3.0 * (1.0 + y / 4.0 * (1.0 + y / 5.0 * tail))))
    z = z * z
    z = z * z
    z = z * z
    z = z * z
    z = z * z
    z = z * z
    z = z * z
    return z * z


@by_type("law", {PowerLaw: lambda law: law.exponent})
def _exponent(law):  # type: ignore[no-untyped-def]
    """Return n of sigma(strain + dp) = sigma(strain) (1 + growth dp)^n: 1 on a straight piece."""
    return 1.0


@inlined
def _stress_and_slope(strain, law):  # type: ignore[no-untyped-def]
    """Return stress and slope, Pa, of a curve of straight pieces, flat behind its last point."""
    low, high = 0, len(law.strain) - 1
    if strain >= law.strain[high]:
        return law.stress[high], 0.0
    while high - low > 1:
        middle = (low + high) // 2
        if law.strain[middle] <= strain:
            low = middle
        else:
            high = middle
    slope = (law.stress[high] - law.stress[low]) / (law.strain[high] - law.strain[low])
    return law.stress[low] + slope * (strain - law.strain[low]), slope


@by_type("law", {PowerLaw: lambda strain, law: law.slope / (1.0 + law.slope * strain)})
def _growth(strain, law):  # type: ignore[no-untyped-def]
    """Return the growth of `_exponent` at a plastic strain."""
    stress, slope = _stress_and_slope(strain, law)
    return slope / stress


@by_type("law", {PowerLaw: lambda new, flow, strain, dp, law: new})
def _on_curve(new, flow, strain, dp, law):  # type: ignore[no-untyped-def]
    """Return the flow stress after a step, which ``new`` is where no corner of the curve was passed."""
    return flow * _stress_and_slope(strain + dp, law)[0] / _stress_and_slope(strain, law)[0]


@inlined
def _plastic_increment(q, flow, strain, G3, law):  # type: ignore[no-untyped-def]
    """Solve q - 3 G dp = sigma(strain + dp) by Newton's method from the safe (left) side."""
    growth, n = _growth(strain, law), _exponent(law)
    dp = (q - flow) / (G3 + n * growth * flow)
    new = flow
    for _ in range(20):
        new = flow * _power(growth * dp, n)
        miss = q - G3 * dp - new
        if abs(miss) < 1e-12 * q:
            break
        dp += miss / (G3 + n * growth * new / (1.0 + growth * dp))
    return dp, new


@by_type("rate", {JohnsonCook: lambda u, rate: (1.0 + rate.C * u, rate.C, 0.0)})
def _factor(u, rate):  # type: ignore[no-untyped-def]
    """Return the rate factor at u = ln(rate over that of `_reference`), and its two derivatives by u."""
    part = _exp(u / rate.q)
    return 1.0 + part, part / rate.q, part / (rate.q * rate.q)


@by_type("rate", {JohnsonCook: lambda rate: rate.slowest})
def _reference(rate):  # type: ignore[no-untyped-def]
    """Return the rate, 1/s, at which u of `_factor` is 0."""
    return rate.D


@by_type("rate", {JohnsonCook: lambda rate: rate.slowest})
def _slowest(rate):  # type: ignore[no-untyped-def]
    """Return the rate, 1/s, up to which there is no rate factor."""
    return 0.0


@by_type("rate", {JohnsonCook: lambda excess, rate: excess / rate.C})
def _most(excess, rate):  # type: ignore[no-untyped-def]
    """Return u where the rate alone bears the ``excess`` over the flow stress, in units of it."""
    return rate.q * np.log(excess)


@inlined
def _correction(q, dp, new, factor, first, second, growth, G3, n):  # type: ignore[no-untyped-def]
    """Return Halley's change of u = ln(dp / (reference rate dt)) for q - 3 G dp = new * factor."""
    bent = (G3 + n * growth * new / (1.0 + growth * dp) * factor) * dp
    steep = bent + new * first
    change = (q - G3 * dp - new * factor) / steep
    return change / (1.0 + 0.5 * change * (bent + new * second) / steep)


@inlined
def _hardened_increment(q, flow, strain, G3, law, rate, dt):  # type: ignore[no-untyped-def]
    """Solve q - 3 G dp = sigma(strain + dp) factor(u), u = ln(dp / (reference rate dt)).

    Returns the increment, the stress and the flow stress at vanishing rate. Up to the slowest rate there is
    no rate factor. Halley's method in u, from the lower of two bounds: all of q - sigma borne by the rate
    factor, or all by 3 G dp.
    """
    slow, growth, least = _reference(rate) * dt, _growth(strain, law), _slowest(rate) * dt
    n = _exponent(law)
    over = q - flow * _power(growth * least, n)
    if over <= G3 * least:
        dp, new = _plastic_increment(q, flow, strain, G3, law)
        return dp, new, new
    u, dp = min(_most(over / flow, rate), np.log(over / (G3 * slow))), slow
    factor = 1.0
    for _ in range(MOST):
        dp, (factor, first, second) = slow * np.exp(u), _factor(u, rate)
        new = flow * _power(growth * dp, n)
        change = _correction(q, dp, new, factor, first, second, growth, G3, n)
        u += change
        if abs(change) <= CLOSE:
            dp *= 1.0 + change + 0.5 * change * change
            break
    return dp, q - G3 * dp, (q - G3 * dp) / _factor(u, rate)[0]


@inlined
def _log_of(bits):  # type: ignore[no-untyped-def]
    """Return the logarithm of a double from its bits, to .03: straight between powers of two."""
    return LN2 * (bits * 2.0**-52 - 1022.96)


@inlined
def _start(w, trial2, flow, strain, G3, law, rate, dt):  # type: ignore[no-untyped-def]
    """Mark the lanes solved together, set their start values and return their number.

    Start of u = ln(dp/(reference rate dt)): dp = over/(3 G), log from the double's bits (to .03); then one
    step of the method from there, in which no exponential is needed for Johnson and Cook's law.

    These are beyond their flow stress and faster than the slowest rate. The numbers of the others are
    harmless.
    """
    n, slow, least, count = _exponent(law), _reference(rate) * dt, _slowest(rate) * dt, 0
    for l in range(LANES):
        growth, q = _growth(strain[l], law), sqrt(trial2[l])
        over = q - flow[l] * _series(growth * least, n)
        together = over > G3 * least
        w[TOGETHER * LANES + l] = 1.0 if together else 0.0
        w[SIZE * LANES + l] = q if together else 1.5 * flow[l]
        w[GROWTH * LANES + l] = growth
        w[GAIN * LANES + l] = over / (G3 * slow) if together else 1.0
        w[SHARE * LANES + l] = over / flow[l] if together else 1.0
        count += together
    bits = w[GAIN * LANES : (GAIN + 1) * LANES].view(np.int64)
    shares = w[SHARE * LANES : (SHARE + 1) * LANES].view(np.int64)
    for l in range(LANES):
        over = w[SIZE * LANES + l] - flow[l]
        w[UNKNOWN * LANES + l] = _begin(_log_of(bits[l]), _log_of(shares[l]), over, flow[l], rate)
    return count


def _begin_on_a_line(u, ratio, over, flow, rate):  # type: ignore[no-untyped-def]
    dragged = rate.C * flow
    steep = over + dragged
    change = -dragged * u / steep
    u += change / (1.0 + 0.5 * change * over / steep)
    return max(0.0, min(u, over / dragged))


@by_type("rate", {JohnsonCook: _begin_on_a_line})
def _begin(u, ratio, over, flow, rate):  # type: ignore[no-untyped-def]
    """Return a start for the unknown, from ``u``, where 3 G dp would bear all; ``ratio`` is ln(over/flow)."""
    return min(u, ratio * rate.q)


@inlined
def _improve(w, flow, G3, law, rate, dt):  # type: ignore[no-untyped-def]
    """Make one step of `_hardened_increment` in all lanes; return how many have still to go on."""
    n, slow, count = _exponent(law), _reference(rate) * dt, 0
    for l in range(LANES):
        u, q, growth = w[UNKNOWN * LANES + l], w[SIZE * LANES + l], w[GROWTH * LANES + l]
        dp, (factor, first, second) = slow * _exp(u), _factor(u, rate)
        new = flow[l] * _series(growth * dp, n)
        change = _correction(q, dp, new, factor, first, second, growth, G3, n)
        w[UNKNOWN * LANES + l] = u + change
        w[GAIN * LANES + l] = dp * (1.0 + change + 0.5 * change * change)
        w[CHANGE * LANES + l] = abs(change)
        count += (w[TOGETHER * LANES + l] > 0.0) & (abs(change) > CLOSE)
    return count


@inlined
def _return_together(w, trial2, rotated, stress, weight, flow, strain, work, G3, law, rate, dt):  # type: ignore[no-untyped-def]
    """Return the lanes that go together; their trial stress falls to the flow stress."""
    if not _start(w, trial2, flow, strain, G3, law, rate, dt):
        return
    for _ in range(FEW):
        if not _improve(w, flow, G3, law, rate, dt):
            break
    # loops over few arrays each: the compiler checks every pair of them for overlap, or gives up
    for l in range(LANES):
        exact = (w[CHANGE * LANES + l] <= CLOSE) & (w[GROWTH * LANES + l] * w[GAIN * LANES + l] <= SMALL)
        together = (w[TOGETHER * LANES + l] > 0.0) & exact
        w[GAIN * LANES + l] = w[GAIN * LANES + l] if together else 0.0
        new = w[SIZE * LANES + l] - G3 * w[GAIN * LANES + l]
        slow = new / _factor(w[UNKNOWN * LANES + l], rate)[0]
        flow[l] = _on_curve(slow, flow[l], strain[l], w[GAIN * LANES + l], law) if together else flow[l]
        w[SHARE * LANES + l] = new / w[SIZE * LANES + l]
    for l in range(LANES):
        trial2[l] = 0.0 if w[GAIN * LANES + l] > 0.0 else trial2[l]
        strain[l] += w[GAIN * LANES + l]
    for l in range(LANES):
        along = rotated[l] * stress[l] + rotated[LANES + l] * stress[LANES + l]
        along += rotated[2 * LANES + l] * stress[2 * LANES + l]
        shear = rotated[3 * LANES + l] * stress[3 * LANES + l]
        shear += rotated[4 * LANES + l] * stress[4 * LANES + l]
        shear += rotated[5 * LANES + l] * stress[5 * LANES + l]
        w[ALONG * LANES + l] = (1.5 * along + 3.0 * shear) / w[SIZE * LANES + l]
    for l in range(LANES):
        new = w[SIZE * LANES + l] * w[SHARE * LANES + l]
        work[l] += 0.5 * (new + w[ALONG * LANES + l]) * w[GAIN * LANES + l] * weight[l]
    for i in range(6):
        for l in range(LANES):
            stress[i * LANES + l] *= w[SHARE * LANES + l]


@kernel
def return_map(w, trial2, rotated, stress, weight, flow, strain, work, G3, law, rate, dt):  # type: ignore[no-untyped-def]
    """Bring the lanes of one Gauss point beyond their flow stress back to it; add to the plastic ``work``, J.

    The work uses the mean of the old and new stress, as the energy balance of the step does. ``rate`` is
    `JohnsonCook` or `CowperSymonds`, for which the loop is compiled apart, or None for a material without
    rate hardening: the compiler then drops that branch. ``law`` is a `PowerLaw` or `Pieces`.
    """
    if rate is not None:
        _return_together(w, trial2, rotated, stress, weight, flow, strain, work, G3, law, rate, dt)
    for l in range(LANES):
        if trial2[l] > flow[l] * flow[l]:
            q = sqrt(trial2[l])
            if rate is None:
                dp, new = _plastic_increment(q, flow[l], strain[l], G3, law)
                slow = new
            else:
                dp, new, slow = _hardened_increment(q, flow[l], strain[l], G3, law, rate, dt)
            along = 0.0
            for i in range(6):
                double = 1.0 if i < 3 else 2.0
                along += double * rotated[i * LANES + l] * stress[i * LANES + l]
                stress[i * LANES + l] *= new / q
            work[l] += 0.5 * (new + 1.5 * along / q) * dp * weight[l]
            flow[l] = _on_curve(slow, flow[l], strain[l], dp, law)
            strain[l] += dp
