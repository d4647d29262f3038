"""Meridians, zones and measures that the mesh tests share."""

import numpy as np

import meshes

RADIUS = 9.5e-3


def edge_radius(radius=RADIUS, rounding=3e-3, count=400):
    turn = np.linspace(0.0, np.pi / 2.0, count)
    arc = np.stack([radius - rounding + rounding * np.sin(turn), rounding - rounding * np.cos(turn)], axis=1)
    return arc if rounding >= radius else np.concatenate([[[0.0, 0.0]], arc])


def plain(radius=RADIUS):
    return np.array([[0.0, 0.0], [radius, 0.0]])


def sphere_and_cone(radius=RADIUS, ball=7e-3, degrees=60.0, count=400):
    turn = np.linspace(0.0, np.deg2rad(degrees), count)
    arc = np.stack([ball * np.sin(turn), ball - ball * np.cos(turn)], axis=1)
    height = arc[-1, 1] + (radius - arc[-1, 0]) * np.tan(np.deg2rad(degrees))
    return np.concatenate([arc, [[radius, height]]])


SHAPES = {"edge radius": edge_radius(), "plain": plain(), "sphere and cone": sphere_and_cone()}


def contact_zone(meridian, alpha=np.pi / 4.0, half=1.8e-3):
    """Cube about the point that first meets a plane at the angle alpha, in the rod frame."""
    n = np.array([-np.sin(alpha), 0.0, np.cos(alpha)])
    t = np.array([np.cos(alpha), 0.0, np.sin(alpha)])
    surface = np.stack([meridian[:, 0], 0.0 * meridian[:, 0], meridian[:, 1]], axis=1)
    place = surface[np.argmin(surface @ n)]
    return meshes.Zone(place, np.array([t, [0.0, 1.0, 0.0], n]), np.full(3, -half), np.full(3, half))


def frustums(meridian, length):
    """Volume of the whole solid of revolution, m3."""
    line = np.concatenate([meridian, [[meridian[-1, 0], length]]])
    a, b = line[:-1, 0], line[1:, 0]
    return float((np.pi / 3.0 * np.diff(line[:, 1]) * (a * a + a * b + b * b)).sum())


def area_vectors(mesh):
    corners = mesh.points[mesh.faces]
    return 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])


def flux_volume(mesh):
    """Volume by the divergence theorem over the outer faces alone."""
    root = 1.0 / np.sqrt(3.0)
    total = 0.0
    x = mesh.points[mesh.faces]
    for p, q in [(s * root, t * root) for s in (-1, 1) for t in (-1, 1)]:
        shape = 0.25 * np.array([(1 - p) * (1 - q), (1 + p) * (1 - q), (1 + p) * (1 + q), (1 - p) * (1 + q)])
        along = 0.25 * np.array([-(1 - q), 1 - q, 1 + q, -(1 + q)])
        across = 0.25 * np.array([-(1 - p), -(1 + p), 1 + p, 1 - p])
        normal = np.cross(np.einsum("a,kai->ki", along, x), np.einsum("a,kai->ki", across, x))
        total += np.einsum("ki,ki->", np.einsum("a,kai->ki", shape, x), normal) / 3.0
    return float(total)


def interior(mesh):
    """Nodes on no outer face."""
    mask = np.ones(len(mesh.points), bool)
    mask[mesh.faces] = False
    return mask
