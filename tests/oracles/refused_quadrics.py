"""Quadrics that are no solids: tree, path, kind, and what is told of them."""

QUADRICS = {
    "a cylinder without ends": (
        {"type": "quadric", "coefficients": [1, 1, 0, 0, 0, 0, 0, 0, 0, -100], "material": "m"},
        "/solid",
        "unbounded",
        r"for ever along \[0, 0, -?1\]|for ever along \[-?0, -?0, -?1\]",
    ),
    "a cylinder with one end": (
        {
            "type": "quadric",
            "coefficients": [1, 1, 0, 0, 0, 0, 0, 0, 0, -100],
            "cuts": [{"point": [0, 0, 5], "normal": [0, 0, 1]}],
            "material": "m",
        },
        "/solid",
        "unbounded",
        r"\[-?0, -?0, -1\]",
    ),
    "an oblique cylinder with one end": (
        {
            "type": "quadric",
            # |x|^2 - (k.x)^2 <= 100 with k = (1, 2, 3) / sqrt(14), and rounding in it.
            "coefficients": [
                13 / 14,
                10 / 14,
                5 / 14,
                -4 / 14,
                -12 / 14,
                -6 / 14,
                0.1,
                0.4,
                -0.3,
                -100,
            ],
            "cuts": [{"point": [0, 0, 5], "normal": [1, 2, 3]}],
            "material": "m",
        },
        "/solid",
        "unbounded",
        r"for ever along",
    ),
    "a paraboloid": (
        {"type": "quadric", "coefficients": [1, 1, 0, 0, 0, 0, 0, 0, -9, 0], "material": "m"},
        "/solid",
        "unbounded",
        r"\[-?0, -?0, 1\]",
    ),
    "a half space": (
        {"type": "quadric", "coefficients": [0, 0, 0, 0, 0, 0, 1, 0, 0, 0], "material": "m"},
        "/solid",
        "unbounded",
        r"for ever",
    ),
    "a hyperboloid cut along itself": (
        {
            "type": "quadric",
            "coefficients": [1, 1, -1, 0, 0, 0, 0, 0, 0, -100],
            "cuts": [{"point": [5, 0, 0], "normal": [1, 0, 0]}],
            "material": "m",
        },
        "/solid",
        "unbounded",
        r"for ever",
    ),
    "a double cone cut on one side": (
        {
            "type": "double_cone",
            "apex": [0, 0, 0],
            "axis": [0, 0, 1],
            "slope": 0.5,
            "cuts": [{"point": [0, 0, 9], "normal": [0, 0, 1]}],
            "material": "m",
        },
        "/solid",
        "unbounded",
        r"for ever along",
    ),
    "the outside of a sphere": (
        {"type": "quadric", "coefficients": [-1, -1, -1, 0, 0, 0, 0, 0, 0, 100], "material": "m"},
        "/solid",
        "unbounded",
        r"for ever along",
    ),
    "an ellipsoid of nothing": (
        {"type": "quadric", "coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, 100], "material": "m"},
        "/solid",
        "empty",
        r"nothing is left",
    ),
    "a sphere cut away": (
        {
            "type": "sphere",
            "center": [0, 0, 0],
            "radius": 10,
            "cuts": [{"point": [0, 0, -10.5], "normal": [0, 0, 1]}],
            "material": "m",
        },
        "/solid",
        "empty",
        r"nothing is left",
    ),
    "a sphere between cuts that leave nothing": (
        {
            "type": "sphere",
            "center": [0, 0, 0],
            "radius": 10,
            "cuts": [
                {"point": [0, 0, 1], "normal": [0, 0, -1]},
                {"point": [0, 0, -1], "normal": [0, 0.1, 1]},
                {"point": [0, 5, 0], "normal": [0, -1, 0]},
            ],
            "material": "m",
        },
        "/solid",
        "empty",
        r"nothing is left",
    ),
}
