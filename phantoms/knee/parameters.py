"""What a knee may be: a person, and every length that can be set by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Final

from pydantic import Field

from phantom.document import told
from phantom.document.base import Integer, Number
from phantom.library import PersonParameters
from phantom.library.people import Side
from phantoms.knee.sizes import Sizes
from phantoms.people import (
    LENGTH_CORRELATION,
    Measure,
    cortex_share,
    cortical_density_g_cm3,
    fat_mm,
    muscle_scale,
    spongiosa_density_g_cm3,
    trimmed,
)

if TYPE_CHECKING:
    import numpy as np

    from phantom.library import Person

SOURCES: Final = (
    "Bicondylar width 88.6 ± 4.2 / 78.5 ± 3.0 mm, condylar depth 61.1 / 55.5 mm, intercondylar"
    " width 22.0 / 18.7 mm (men / women): Anatomy Research International 2012, 679658.",
    "Tibial plateau 76.1 ± 4.0 / 67.6 ± 3.1 mm across, 48.2 / 43.2 mm deep, medial slope"
    " 4.6 / 9.3 degrees: Kwak et al., in table 5 of PMC9703208.",
    "Patella, both sexes: height 34.4 ± 3.8, width 44.8 ± 4.8, thickness 22.4 ± 2.3 mm: Iranpour et"
    " al., in table 10 of Arthroplasty 2022, doi:10.1186/s42836-022-00117-8; the difference between"
    " the sexes is that of the Koreans in the same table (Kim et al.).",
    "Medial joint space 5.7 ± 0.8 / 4.8 ± 0.7 mm, hardly changing with age: BMC Musculoskeletal"
    " Disorders 2008, 9:119.",
    "Femur: length 448.2 / 419.0 mm, midshaft 26.5 / 25.6 mm across: Karakaş, Harma, Diagnostic and"
    " Interventional Radiology 2008, 14:29-32.",
    "Femoral cortex at midshaft from the share of the canal: Feik, Thomas, Clement, Journal of"
    " Anatomy 1997, 191:407-416. Density with age: Riggs et al., JBMR 2004, 19:1945-1954.",
    "Estimates: tibia and fibula beyond the plateau, walls away from the femur's midshaft, standard"
    " deviations not given above, every outline between these sizes, and the soft tissue.",
)

MEASURES: Final[dict[str, Measure]] = {
    "bicondylar_width_mm": Measure((88.6, 4.2), (78.5, 3.0)),
    "condylar_depth_mm": Measure((61.1, 3.2), (55.5, 2.6)),
    "notch_width_mm": Measure((22.0, 2.0), (18.7, 1.8), 0.3),
    "plateau_width_mm": Measure((76.1, 4.0), (67.6, 3.1)),
    "plateau_depth_mm": Measure((48.2, 3.0), (43.2, 2.5)),
    "patella_height_mm": Measure((36.0, 2.8), (32.9, 2.5)),
    "patella_width_mm": Measure((47.0, 3.4), (42.4, 3.0)),
    "patella_thickness_mm": Measure((23.4, 1.8), (21.4, 1.6)),
    "joint_space_mm": Measure((5.7, 0.8), (4.8, 0.7), 0.2),
    "slope_deg": Measure((4.6, 2.4), (9.3, 2.4), 0.0),
    "valgus_deg": Measure((5.5, 1.2), (6.5, 1.2), 0.0),
    "femur_length_mm": Measure((448.2, 23.0), (419.0, 21.0), LENGTH_CORRELATION),
    "femur_shaft_mm": Measure((26.5, 1.8), (25.6, 1.7)),
}
"""Of which the first to the eighth go together beyond what stature explains: a knee is large."""
_TOGETHER: Final = 8
_COMMON: Final = 0.8
"""How much of the scatter of those is common to them all (an estimate)."""

_MADE: Final = (
    "spongiosa_density_g_cm3",
    "femur_cortex_mm",
    "tibia_cortex_mm",
    "fat_mm",
    "muscle",
)
_TIBIA: Final = (0.835, 0.906)
"""Length of the tibia and width of its shaft over the femur's."""
_FIBULA: Final = 0.49


