"""Solids as closed meshes of triangles, within a tolerance of the surface; and as (u, v) nets."""

from phantom.tessellation.leaves import check_tolerance, placed_nets, tessellate
from phantom.tessellation.mesh import Mesh, joined

__all__ = ["Mesh", "check_tolerance", "joined", "placed_nets", "tessellate"]
