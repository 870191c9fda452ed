"""Heights in and out: what lies in the file lies in the project, to half a millimetre, for made and for real data."""
import json

import loam
import numpy as np
import pytest
from conftest import DEM, oiio, read_png16, run_loam, write_png16, write_tiff_float

HALF_STEP_M = 0.0005 + 1e-9


def made_heights(width, height):
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    return 120 + 40 * np.sin(x * 0.11) * np.cos(y * 0.07) + x * 0.013 + y * 0.21


def check_heights(project, heights, spacing_m, tolerance=HALF_STEP_M, count=1000):
    """`heights` has row 0 in the north."""
    rng = np.random.default_rng(5)
    rows, columns = heights.shape
    i, j = rng.integers(0, columns, count), rng.integers(0, rows, count)
    with loam.open(str(project), read_only=True) as p:
        found = p.height(i * spacing_m, (rows - 1 - j) * spacing_m)
    assert np.abs(found - heights[j, i]).max() <= tolerance + np.abs(heights).max() * 2**-24


def test_png16_by_range_and_by_step(tmp_path):
    samples = np.random.default_rng(2).integers(0, 65536, (70, 131))
    write_png16(tmp_path / "h.png", samples)
    done = run_loam("import", tmp_path / "h.png", tmp_path / "a", "--spacing", 2, "--range", -50, 450, "--layer-size", 0)
    assert done.returncode == 0, done.stderr
    check_heights(tmp_path / "a", -50 + samples * (500 / 65535), 2)
    done = run_loam("import", tmp_path / "h.png", tmp_path / "b", "--spacing", 2, "--step", 0.01, "--offset", 187, "--layer-size", 0)
    assert done.returncode == 0, done.stderr
    check_heights(tmp_path / "b", 187 + samples * 0.01, 2)


def test_float_tiff_and_exr_are_metres(tmp_path):
    heights = made_heights(90, 65)
    write_tiff_float(tmp_path / "h.tif", heights)
    assert run_loam("import", tmp_path / "h.tif", tmp_path / "a", "--spacing", 0.5, "--layer-size", 0).returncode == 0
    check_heights(tmp_path / "a", heights.astype(np.float32).astype(float), 0.5)
    oiio(tmp_path / "h.tif", "-d", "float", "-o", tmp_path / "h.exr")
    assert run_loam("import", tmp_path / "h.exr", tmp_path / "b", "--spacing", 0.5, "--layer-size", 0).returncode == 0
    with loam.open(str(tmp_path / "a")) as a, loam.open(str(tmp_path / "b")) as b:
        assert a.digest() == b.digest()


def test_export_and_import_again_is_the_same(tmp_path):
    write_tiff_float(tmp_path / "h.tif", made_heights(100, 65) / 4)
    assert run_loam("import", tmp_path / "h.tif", tmp_path / "a", "--layer-size", 0).returncode == 0
    with loam.open(str(tmp_path / "a")) as p:
        digest = p.digest()
    for name in ("out.png", "out.tif", "out.exr"):
        done = run_loam("export", tmp_path / "a", tmp_path / name, "--json")
        assert done.returncode == 0, done.stderr
        figures = json.loads(done.stdout)
        scale = ["--step", figures["step_m"], "--offset", figures["offset_m"]] if name.endswith("png") else []
        project = tmp_path / f"from-{name}"
        done = run_loam("import", tmp_path / name, project, "--layer-size", 0, *scale)
        assert done.returncode == 0, done.stderr
        with loam.open(str(project)) as p:
            assert p.digest() == digest, name
    done = run_loam("export", tmp_path / "a", tmp_path / "out.raw")
    assert done.returncode == 0 and (tmp_path / "out.raw").stat().st_size == 4 * 100 * 65


def test_export_has_craters_and_base_has_not(plain, tmp_path):
    with loam.open(str(plain)) as p:
        p.crater(128, 128, radius_m=12, seed=1)
        x = np.arange(0, 250)
        composed = p.height(x.astype(float), 128.0)
    done = run_loam("export", plain, tmp_path / "h.raw", "--json")
    columns, rows = json.loads(done.stdout)["samples"]
    spacing = 256 / (columns - 1)
    assert run_loam("export", plain, tmp_path / "base.raw", "--what", "base").returncode == 0
    with_crater = np.fromfile(tmp_path / "h.raw", "<f4").reshape(rows, columns)[::-1]
    base = np.fromfile(tmp_path / "base.raw", "<f4").reshape(rows, columns)[::-1]
    row = int(128 / spacing)
    np.testing.assert_allclose(with_crater[row, (x / spacing).astype(int)], composed, atol=0.001)
    assert base[row, row] - with_crater[row, row] > 2


def test_the_doctor_speaks(tmp_path):
    oiio("--pattern", "fill:top=0.1:bottom=0.9", "65x33", "1", "-d", "uint8", "-o", tmp_path / "h.png")
    done = run_loam("import", tmp_path / "h.png", tmp_path / "p", "--range", 0, 1000, "--layer-size", 0)
    assert done.returncode == 0, done.stderr
    assert "8 bits" in done.stdout and "not square" in done.stdout


@pytest.mark.parametrize("name, offset, step, crop, spacing", [
    ("bigtujunga", 315, 1, "100,50,500,400", 30), ("halfdome", 1175, 0.05, "0,200,512,512", 28),
    ("gabilan", 187, 0.01, None, 1), ("andes_s33w071", 250, 1, "300,300,180,180", 85), ("plain_n53e027", 142, 1, "0,0,200,200", 74)])
def test_real_elevation_data(name, offset, step, crop, spacing, tmp_path, has_device):
    source = DEM / f"{name}.png"
    if not source.exists():
        pytest.skip(f"{source} is not here")
    words = ["import", source, tmp_path / "p", "--spacing", spacing, "--offset", offset, "--step", step, "--layer-size", 64]
    samples = read_png16(source)
    if crop:
        x, y, w, h = map(int, crop.split(","))
        samples = samples[y:y + h, x:x + w]
        words += ["--crop", crop]
    done = run_loam(*words)
    assert done.returncode == 0, done.stderr
    heights = offset + samples * step
    check_heights(tmp_path / "p", heights, spacing)
    with loam.open(str(tmp_path / "p"), validation=True) as p:
        x, y = (samples.shape[1] // 2) * spacing, (samples.shape[0] // 2) * spacing
        before = p.height(x, y)
        p.crater(x, y, radius_m=60, seed=4)
        assert p.height(x, y) < before - 10
        picture = p.render(size=(320, 180))
        assert picture[..., :3].std() > 4
        assert p.validation_messages() == 0
