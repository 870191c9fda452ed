"""Pictures without a window: they show something, follow edits, and leave validation silent."""
import json

import loam
import numpy as np
import pytest
from conftest import run_loam

pytestmark = pytest.mark.usefixtures("has_device")
VIEW = (128, 80, 60, 0, -40)


def test_a_picture_has_sky_ground_and_no_validation_message(plain):
    with loam.open(str(plain), read_only=True, validation=True) as p:
        picture = p.render(size=(320, 180))
        assert picture.shape == (180, 320, 4) and picture.dtype == np.uint8
        assert picture[..., :3].std() > 4
        assert (picture[..., 3] == 255).all()
        assert p.stats()["settled"]
        assert p.validation_messages() == 0


def test_the_same_picture_twice(plain):
    pictures = []
    for _ in range(2):
        with loam.open(str(plain), read_only=True) as p:
            pictures.append(p.render(VIEW, size=(160, 90)))
    assert np.array_equal(*pictures)


def test_a_crater_is_seen_and_undo_brings_the_picture_back(plain):
    with loam.open(str(plain), validation=True) as p:
        before = p.render(VIEW, size=(320, 180))
        p.crater(128, 140, radius_m=12, seed=1)
        p.step(VIEW, 1, size=(320, 180))
        with_crater = p.render(VIEW, size=(320, 180))
        assert (np.abs(with_crater.astype(int) - before).max(axis=2) > 8).mean() > 0.01
        p.undo()
        after = p.render(VIEW, size=(320, 180))
        assert np.array_equal(before, after)
        assert p.validation_messages() == 0


def find_count(report, name):
    """Of a report with a key somewhere."""
    if isinstance(report, dict):
        if name in report:
            return report[name]
        return next((found for part in report.values() if (found := find_count(part, name)) is not None), None)
    return None


def test_shadows_drawn_in_part_are_those_of_a_fresh_picture(plain):
    """After every edit only the texels of shadow cascades that it can change are drawn again."""
    view, parts = (128, 60, 40, 0, -25), 0
    edits = [lambda p: p.crater(128, 140, radius_m=12, seed=1),
             lambda p: p.sculpt("raise", [(120, 110)], radius_m=5, strength=6),
             lambda p: p.sculpt("lower", [(60, 200)], radius_m=9, strength=5),
             lambda p: p.footprints([(128, 90, 0.0), (128.2, 90.7, 0.1)]),
             lambda p: p.undo(),
             # What stood there alone covered its texels.
             lambda p: p.sculpt("raise", [(136, 120)], radius_m=4, strength=25), lambda p: p.undo(),
             lambda p: p.sculpt("raise", [(255, 255)], radius_m=8, strength=9)]
    with loam.open(str(plain), validation=True) as p:
        p.set("sun.elevation_rad", 0.25)
        before = p.render(view, size=(240, 135), debug="shadow")
        for edit in edits:
            edit(p)
            p.step(view, 1, size=(240, 135))
            figures = p.stats()["frame"]
            assert find_count(figures, "shadow_cascades_drawn") == 0
            parts += find_count(figures, "shadow_parts_drawn")
        after = p.render(view, size=(240, 135), debug="shadow")
        assert p.validation_messages() == 0
    assert parts >= len(edits)
    assert (np.abs(after.astype(int) - before).max(axis=2) > 30).mean() > 0.01
    with loam.open(str(plain), read_only=True) as p:
        fresh = p.render(view, size=(240, 135), debug="shadow")
    # Floats of a cascade drawn from another place round otherwise; here the camera has not moved.
    assert (np.abs(after.astype(int) - fresh).max(axis=2) > 8).mean() < 0.0005


def test_the_reference_is_close_to_the_picture(plain):
    with loam.open(str(plain), read_only=True) as p:
        picture = p.render(VIEW, size=(160, 90), supersample=2).astype(float)
        reference = p.render(VIEW, size=(160, 90), reference=True).astype(float)
    psnr = 10 * np.log10(255**2 / max(1e-9, ((picture - reference)[..., :3] ** 2).mean()))
    assert psnr > 25, psnr


def test_render_from_the_command_line(plain, tmp_path):
    done = run_loam("render", plain, "--look-at", "128,20,90,128,128,0", "-o", tmp_path / "p.png", "--size", "160x90", "--json", "--validation")
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures["settled"] and figures["size"] == [160, 90] and figures["validation_messages"] == 0
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")


def test_info_has_a_memory_table(plain):
    done = run_loam("info", plain, "--gpu", "--json", "--size", "160x90")
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures["frame"]["memory_bytes"] and figures["devices"]




def test_filters_differ_and_taps_are_nearest_to_the_reference(plain):
    with loam.open(str(plain), validation=True) as p:
        p.paint([(128, 90)], layer=p.layers[5], radius_m=25)
        height = p.height(128, 60) + 2
        view = (128, 60, height, 0, -6)
        truth = p.render(view, size=(160, 90), reference=True).astype(float)[..., :3]
        error = {}
        for name in ("bilinear", "trilinear", "tiles", "hardware", "auto"):
            picture = p.render(view, size=(160, 90), filter=name).astype(float)[..., :3]
            assert p.stats()["settled"], name
            error[name] = ((picture - truth) ** 2).mean()
        print(error)
        assert p.validation_messages() == 0
        assert error["tiles"] < 0.9 * error["trilinear"]
        assert error["hardware"] < 0.9 * error["trilinear"]
        assert error["auto"] in (error["tiles"], error["hardware"])
        with pytest.raises(loam.Error, match="unknown filter \"sharp\", expected one of auto, bilinear, trilinear, tiles, hardware"):
            p.render(view, size=(16, 9), filter="sharp")


def test_an_unknown_filter_on_the_command_line(plain, tmp_path):
    done = run_loam("render", plain, "--filter", "sharp", "-o", tmp_path / "p.png")
    assert done.returncode != 0 and "unknown filter \"sharp\"" in done.stderr
    done = run_loam("render", plain, "--filter", "tiles", "-o", tmp_path / "p.png", "--size", "64x36", "--validation")
    assert done.returncode == 0, done.stderr
