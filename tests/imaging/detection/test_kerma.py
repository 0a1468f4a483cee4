"""From dose to photons."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.errors import InvalidInputError
from phantom.imaging.beam import Beam
from phantom.imaging.detection import Acquisition
from phantom.imaging.detection.kerma import kerma_ugy, photons_per_mm2
from phantom.imaging.spectrum import Spectrum, monochromatic, relative

# NISTIR 5632 table 4, dry air near sea level: keV, mass energy-absorption coefficient in cm2/g.
NIST_AIR = [(15, 1.334), (30, 0.1537), (60, 0.03041), (100, 0.02325), (150, 0.02496)]


@pytest.mark.parametrize(("energy_kev", "mass_absorption_cm2_g"), NIST_AIR)
def test_photons_of_one_energy_carry_the_kerma_of_the_nist_tables(
    energy_kev: float, mass_absorption_cm2_g: float
) -> None:
    # E [J] · mu_en/rho [m2/kg] · photons per m2, in micrograys.
    per_photon = energy_kev * 1.602176634e-16 * mass_absorption_cm2_g * 0.1 * 1e6 * 1e6
    acquisition = Acquisition(detector_air_kerma_ugy=7.0)
    photons = photons_per_mm2(monochromatic(energy_kev), acquisition, 1000.0)
    assert photons[0] == pytest.approx(7.0 / per_photon, rel=1e-6)


def test_the_kerma_asked_for_is_that_of_the_photons() -> None:
    tube = relative(np.array([30.0, 50, 70]), np.array([2.0, 5, 1]))
    photons = photons_per_mm2(tube, Acquisition(detector_air_kerma_ugy=4.0), 1000.0)
    assert photons / photons[2] == pytest.approx([2.0, 5.0, 1.0])
    assert kerma_ugy(tube, photons) == pytest.approx(4.0)
    twice = photons_per_mm2(tube, Acquisition(detector_air_kerma_ugy=8.0), None)
    assert twice == pytest.approx(2 * photons)
    assert kerma_ugy(tube, photons_per_mm2(tube, Acquisition(), None)) == pytest.approx(2.5)


def test_a_standard_beam_has_the_photons_that_the_standard_prints() -> None:
    # RQA 5 of IEC 61267 (70 kV and 21 mm of aluminium added): IEC 62220-1-1 table 2 prints 29653
    # photons per mm2 and uGy (30174 in the edition of 2003).
    beam = Beam(kvp=73.0, filtration_mm={"aluminium": 23.5})
    photons = photons_per_mm2(beam.spectrum(), Acquisition(detector_air_kerma_ugy=1.0), None)
    assert photons.sum() == pytest.approx(29900, rel=0.02)


def test_a_tube_load_gives_its_output_by_the_inverse_square() -> None:
    tube = Spectrum(np.array([40.0, 60]), np.array([1000.0, 3000]), np.ones(2), absolute=True)
    photons = photons_per_mm2(tube, Acquisition(mas=2.5), 2000.0)
    assert photons == pytest.approx([1000 * 2.5 / 4, 3000 * 2.5 / 4])


def test_a_tube_load_needs_a_source_and_a_tube() -> None:
    tube = Spectrum(np.array([40.0]), np.array([1000.0]), np.ones(1), absolute=True)
    for spectrum, distance in ((tube, None), (monochromatic(60.0), 1000.0)):
        with pytest.raises(InvalidInputError) as refusal:
            photons_per_mm2(spectrum, Acquisition(mas=1.0), distance)
        assert [p.path for p in refusal.value.problems] == ["/acquisition/mas"]
