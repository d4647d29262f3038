"""Where a mesh puts the mass of a body elsewhere than the body has it."""

from fem_impact.fem.body import MeshedBodies

UNEVEN = 1e-3  # of its length: by how much the mass centre of a mesh may lie beside that of the body


def uneven(meshed: MeshedBodies) -> str:
    """Say that the rod's mesh has its mass centre beside that of the body; empty if it has not.

    A mesh of the body's own has its mass where it is, and a rigid rest that of the body.
    """
    bodies = meshed.case.bodies
    if bodies.scene.projectile.own_mesh is not None or meshed.rest_mass:
        return ""
    rod = meshed.true_rod
    z = float((rod.mass * rod.mesh.points[rod.mesh.cells, 2]).sum() / rod.mass.sum())
    off = z - bodies.body.z_c
    if abs(off) < UNEVEN * bodies.rod.length:
        return ""
    side = "behind" if off > 0 else "before"
    why = (
        "follow a collar, groove or step of the outline or bore, and the mass that they miss is put at the "
        "tip. Make it longer, take more cells (accuracy.across), or give the body as a mesh "
        "(projectile.mesh)."
    )
    if bodies.scene.projectile.is_ball:
        why = "follow the sphere so well behind its tip as there. Give more of them (accuracy.across = 16)."
    return (
        f"the mass centre of the mesh lies {1e3 * abs(off):.2g} mm {side} that of the body: its cells do not "
        + why
    )