def _length(title: str, meaning: str, low: float, high: float, unit: str = "mm") -> Any:
    return told(title, unit, f"{meaning} Null: that of the person.", ge=low, le=high)


Null = Number | None


class Parameters(PersonParameters):
    """What the knee may be."""

    side: Annotated[
        Side, told("Side", "none", "Of the body; a left knee is the mirror image of a right one.")
    ] = "right"
    limb_mm: Annotated[
        Number,
        Field(ge=110.0, le=230.0),
        told("Limb", "mm", "How far the limb reaches above and below the joint."),
    ] = 125.0
    bicondylar_width_mm: Annotated[
        Null, _length("Bicondylar width", "Across the femur's condyles.", 60.0, 110.0)
    ] = None
    condylar_depth_mm: Annotated[
        Null, _length("Condylar depth", "From front to back of the condyles.", 42.0, 76.0)
    ] = None
    notch_width_mm: Annotated[
        Null, _length("Notch width", "Between the condyles, behind.", 12.0, 30.0)
    ] = None
    plateau_width_mm: Annotated[
        Null, _length("Plateau width", "Across the tibia's plateau.", 52.0, 96.0)
    ] = None
    plateau_depth_mm: Annotated[
        Null, _length("Plateau depth", "From front to back of the plateau.", 33.0, 62.0)
    ] = None
    slope_deg: Annotated[
        Null, _length("Slope", "Of the plateau, down toward the back.", 0.0, 16.0, "degrees")
    ] = None
    patella_height_mm: Annotated[
        Null, _length("Patella height", "From apex to base.", 22.0, 48.0)
    ] = None
    patella_width_mm: Annotated[Null, _length("Patella width", "Across.", 28.0, 60.0)] = None
    patella_thickness_mm: Annotated[
        Null, _length("Patella thickness", "From its front to the ridge behind.", 14.0, 30.0)
    ] = None
    joint_space_mm: Annotated[
        Null,
        _length("Joint space", "Least distance, along z, of femur and tibia in front.", 2.5, 9.0),
    ] = None
    valgus_deg: Annotated[
        Null,
        _length("Valgus", "Lean of the femur's shaft toward the outer side.", 0.0, 12.0, "degrees"),
    ] = None
    femur_length_mm: Annotated[
        Null, _length("Femur length", "Midshaft is half of it above the joint.", 320.0, 560.0)
    ] = None
    femur_shaft_mm: Annotated[Null, _length("Femur shaft", "Across at midshaft.", 18.0, 36.0)] = (
        None
    )
    femur_cortex_mm: Annotated[
        Null, _length("Femur cortex", "Thickness of the wall at midshaft.", 2.0, 10.0)
    ] = None
    tibia_cortex_mm: Annotated[
        Null, _length("Tibia cortex", "Thickness of the wall at midshaft.", 1.5, 8.0)
    ] = None
    fat_mm: Annotated[Null, _length("Fat", "Under the skin, beside the patella.", 2.0, 40.0)] = None
    muscle: Annotated[
        Null, _length("Muscle", "Widths of muscle over the median person's.", 0.6, 1.5, "1")
    ] = None
    spongiosa_density_g_cm3: Annotated[
        Null, _length("Spongiosa density", "Of spongy bone with its marrow.", 1.0, 1.4, "g/cm³")
    ] = None
    trabecular_seed: Annotated[
        Integer,
        told(
            "Trabecular seed", "none", "Which of many patterns the trabeculae are.", ge=0, lt=2**31
        ),
    ] = 0


def resolved(parameters: Parameters) -> Parameters:
    """Return the parameters with everything that was null filled in from the person."""
    return _filled(parameters, dict.fromkeys((*MEASURES, *_MADE), 0.0))


