"""Label volumes as NIfTI-1: the world is RAS, so the affine turns x and y round.

Voxels stay in the document's order, x fastest; the affine maps voxel (i, j, k) to
``(-x, -y, z)``, which readers call the orientation LPS. Both qform and sform say so, in mm.
"""

from __future__ import annotations

import gzip
from importlib import import_module
from typing import Any

import numpy as np

from phantom.export.volumes import LabelVolume

_SCANNER = 1
_LABELS = "label"


def nifti(volume: LabelVolume, table: bytes) -> bytes:
    """Return a ``.nii`` file; the table of its labels is a comment in its header extension."""
    nibabel: Any = import_module("nibabel")
    affine = np.diag([*volume.spacing_mm, 1.0])
    affine[:3, 3] = volume.origin_mm
    ras_from_lps = np.diag([-1.0, -1.0, 1.0, 1.0])
    image = nibabel.Nifti1Image(volume.labels, ras_from_lps @ affine)
    image.set_qform(image.affine, code=_SCANNER)
    image.set_sform(image.affine, code=_SCANNER)
    image.header.set_xyzt_units("mm")
    image.header.set_intent(_LABELS, name="materials")
    image.header.extensions.append(nibabel.nifti1.Nifti1Extension("comment", table))
    return bytes(image.to_bytes())


def nifti_gz(volume: LabelVolume, table: bytes) -> bytes:
    """Return a ``.nii.gz`` file, the same bytes for the same volume."""
    return gzip.compress(nifti(volume, table), compresslevel=6, mtime=0)
