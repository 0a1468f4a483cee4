"""Path lengths along rays that the caller chooses."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from phantom.document import Model, Point, Vector, told
from phantom.errors import InvalidInputError, Problem
from phantom.requests.limits import Limits
from phantom.requests.subject import Subject, read_request
from phantom.scene import Phantom
from phantom.tracing import path_lengths

FloatArray = NDArray[np.float64]


class PathLengthsRequest(Model):
    """Rays through a phantom."""

    phantom: Annotated[Subject, told("Phantom", "none", "What the rays cross.")]
    origins: Annotated[tuple[Point, ...], told("Origins", "mm", "Where each ray starts.")]
    directions: Annotated[
        tuple[Vector, ...], told("Directions", "none", "Where each goes; need not be unit vectors.")
    ]


class PathLengthsAnswer(Model):
    """Millimetres of every material along every ray."""

    material_names: Annotated[
        tuple[str, ...], told("Materials", "none", "One for each column, in the document's order.")
    ]
    path_lengths_mm: Annotated[
        tuple[tuple[float, ...], ...], told("Path lengths", "mm", "One row for each ray.")
    ]


class PhantomRequest(Model):
    """A phantom alone."""

    phantom: Annotated[Subject, told("Phantom", "none", "What the rays cross.")]


def trace(
    tree: object, limits: Limits | None = None, cancelled: Callable[[], bool] | None = None
) -> tuple[Phantom, FloatArray]:
    """Return the phantom and the (N, M) path lengths in mm that a request asks for.

    Raises
    ------
    InvalidInputError
        Every problem found, with the path of its field in the request.
    """
    request, phantom = read_request(PathLengthsRequest, tree)
    return _traced(
        phantom,
        np.asarray(request.origins, dtype=np.float64).reshape(-1, 3),
        np.asarray(request.directions, dtype=np.float64).reshape(-1, 3),
        limits,
        cancelled,
    )


def trace_npy(
    phantom: Mapping[str, Any],
    data: bytes,
    limits: Limits | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> tuple[Phantom, FloatArray]:
    """Do as `trace`, for rays in an NPY file of shape (N, 2, 3): an origin and a direction each."""
    _, loaded = read_request(PhantomRequest, {"phantom": phantom})
    rays = _rays(data)
    return _traced(loaded, rays[:, 0], rays[:, 1], limits, cancelled)


def _traced(
    phantom: Phantom,
    origins: FloatArray,
    directions: FloatArray,
    limits: Limits | None,
    cancelled: Callable[[], bool] | None,
) -> tuple[Phantom, FloatArray]:
    if len(origins) != len(directions):
        message = f"found {len(directions)}; expected as many as there are origins, {len(origins)}"
        raise InvalidInputError([Problem("/directions", "wrong_length", message)])
    (limits or Limits()).check_rays(len(origins), len(phantom.material_names))
    return phantom, path_lengths(phantom, origins, directions, cancelled=cancelled)


def _rays(data: bytes) -> FloatArray:
    """Return the (N, 2, 3) numbers of an NPY file, its header checked against its length."""
    expected = "expected an NPY file of float64, C order, shape (N, 2, 3)"
    stream = io.BytesIO(data)
    try:
        major, _ = np.lib.format.read_magic(stream)
        read_header = {
            1: np.lib.format.read_array_header_1_0,
            2: np.lib.format.read_array_header_2_0,
        }[major]
        shape, fortran_order, dtype = read_header(stream)
    except Exception as error:  # whatever Python's tokenizer makes of a header's text
        _refuse_rays(f"found a header that cannot be read; {expected}", error)
    if dtype != np.dtype("<f8") or fortran_order or len(shape) != 3 or shape[1:] != (2, 3):
        order = "Fortran" if fortran_order else "C"
        _refuse_rays(f"found {dtype}, {order} order, shape {shape}; {expected}")
    if len(data) - stream.tell() != shape[0] * 48:
        _refuse_rays(f"found {len(data) - stream.tell()} bytes for shape {shape}; {expected}")
    return np.frombuffer(data, dtype="<f8", offset=stream.tell()).reshape(shape)


def _refuse_rays(message: str, cause: Exception | None = None) -> Any:
    raise InvalidInputError([Problem("", "not_npy", message)]) from cause