def of_person(person: Person, generator: np.random.Generator) -> Parameters:
    """Return the knee of a person, scattered as knees of such people are."""
    names = (*MEASURES, *_MADE)
    common, *own = generator.standard_normal(1 + len(names)).tolist()
    side: Side = "left" if generator.random() < 0.5 else "right"
    rest = (1.0 - _COMMON**2) ** 0.5
    scatter = {
        name: _COMMON * common + rest * at if index < _TOGETHER else at
        for index, (name, at) in enumerate(zip(names, own, strict=True))
    }
    seed = int(generator.integers(2**31))
    own_parameters = Parameters(side=side, trabecular_seed=seed, **person.model_dump())
    return _filled(own_parameters, scatter)


def _filled(parameters: Parameters, scatter: dict[str, float]) -> Parameters:
    person = parameters.person
    found: dict[str, float] = {
        name: measure.of(person, scatter[name]) for name, measure in MEASURES.items()
    }
    given = {k: v for k, v in parameters.model_dump().items() if v is not None}
    shaft = given.get("femur_shaft_mm", found["femur_shaft_mm"])
    share = cortex_share(person, scatter["femur_cortex_mm"])
    found["femur_cortex_mm"] = shaft / 2.0 * share
    tibia = shaft * _TIBIA[1] / 2.0 * share * (1.0 + 0.06 * trimmed(scatter["tibia_cortex_mm"]))
    found["tibia_cortex_mm"] = 0.86 * tibia
    found["fat_mm"] = fat_mm(person, 6.0, 11.0, per_bmi=0.07, scatter=scatter["fat_mm"])
    found["muscle"] = muscle_scale(person) * (1.0 + 0.06 * trimmed(scatter["muscle"]))
    found["spongiosa_density_g_cm3"] = spongiosa_density_g_cm3(
        person, scatter=scatter["spongiosa_density_g_cm3"]
    )
    limits = _limits()
    within = {
        name: round(min(max(value, limits[name][0]), limits[name][1]), 4)
        for name, value in found.items()
    }
    return Parameters(**{**within, **person.model_dump(), **given})


def _limits() -> dict[str, tuple[float, float]]:
    """Return the range of every length."""
    found = {}
    for name, field in Parameters.model_fields.items():
        bounds = {type(at).__name__: at for at in field.metadata}
        if "Ge" in bounds and "Le" in bounds:
            found[name] = (float(bounds["Ge"].ge), float(bounds["Le"].le))
    return found


def sizes_of(parameters: Parameters) -> Sizes:
    """Return the sizes of a knee all of whose parameters are there."""
    at = parameters.model_dump()
    shaft = at["femur_shaft_mm"]
    return Sizes(
        limb=at["limb_mm"],
        bicondylar_width=at["bicondylar_width_mm"],
        condylar_depth=at["condylar_depth_mm"],
        notch_width=at["notch_width_mm"],
        femur_length=at["femur_length_mm"],
        femur_shaft=shaft,
        femur_cortex=min(at["femur_cortex_mm"], 0.4 * shaft),
        valgus_deg=at["valgus_deg"],
        plateau_width=at["plateau_width_mm"],
        plateau_depth=at["plateau_depth_mm"],
        slope_deg=at["slope_deg"],
        tibia_length=_TIBIA[0] * at["femur_length_mm"],
        tibia_shaft=_TIBIA[1] * shaft,
        tibia_cortex=min(at["tibia_cortex_mm"], 0.38 * _TIBIA[1] * shaft),
        fibula_shaft=_FIBULA * shaft,
        fibula_cortex=0.5 * min(at["tibia_cortex_mm"], 0.38 * _TIBIA[1] * shaft),
        patella_height=at["patella_height_mm"],
        patella_width=at["patella_width_mm"],
        patella_thickness=at["patella_thickness_mm"],
        joint_space=at["joint_space_mm"],
        fat=at["fat_mm"],
        muscle=at["muscle"],
        cortical_density=cortical_density_g_cm3(parameters.person),
        spongiosa_density=at["spongiosa_density_g_cm3"],
        trabecular_seed=at["trabecular_seed"],
    )
