"""Quantum noise: its mean, variance and spectrum."""

from __future__ import annotations

import numpy as np
import pytest

from phantom.imaging.detection import Blur, DetectorModel, NoiseKey, Window
from phantom.imaging.detection.blur import blurred, mtf
from phantom.imaging.detection.quanta import compound, per_bin
from phantom.imaging.detection.scintillator import PhotonResponse, response
from phantom.imaging.view import FloatArray

MILLION = Window(0, 0, 1000, 1000)
KEY = NoiseKey(seed=20, case=3)


def flat(values: FloatArray, window: Window) -> FloatArray:
    return np.broadcast_to(values[:, None, None], (len(values), window.rows, window.columns)).copy()


def drawn(photons: FloatArray, given: PhotonResponse, window: Window = MILLION) -> FloatArray:
    return compound(flat(photons @ given.weights, window), window, KEY)


def agrees(image: FloatArray, mean: float, variance: float, fourth: float) -> None:
    """Mean and variance within 4.5 of their own standard deviations; ``fourth`` central moment."""
    count = image.size
    assert abs(image.mean() - mean) < 4.5 * np.sqrt(variance / count)
    assert abs(image.var() - variance) < 4.5 * np.sqrt((fourth - variance**2) / count)


@pytest.mark.parametrize("photons", [0.3, 9.0, 40.0, 2500.0])
def test_a_counting_detector_has_as_much_variance_as_mean(photons: float) -> None:
    energies = np.array([20.0, 40.0, 60.0])
    given = response(DetectorModel(response="photon_counting"), energies)
    image = drawn(np.array([0.2, 0.5, 0.3]) * photons, given)
    assert (image == np.rint(image)).all()
    agrees(image, photons, photons, photons + 3 * photons**2)


@pytest.mark.parametrize("swank", [1.0, 0.85])
def test_an_integrating_detector_has_the_variance_of_the_compound_process(swank: float) -> None:
    energies = np.array([20.0, 35.0, 50.0, 80.0])
    photons = np.array([300.0, 500.0, 400.0, 100.0])
    given = response(DetectorModel(gain_per_kev=2.0, swank_factor=swank), energies)
    mean = float(photons @ (2 * energies))
    variance = float(photons @ (2 * energies) ** 2) / swank
    agrees(drawn(photons, given), mean, variance, 3 * variance**2)


def test_few_photons_of_many_energies_keep_mean_and_variance() -> None:
    energies = np.array([20.0, 60.0, 100.0])
    photons = np.array([0.4, 0.7, 0.2])
    given = response(DetectorModel(swank_factor=0.9), energies)
    variance = float(photons @ energies**2) / 0.9
    image = drawn(photons, given)
    agrees(image, float(photons @ energies), variance, float(np.mean((image - image.mean()) ** 4)))


@pytest.mark.parametrize("swank", [1.0, 0.8])
def test_every_bin_by_itself_has_the_same_mean_and_variance(swank: float) -> None:
    energies = np.array([20.0, 35.0, 50.0, 80.0, 81.0])
    photons = np.array([30.0, 5.0, 400.0, 100.0, 1.0])
    window = Window(0, 0, 500, 400)
    given = response(DetectorModel(swank_factor=swank), energies)
    image = per_bin(flat(photons * given.stopped, window), given, window, KEY)
    variance = float(photons @ energies**2) / swank
    agrees(image, float(photons @ energies), variance, 3 * variance**2)


def test_photons_of_one_energy_are_never_spread() -> None:
    given = response(DetectorModel(), np.array([60.0]))
    image = drawn(np.array([25.0]), given, Window(0, 0, 50, 60)) / 60
    assert np.allclose(image, np.rint(image), atol=1e-9)


def test_noise_is_white_and_after_blur_has_the_square_of_the_mtf() -> None:
    pitch = 0.2
    given = response(DetectorModel(), np.array([30.0, 60.0]))
    photons = np.array([300.0, 700.0])
    variance = float(photons @ np.array([900.0, 3600.0]))
    image = drawn(photons, given, Window(0, 0, 1024, 1024)) - float(photons @ [30.0, 60.0])
    blur = Blur(shape="lorentzian", half_frequency_per_mm=1.5)
    for picture, filtered in ((image, False), (blurred(image, blur, (pitch, pitch)), True)):
        # NPS(u, v) = pitch² / N² ⟨|DFT|²⟩ over regions of 128² (IEC 62220-1-1), around rings.
        regions = picture.reshape(8, 128, 8, 128).swapaxes(1, 2)
        spectrum = (np.abs(np.fft.fft2(regions)) ** 2).mean(axis=(0, 1)) * pitch**2 / 128**2
        u = np.fft.fftfreq(128, pitch)
        radius = np.hypot(u[:, None], u[None, :])
        expected = variance * pitch**2 * (mtf(blur, radius) ** 2 if filtered else 1.0)
        ratio = spectrum / expected
        for least in np.arange(0.1, 2.4, 0.2):
            ring = (radius >= least) & (radius < least + 0.2)
            # Each of 64 regions gives an exponential variate at half of the frequencies.
            error = np.sqrt(2 / (64 * ring.sum()))
            assert abs(ratio[ring].mean() - 1) < 4.5 * error + 0.01 * filtered


def test_twins_share_their_luck() -> None:
    window = Window(0, 0, 200, 200)
    given = response(DetectorModel(swank_factor=0.9), np.array([30.0, 60.0]))
    healthy = flat(np.array([500.0, 500.0]) @ given.weights, window)
    lesion = healthy.copy()
    lesion[:, 80:120, 80:120] *= 0.98
    one, two = compound(healthy, window, KEY), compound(lesion, window, KEY)
    changed = one != two
    assert changed[80:120, 80:120].all()
    assert changed.sum() == 40 * 40
    # The difference has hardly any noise of its own: two independent images would have ~2 σ².
    difference = (one - two)[80:120, 80:120]
    assert difference.std() < 0.05 * one.std()
    assert difference.mean() == pytest.approx(0.02 * 45000, rel=0.02)
