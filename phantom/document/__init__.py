"""The phantom document: what a person writes, read with all of its problems at once."""

from phantom.document.base import Model, Point, Vector, by_shape, by_type, told
from phantom.document.contours import (
    CircleContour,
    Contour,
    EllipseContour,
    PolarContour,
    PolygonContour,
    SplineContour,
    SuperellipseContour,
)
from phantom.document.curves import ArcAxis, Axis, BSplineAxis, HelixAxis, LineAxis, SplineAxis
from phantom.document.documents import Anatomy, Document, Finding
from phantom.document.expressions import Expression
from phantom.document.formula_curves import FormulaAxis, FormulaContour
from phantom.document.formula_text import parse_formula
from phantom.document.formula_tokens import FormulaError
from phantom.document.generalized_cylinder import GeneralizedCylinder
from phantom.document.json_text import decode_json
from phantom.document.leaf import Appearance, Cut, LeafModel
from phantom.document.leaves import (
    Box,
    Cone,
    Cylinder,
    DoubleCone,
    Ellipsoid,
    Quadric,
    Sphere,
)
from phantom.document.profiles import FormulaProfile, KnotProfile, Profile, Scale
from phantom.document.reading import parse, read
from phantom.document.solids import (
    LEAVES,
    OPERATORS,
    Difference,
    Instance,
    Intersection,
    Leaf,
    Operator,
    Overlap,
    Replace,
    Rotation,
    Solid,
    Transformed,
    Union,
    is_leaf,
    label_of,
)
from phantom.document.spans import parameter_range
from phantom.document.substances import (
    CompositionMaterial,
    FixedMaterial,
    Material,
    ReferenceMaterial,
)
from phantom.document.sweeps import (
    FormulaSweep,
    Frame,
    LinearSweep,
    MatrixSweep,
    MorphSection,
    MorphSweep,
    Sweep,
    UpFrame,
)
from phantom.document.validation import validate_model

__all__ = [
    "LEAVES",
    "OPERATORS",
    "Anatomy",
    "Appearance",
    "ArcAxis",
    "Axis",
    "BSplineAxis",
    "Box",
    "CircleContour",
    "CompositionMaterial",
    "Cone",
    "Contour",
    "Cut",
    "Cylinder",
    "Difference",
    "Document",
    "DoubleCone",
    "EllipseContour",
    "Ellipsoid",
    "Expression",
    "Finding",
    "FixedMaterial",
    "FormulaAxis",
    "FormulaContour",
    "FormulaError",
    "FormulaProfile",
    "FormulaSweep",
    "Frame",
    "GeneralizedCylinder",
    "HelixAxis",
    "Instance",
    "Intersection",
    "KnotProfile",
    "Leaf",
    "LeafModel",
    "LineAxis",
    "LinearSweep",
    "Material",
    "MatrixSweep",
    "Model",
    "MorphSection",
    "MorphSweep",
    "Operator",
    "Overlap",
    "Point",
    "PolarContour",
    "PolygonContour",
    "Profile",
    "Quadric",
    "ReferenceMaterial",
    "Replace",
    "Rotation",
    "Scale",
    "Solid",
    "Sphere",
    "SplineAxis",
    "SplineContour",
    "SuperellipseContour",
    "Sweep",
    "Transformed",
    "Union",
    "UpFrame",
    "Vector",
    "by_shape",
    "by_type",
    "decode_json",
    "is_leaf",
    "label_of",
    "parameter_range",
    "parse",
    "parse_formula",
    "read",
    "told",
    "validate_model",
]
