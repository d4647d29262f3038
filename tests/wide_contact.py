"""A soft rod with a wide contact: twice its own cells leave the tip without a fine zone."""

from fem_impact.scene.shipped import load, replace_all

CHANGES = {
    "projectile.tip_radius": "9.5 mm",
    "projectile.material": "copper",
    "impact.v_n": "-8 m/s",
    "impact.v_t": "-6 m/s",
}
WIDE = replace_all(load("t5b"), {"measured": None, **CHANGES})
