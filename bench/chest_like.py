"""A chest of about 300 leaves: what a scene of many small solids costs.

Twelve pairs of ribs, each cut into pieces of bone with marrow, a spine of vertebrae with processes
and discs, clavicles, a sternum, lungs with vessels and a heart. Sizes are about those of a man; the
scene is there to be traced, not to be looked at. z points to the head, y to the back and x to the
left.
"""

import math

MATERIALS = {
    "soft": 0.0205,
    "lung": 0.0055,
    "blood": 0.0215,
    "cortical": 0.058,
    "marrow": 0.028,
    "disc": 0.022,
}
RIB_PIECES = 4
VERTEBRAE = 14


def ellipsoid(name, material, center, semi_axes):
    return {
        "type": "ellipsoid",
        "name": name,
        "material": material,
        "center": list(center),
        "semi_axes": list(semi_axes),
    }


def tube(name, material, points, semi_axes):
    return {
        "type": "generalized_cylinder",
        "name": name,
        "material": material,
        "axis": {"type": "spline", "points": [list(map(float, p)) for p in points]},
        "contour": {"type": "ellipse", "semi_axes": list(semi_axes)},
        "frame": {"up": [0, 0, 1]},
    }


def rib_point(pair, side, angle):
    """Round an ellipse from the spine (0) toward the sternum (pi), falling on the way."""
    width = 135 - 0.9 * (pair - 7.5) ** 2
    depth = 92 - 0.45 * (pair - 7) ** 2
    x = side * (18 + (width - 18) * math.sin(angle) ** 0.8)
    y = 20 + depth * math.cos(angle) * 0.85
    z = 150 - 24 * pair - 0.32 * depth * (1 - math.cos(angle))
    return x, y, z


def ribs():
    """Twelve pairs in pieces, cortical bone and the marrow within it."""
    solids = []
    for pair in range(1, 13):
        reach = 2.5 if pair <= 10 else 1.5
        for side, word in ((1, "left"), (-1, "right")):
            cuts = [0.25 + (reach - 0.25) * k / RIB_PIECES for k in range(RIB_PIECES + 1)]
            for k in range(RIB_PIECES):
                low, high = cuts[k], cuts[k + 1] - 0.012
                points = [rib_point(pair, side, low + (high - low) * j / 4) for j in range(5)]
                name = f"rib-{pair}-{word}-{k}"
                solids.append(tube(name, "cortical", points, (3.2, 6.0)))
                solids.append(tube(f"{name}-marrow", "marrow", points, (2.2, 4.8)))
    return solids


def spine():
    """Bodies of cortical bone and marrow, discs between them, and a process behind."""
    solids = []
    for k in range(VERTEBRAE):
        z = 165 - 27 * k
        start, end = [0, 75, z - 11], [0, 75, z + 11]
        body = {"type": "cylinder", "start": start, "end": end, "up": [1, 0, 0]}
        solids.append({**body, "semi_axes": [18, 14], "name": f"body-{k}", "material": "cortical"})
        inner = {"start": [0, 75, z - 9.5], "end": [0, 75, z + 9.5], "semi_axes": [16.5, 12.5]}
        solids.append({**body, **inner, "name": f"spongy-{k}", "material": "marrow"})
        disc = {"start": [0, 75, z - 16], "end": [0, 75, z - 11], "semi_axes": [18, 14]}
        solids.append({**body, **disc, "name": f"disc-{k}", "material": "disc"})
        points = [(0, 92, z), (0, 104, z - 5), (0, 118, z - 15)]
        solids.append(tube(f"process-{k}", "cortical", points, (3.5, 7.0)))
    return solids


def vessels(side, word):
    """A trunk and branches, which run outward through a lung."""
    solids = []
    for k in range(18):
        fall = math.radians(-60 + 7.5 * k)
        out, up = math.cos(fall), -math.sin(fall)
        points = [
            (side * (28 + 55 * s * out), 8 + 10 * s * math.sin(k), -40 + 95 * s * up)
            for s in (0.0, 0.35, 0.7, 1.0)
        ]
        solids.append(tube(f"vessel-{word}-{k}", "blood", points, (2.8, 2.8)))
    return solids


def soft_parts():
    solids = [ellipsoid("trunk", "soft", (0, 15, -20), (175, 118, 330))]
    for side, word in ((1, "left"), (-1, "right")):
        solids.append(ellipsoid(f"lung-{word}", "lung", (side * 68, 15, -15), (52, 75, 135)))
        solids += vessels(side, word)
    solids.append(ellipsoid("heart", "blood", (22, -25, -65), (52, 42, 58)))
    solids.append(ellipsoid("aorta", "blood", (8, 45, -50), (11, 11, 130)))
    solids.append(ellipsoid("liver", "soft", (-55, 0, -185), (95, 80, 55)))
    return solids


def front():
    """Sternum and clavicles."""
    solids = []
    for k in range(5):
        solids.append(
            ellipsoid(f"sternum-{k}", "marrow", (0, -85 - 4 * k, 95 - 32 * k), (16, 6, 17))
        )
    for side, word in ((1, "left"), (-1, "right")):
        points = [(side * 18, -70, 140), (side * 70, -62, 150), (side * 135, -20, 158)]
        solids.append(tube(f"clavicle-{word}", "cortical", points, (6.0, 6.0)))
        solids.append(tube(f"clavicle-{word}-marrow", "marrow", points, (4.3, 4.3)))
    return solids


def document():
    """Return the chest; what comes later in its list replaces what it meets."""
    return {
        "format": "phantom/1",
        "name": "chest-like",
        "title": "Chest-like bench scene",
        "materials": {name: {"attenuation_per_mm": mu} for name, mu in MATERIALS.items()},
        "solid": {"type": "replace", "solids": [*soft_parts(), *spine(), *ribs(), *front()]},
    }
