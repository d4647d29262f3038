"""All numbers of a material: meaning, dimension, bounds, default, source."""

from __future__ import annotations

from typing import Literal

from fem_impact.scene.parameter import Parameter

MATERIAL = (
    Parameter("E", "Young's modulus", "stress", 1e6, 1e13, unit="GPa"),
    Parameter("nu", "Poisson's ratio", "", 0.0, 0.5, high_open=True),
    Parameter("rho", "density", "density", 10.0, 3e4),
    Parameter(
        *("yield_stress", "yield stress in tension", "stress", 1e3, 1e11),
        derived="infinite: the body never yields",
    ),
    Parameter(
        *("ultimate_stress", "ultimate stress (engineering)", "stress", 1e3, 1e11),
        derived="none: the body never yields, or hardening, tangent_modulus, flow or hardness stands for it",
    ),
    Parameter(
        "hardening",
        "plastic modulus of linear hardening; 0: perfectly plastic",
        "stress",
        0.0,
        1e12,
        derived="none: a power law through the yield stress and the strength that the key law names",
    ),
    Parameter(
        "tangent_modulus",
        "slope of stress over the whole strain beyond yield, of bilinear hardening",
        "stress",
        0.0,
        1e12,
        derived="none: the plastic modulus, hardening, is stated, or another law",
    ),
    Parameter("hardness", "Vickers hardness number HV", "", 1.0, 1e4, derived="none"),
    Parameter(
        "loss_factor",
        "ratio of loss to storage modulus at the pace of the contact",
        "",
        0.0,
        1.5,
        derived="none: the contact loses nothing by viscosity",
    ),
    Parameter("conductivity", "conductivity of heat", "conductivity", 1e-3, 1e5, derived="unknown"),
    Parameter("heat_capacity", "heat capacity of a mass", "heat capacity", 1e-3, 1e5, derived="unknown"),
)
SKIN = (
    Parameter("factor", "flow stress at the surface over that of the bulk", "", 1.0, 5.0),
    Parameter(
        "depth",
        "depth of the layer; of an exponential one, where 1/e of the gain is left",
        "length",
        1e-6,
        1e-3,
        derived="the least at which a layer of that factor meets the hardness at the load",
    ),
    Parameter(
        "load",
        "load of the hardness test, kgf: 30 of HV 30",
        "",
        1.0,
        120.0,
        derived="none: the depth is stated",
    ),
)
SkinShape = Literal["even", "exponential"]  # of the gain of flow stress over the depth under the surface
FlowLaw = Literal["tensile", "hardness"]  # what the power law of hardening passes through beside yield
PLASTIC_STRAIN = Parameter("strain", "plastic strain of a point", "", 0.0, 100.0)
FLOW_STRESS = Parameter("stress", "true stress of a point", "stress", 1e3, 1e12)
_COLD = "none: temperature has no effect"
FLOWS: dict[str, tuple[Parameter, ...]] = {
    "johnson-cook": (
        Parameter(
            "B", "gain of flow stress at a plastic strain of 1; A is yield_stress", "stress", 0.0, 1e12
        ),
        Parameter("n", "exponent of the plastic strain", "", 0.01, 1.0),
        Parameter("m", "exponent of the rise of the temperature", "", 0.05, 10.0, derived=_COLD),
        Parameter("melting", "temperature of melting", "temperature", 200.0, 6000.0, derived=_COLD),
        Parameter(
            *("reference", "temperature of the cold curve, before impact", "temperature", 1.0, 2000.0),
            derived=_COLD,
        ),
        Parameter("heat_share", "part of the plastic work that becomes heat", "", 0.0, 1.0, derived=_COLD),
    ),
    "ramberg-osgood": (
        Parameter("n", "exponent of the stress; yield_stress is the .2 % proof stress", "", 1.0, 1000.0),
    ),
    "table": (),
}
_RATE = "strain rate", 1e-6, 1e6
RATES = {
    "johnson-cook": (
        Parameter("C", "factor of the logarithm of the strain rate", "", 0.0, 1.0),
        Parameter(
            *("reference", "strain rate of the curve that the law multiplies", *_RATE),
            default=1.0,
            source="Johnson and Cook divide by 1 per second",
        ),
        Parameter(
            *("tested", "strain rate of the tests that gave the strengths", *_RATE),
            default=2e-3,
            source="a standard tensile test: the lowest rate of the tests of A572-50 and A992 steel at "
            "cavs.msstate.edu, Intermediate strain-rate testing, beside ASTM E8 tests",
        ),
    ),
    "cowper-symonds": (
        Parameter("D", "strain rate at which the flow stress doubles", "strain rate", 1e-6, 1e12),
        Parameter("q", "exponent: the gain is the q-th root of the rate", "", 1.0, 100.0),
    ),
}
