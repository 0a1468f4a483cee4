"""Trees of documents with one or more solids, tubes by default."""


def document(*solids, definitions=None):
    solid = solids[0] if len(solids) == 1 else {"type": "union", "solids": list(solids)}
    return {
        "format": "phantom/1",
        "name": "refused",
        "materials": {"m": {"attenuation_per_mm": 0.01}},
        "definitions": definitions or {},
        "solid": solid,
    }


def tube(**parts):
    leaf = {
        "type": "generalized_cylinder",
        "material": "m",
        "axis": {"type": "line", "start": [0, 0, -40], "end": [0, 0, 40]},
        "contour": {"type": "circle", "radius": 8},
    }
    return {**leaf, **parts}


def arc(radius=20.0, angle_deg=120.0, **parts):
    axis = {
        "type": "arc",
        "center": [0, 0, 0],
        "normal": [0, 0, 1],
        "start": [radius, 0, 0],
        "angle_deg": angle_deg,
    }
    return tube(axis=axis, **parts)


def spline(*points, **more):
    return {"type": "spline", "points": [list(map(float, p)) for p in points], **more}


def formula_axis(x, y, z, span, **more):
    return {"type": "formula", "x": x, "y": y, "z": z, "range": span, **more}


def formula_contour(x, y, span=(0, 6.283185307179586)):
    return {"type": "formula", "x": x, "y": y, "range": span}


def linear(**parts):
    return {"type": "linear", **parts}


RING = spline([40, 0, 0], [0, 40, 0], [-40, 0, 0], [0, -40, 0], closed=True)
