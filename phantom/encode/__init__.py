"""From a result to the bytes of a file: one registry of formats, whole files only."""

from phantom.encode.archive import ZIP_MEDIA_TYPE, archive
from phantom.encode.attributes import METADATA_KEY
from phantom.encode.encoding import Encoded, check_held, encode, save
from phantom.encode.files import write_atomically
from phantom.encode.formats import FORMATS, Format, format_named, format_of_path
from phantom.encode.npy import npy
from phantom.encode.picture import Picture
from phantom.encode.png import png
from phantom.encode.sidecar import sidecar
from phantom.encode.stereo import (
    LAYOUTS,
    Layout,
    check_layout,
    encode_pair,
    layouts_of,
    pair_sidecar,
)
from phantom.encode.truth import save_truth, truth_files, truth_layers

__all__ = [
    "FORMATS",
    "LAYOUTS",
    "METADATA_KEY",
    "ZIP_MEDIA_TYPE",
    "Encoded",
    "Format",
    "Layout",
    "Picture",
    "archive",
    "check_held",
    "check_layout",
    "encode",
    "encode_pair",
    "format_named",
    "format_of_path",
    "layouts_of",
    "npy",
    "pair_sidecar",
    "png",
    "save",
    "save_truth",
    "sidecar",
    "truth_files",
    "truth_layers",
    "write_atomically",
]
