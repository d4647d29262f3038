"""A light free barrier that turns: mass, kg, inertia, kg m2, place of its mass centre, m."""

M, J, DEPTH, OFFSET = 0.5, 3e-4, 0.03, 0.02
TURNING = {
    "barrier.mass": "0.5 kg",
    "barrier.inertia": "3e-4 kg m2",
    "barrier.centre_depth": "30 mm",
    "barrier.centre_offset": "20 mm",
}
