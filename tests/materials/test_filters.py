"""What filters are made of."""

from __future__ import annotations

import pytest

from phantom.errors import InvalidInputError
from phantom.materials import FILTER_NAMES, REFERENCE_NAMES, filter_substance, reference


def test_an_element_has_its_printed_density() -> None:
    import xraydb

    for name in set(FILTER_NAMES) - set(REFERENCE_NAMES) - {"carbon"}:  # of which there are several
        substance = filter_substance(name)
        (symbol,) = substance.composition
        assert xraydb.atomic_name(symbol).replace("tungston", "tungsten") == name
        assert substance.density_g_cm3 == pytest.approx(xraydb.atomic_density(symbol), rel=0.02)


def test_a_reference_material_filters_as_itself() -> None:
    air = filter_substance("air")
    assert air.composition == reference("air").composition
    assert air.density_g_cm3 == 0.001205


def test_an_unknown_filter_is_refused_with_the_known_ones() -> None:
    with pytest.raises(InvalidInputError, match="molybdenum") as refusal:
        filter_substance("cheese")
    (problem,) = refusal.value.problems
    assert (problem.path, problem.kind) == ("/beam/filtration_mm", "unknown_material")
