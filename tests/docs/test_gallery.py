"""The gallery shows what its commands make, and figures 3 and 4 show what the paper says."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import numpy as np
import pytest

from phantom.geometry.star import pseudo_angle

ROOT = Path(__file__).parents[2]
GALLERY = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")


def test_every_picture_has_its_command():
    commands = re.findall(r"^uv run (.*)$", GALLERY, re.M)
    making = runpy.run_path(str(ROOT / "docs" / "make_figures.py"))
    assert list(making["GALLERY"]) == commands
    for picture in re.findall(r"!\[.*?\]\((\S+?)\)", GALLERY):
        assert (ROOT / "docs" / picture).is_file()


def test_the_sheet_shows_every_shape():
    shapes = runpy.run_path(str(ROOT / "docs" / "reference_shapes.py"))
    for name in shapes["SHAPES"]:
        grey = shapes["tile"](name)
        assert grey.shape == (shapes["TILE"], shapes["TILE"])
        assert grey.min() == 0
        assert 0.1 < (grey > 0).mean() < 0.95, name


@pytest.fixture(scope="module")
def scene():
    return runpy.run_path(str(ROOT / "docs" / "paper_figures.py"))["scene"]()


def test_the_engine_crosses_where_rho_meets_the_contour_of_its_u(scene):
    ray, crossings = scene
    rho = ray.rho(crossings)
    assert len(crossings) == 4
    reach = ray.sweep.radii(pseudo_angle(rho), crossings)
    assert np.allclose(np.linalg.norm(rho, axis=1), reach, rtol=0, atol=1e-6)


def test_phi_is_by_turns_within_and_beyond_the_first_contour(scene):
    """It is on it where the engine crosses, and between two crossings where the ray is."""
    ray, crossings = scene
    between = 0.5 * (crossings[:-1] + crossings[1:])
    for u, expected in ((crossings, [0, 0, 0, 0]), (between, [-1, 1, -1])):
        phi = ray.phi(u)
        first = np.full(len(u), ray.sweep.span[0])
        beyond = np.linalg.norm(phi, axis=1) - ray.sweep.radii(pseudo_angle(phi), first)
        assert np.sign(np.where(np.abs(beyond) < 1e-5, 0.0, beyond)).tolist() == expected


def test_the_net_of_figure_8_covers_the_solid_beside_it():
    """Both are seen by one camera: no line lies off the solid, and its outline is drawn."""
    drawing = runpy.run_path(str(ROOT / "docs" / "paper_pictures.py"))
    drawing["drawn"].__globals__["SIDE"] = 160
    net, solid = (levels.min(axis=2) for levels in drawing["figure_8"]())
    assert net.shape == solid.shape == (160, 160)
    line, body = net < 200, solid < 250
    near = np.any(
        [np.roll(body, shift, axis=(0, 1)) for shift in ((0, 0), (0, 1), (1, 0), (0, -1), (-1, 0))],
        axis=0,
    )
    assert line.sum() > 1000
    assert not np.any(line & ~near)
    for rows in np.flatnonzero(body.any(axis=1))[5:-5:10]:
        ends, drawn = np.flatnonzero(body[rows]), np.flatnonzero(line[rows])
        assert abs(drawn[0] - ends[0]) <= 2
        assert abs(drawn[-1] - ends[-1]) <= 2
