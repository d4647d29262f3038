"""
Cladding tube: a material of your own
=====================================

A piece of cladding, 9.5 mm wide with walls of 0.57 mm, tips over and strikes a steel floor. What share of its
energy does it keep as vibration, over its speed? The values of its alloy are those of a data sheet.
"""

import matplotlib.pyplot as plt

import fem_impact

alloy = {
    "name": "my-zirconium-alloy",
    "E": "99 GPa",
    "nu": 0.37,
    "rho": "6560 kg/m3",
    "yield_stress": "380 MPa",
    "ultimate_stress": "510 MPa",
    "source": "data sheet of the maker",
}
scene = fem_impact.load(
    {
        "id": "cladding",
        "projectile": {
            "length": "80 mm",
            "diameter": "9.5 mm",
            "inner_diameter": "8.36 mm",
            "tip": "B",
            "tip_radius": "0.2 mm",
            "material": alloy,
        },
        "barrier": {"material": "stainless-304"},
        "surface": {"state": "custom", "friction": 0.3, "source": "assumed"},
        "impact": {"angle": "30 deg", "v_n": "-1 m/s", "v_t": "0 m/s"},
    }
)
speeds = [0.25, 0.5, 1, 2]
runs = [fem_impact.simulate(fem_impact.replace(scene, "impact.v_n", f"{-v} m/s"), "modal") for v in speeds]
shares, errors = zip(*(run.estimate("E_vib_over_E_0") for run in runs), strict=True)
plt.errorbar(speeds, shares, errors, fmt="o", capsize=4)
plt.gca().set(xlabel="speed, m/s", ylabel="vibration, share of E_0", ylim=(0, None))
plt.gca().set(title="cladding, 9.5 x 80 mm, 30 degrees")
plt.show()
