"""Folders of material maps become layers: by name, of any size, with what is missing made up and said."""
import json
import struct
import subprocess
import zlib

import loam
import numpy as np
import pytest
from conftest import SOURCE, fails_with_one_sentence, run_loam, write_tiff_float

MATERIALS = SOURCE.parent / "shared" / "data" / "materials"
SETS = ("grass", "cliff", "dirt", "leaves", "clover", "rock", "sand", "snow")


def write_png8(path, samples, palette=None):
    """An 8-bit PNG by hand: (h, w) grey or indices, (h, w, 2) grey and alpha, (h, w, 3), (h, w, 4)."""
    a = np.asarray(samples, np.uint8)
    if a.ndim == 2:
        a = a[..., None]
    kind = 3 if palette is not None else {1: 0, 2: 4, 3: 2, 4: 6}[a.shape[2]]

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", a.shape[1], a.shape[0], 8, kind, 0, 0, 0))
    colours = chunk(b"PLTE", np.asarray(palette, np.uint8).tobytes()) if palette is not None else b""
    rows = b"".join(b"\0" + row.tobytes() for row in a)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + head + colours + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def hills(height, width, depth=2.0):
    """Heights in texels that tile, and their normals as bytes, green up; row 0 is the top."""
    y, x = np.mgrid[0:height, 0:width]
    u, v = 2 * np.pi * x / width, -2 * np.pi * y / height
    h = depth * (np.sin(3 * u + 2 * v) + np.cos(5 * v - 2 * u))
    dx = (np.roll(h, -1, 1) - np.roll(h, 1, 1)) / 2
    dy = (np.roll(h, 1, 0) - np.roll(h, -1, 0)) / 2  # north is up
    n = np.stack([-dx, -dy, np.ones_like(h)], -1)
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    return h, np.round(128 + 127 * n).astype(np.uint8)


@pytest.fixture
def material(tmp_path):
    """A folder with every usual map, 64x64."""
    folder = tmp_path / "Moss01"
    folder.mkdir()
    rng = np.random.default_rng(4)
    h, normal = hills(64, 64)
    write_png8(folder / "Moss01_Color.png", rng.integers(40, 120, (64, 64, 3)))
    write_png8(folder / "Moss01_NormalGL.png", normal)
    write_png8(folder / "Moss01_Roughness.png", rng.integers(150, 250, (64, 64)))
    write_png8(folder / "Moss01_AmbientOcclusion.png", rng.integers(200, 255, (64, 64)))
    write_png8(folder / "Moss01_Displacement.png", np.interp(h, (h.min(), h.max()), (0, 255)))
    return folder


def pack(folder, *options):
    done = run_loam("pack", folder, "--json", *options)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def said(report):
    return "\n".join(report["notes"] + report["warnings"])


def chosen(report, channel):
    (row,) = [r for r in report["rows"] + report["packed"] if r["chosen"] and r["channel"] == channel]
    return row


def test_a_whole_folder_needs_no_words(material, tmp_path):
    report = pack(material, "-o", tmp_path / "moss.layer")
    assert report["warnings"] == []
    assert report["notes"] == ["no reveal map: reveal follows the heights"]
    assert report["size_texels"] == 64
    assert (tmp_path / "moss.layer").stat().st_size > 1000
    assert json.loads((tmp_path / "moss.json").read_text()) == report
    for channel in ("colour", "normal", "gloss", "occlusion", "reveal", "metalness"):
        assert chosen(report, channel)["mean"] >= 0
    assert chosen(report, "metalness")["format"] == "constant"


def test_a_layer_is_there_at_once_and_can_be_painted(plain, material, has_device):
    with loam.open(str(plain), validation=True) as p:
        names, z = p.layers, p.height(128, 128)
        camera = loam.Camera.look_at((128, 90, z + 50), (128, 128, z))
        p.paint([(128, 128)], layer=names[0], radius_m=60, hardness=1)
        before = p.render(camera, size=(320, 180))
        added = p.add_layer(str(material), name="moss", tile_m=3)
        assert p.layers == names + ["moss"] and added["index"] == len(names)
        p.paint([(128, 128)], layer="moss", radius_m=40, hardness=1)
        assert p.layer(128, 128) == added["index"]
        after = p.render(camera, size=(320, 180))
        assert np.abs(after.astype(int) - before).mean() > 3
        assert p.validation_messages() == 0
        assert p.count_stale_pages() == 0
    with loam.open(str(plain), read_only=True) as p:
        assert p.layer(128, 128) == added["index"] and p.layers[-1] == "moss"
    done = run_loam("info", plain, "--layers")
    assert done.returncode == 0 and len(done.stdout.splitlines()) == len(names) + 1, done.stderr


def test_the_command_line_appends_and_keeps_indices(plain, material):
    with loam.open(str(plain)) as p:
        before, digest = p.layers, p.digest()
    done = run_loam("layer", "add", plain, material, "--tile", 1.5, "--size", 32)
    assert done.returncode == 0, done.stderr
    assert f'layer {len(before)} "Moss01"' in done.stdout and "resampled from 64x64 to 32x32" in done.stdout
    assert run_loam("layer", "add", plain, material, "--name", "Moss/two", "--json").returncode == 0
    with loam.open(str(plain)) as p:
        assert p.layers == before + ["Moss01", "Moss/two"] and p.digest() == digest
    assert (plain / "layers" / "Moss_two.layer").exists()
    assert loam.verify(str(plain)) == []


def mip0(path):
    """(albedo_reveal, normal_gloss_occlusion) of a layer file, row 0 south."""
    data = path.read_bytes()
    size, at, out = struct.unpack_from("<I", data, 8)[0], 12, []
    for _ in range(2):
        length = struct.unpack_from("<I", data, at)[0]
        frame = data[at + 4:at + 4 + length]
        raw = subprocess.run(["zstd", "-d", "-c"], input=frame, capture_output=True, check=True).stdout
        out.append(np.frombuffer(raw, np.uint8).reshape(size, size, 4))
        at += 4 + length
    return out


@pytest.fixture
def unpacked(tmp_path):
    import shutil
    if not shutil.which("zstd"):
        pytest.skip("zstd is not installed")

    def run(folder, *options):
        report = pack(folder, "-o", tmp_path / "u.layer", *options)
        return report, *mip0(tmp_path / "u.layer")
    return run


def test_directx_normals_become_opengl_by_name_by_option_and_by_slope(material, unpacked):
    _, _, right = unpacked(material)
    green_down = hills(64, 64)[1].copy()
    green_down[..., 1] = 256 - green_down[..., 1].astype(int)
    (material / "Moss01_NormalGL.png").unlink()
    write_png8(material / "Moss01_NormalDX.png", green_down)
    report, _, named = unpacked(material)
    assert np.abs(named.astype(int) - right).max() <= 1 and report["warnings"] == []
    (material / "Moss01_NormalDX.png").rename(material / "Moss01_normal.png")
    report, _, found = unpacked(material)
    assert np.abs(found.astype(int) - right).max() <= 1
    assert "taken as DirectX" in said(report)
    report, _, wrong = unpacked(material, "--normal", "gl")
    assert np.abs(wrong.astype(int) - right).max() > 50  # the test can fail
    assert "slopes fit DirectX" in said(report)


def test_both_directions_in_one_folder(material):
    write_png8(material / "Moss01_NormalDX.png", hills(64, 64)[1])
    assert "Moss01_NormalDX.png is left out" in said(pack(material))


def test_south_is_the_last_row_of_the_picture(material, unpacked):
    color = np.zeros((64, 64, 3))
    color[:8] = 255  # north
    write_png8(material / "Moss01_Color.png", color)
    _, albedo, _ = unpacked(material)
    assert albedo[60, 0, 0] == 255 and albedo[3, 0, 0] == 0


def test_a_colour_alone_is_enough(tmp_path):
    folder = tmp_path / "only"
    folder.mkdir()
    write_png8(folder / "albedo.png", np.random.default_rng(1).integers(0, 255, (32, 32, 3)))
    text = said(pack(folder))
    for part in ("no normal and no height map: flat", "no roughness map: roughness 0.75", "no occlusion map: 1",
                 "reveal follows the colour's brightness"):
        assert part in text


def test_normals_from_heights(material, unpacked):
    (material / "Moss01_NormalGL.png").unlink()
    report, _, surface = unpacked(material)
    assert "no normal map: made from the heights, 0.03 of the tile deep" in said(report)
    expected = hills(64, 64)[1][::-1].astype(int)
    for axis in (0, 1):  # the same shape, whatever its depth
        assert np.corrcoef(surface[..., axis].ravel(), expected[..., axis].ravel())[0, 1] > 0.97
    report, _, flat = unpacked(material, "--relief", 0)
    assert (flat[..., :2] == 128).all()


@pytest.mark.parametrize("height, width, words", [
    (1, 1, "resampled from 1x1 to 4x4"), (5, 3, "stretched to a square"), (60, 60, "resampled from 60x60 to 64x64"),
    (32, 64, "repeated 2 times"), (64, 40, "stretched to a square")])
def test_sizes(tmp_path, height, width, words):
    folder = tmp_path / "odd"
    folder.mkdir()
    write_png8(folder / "odd_diff.png", np.full((height, width, 3), 100))
    write_png8(folder / "odd_nor_gl.png", np.full((height, width, 3), (128, 128, 255)))
    report = pack(folder)
    assert words in said(report)
    assert report["size_texels"] in (4, 64)
    assert report["warnings"] == []
    assert chosen(report, "normal")["max"] < 1e-3


def test_maps_of_different_sizes_meet(material, unpacked):
    write_png8(material / "Moss01_Roughness.png", np.full((16, 32), 200))
    report, _, surface = unpacked(material)
    assert "the roughness map is resampled from 32x16 to 64x64" in said(report)
    assert np.abs(surface[..., 2].astype(int) - 55).max() <= 1


def test_srgb_and_linear_colours(tmp_path, unpacked):
    folder = tmp_path / "mid"
    folder.mkdir()
    write_png8(folder / "mid_color.png", np.full((8, 8, 3), 100))
    _, albedo, _ = unpacked(folder)
    assert (albedo[..., :3] == 100).all()
    _, albedo, _ = unpacked(folder, "--color", "linear")
    assert np.abs(albedo[..., :3].astype(int) - 168).max() <= 1  # sRGB of 100 / 255
    (folder / "mid_color.png").unlink()
    write_tiff_float(folder / "mid_color.tif", np.full((8, 8), 0.2))
    report, albedo, _ = unpacked(folder)
    assert np.abs(albedo[..., :3].astype(int) - 124).max() <= 1
    assert "taken as linear: it holds floats" in said(report) and "the colour map is grey" in said(report)


def test_nan_in_a_map_is_mended_and_counted(material):
    rough = np.full((64, 64), 0.5)
    rough[3, 4] = np.nan
    rough[5, 6] = -np.inf
    (material / "Moss01_Roughness.png").unlink()
    write_tiff_float(material / "Moss01_Roughness.tif", rough)
    report = pack(material)
    assert "2 of 4096 samples of channel 1 are NaN or infinite and become 0.5" in said(report)
    assert chosen(report, "gloss")["format"] == "constant"
    write_tiff_float(material / "Moss01_Roughness.tif", np.full((64, 64), np.nan))
    assert "finite" in fails_with_one_sentence(run_loam("pack", material))


def test_values_outside_are_clamped_and_counted(material):
    (material / "Moss01_Roughness.png").unlink()
    write_tiff_float(material / "Moss01_Roughness.tif", np.where(np.arange(64) < 32, 0.5, 1.5) * np.ones((64, 1)))
    assert "2048 samples of the roughness map lie outside" in said(pack(material))


def test_gloss_0_metalness_1_and_black(tmp_path, unpacked):
    folder = tmp_path / "extreme"
    folder.mkdir()
    write_png8(folder / "e_color.png", np.zeros((8, 8, 3)))
    write_png8(folder / "e_gloss.png", np.zeros((8, 8)))
    write_png8(folder / "e_metalness.png", np.full((8, 8), 255))
    report, albedo, surface = unpacked(folder)
    assert (albedo[..., :3] == 0).all() and (surface[..., 2] == 0).all() and (surface[..., 3] == 255).all()
    assert report["bytes_texel_before"] == 9 and report["fused_round_trip"]["max"] < 0.01
    assert chosen(report, "metalness")["format"] == "constant"


def test_specular_becomes_metalness(tmp_path, unpacked):
    folder = tmp_path / "gold"
    folder.mkdir()
    colour, specular = np.full((8, 8, 3), 120), np.full((8, 8, 3), 56)  # soil that reflects 0.04
    colour[:, 4:], specular[:, 4:] = 0, (255, 219, 145)               # and gold
    write_png8(folder / "gold_albedo.png", colour)
    write_png8(folder / "gold_specular.png", specular)
    report, albedo, _ = unpacked(folder)
    assert np.abs(albedo[2, 6, :3].astype(int) - (255, 219, 145)).max() <= 1
    assert np.abs(albedo[2, 1, :3].astype(int) - 120).max() <= 1
    trip = report["fused_round_trip"]
    assert trip["max"] < 1e-3 and trip["max_8bit"] < 0.006 and trip["max_lit"] < 0.005
    assert "specular becomes metalness" in said(report)


def test_palettes_grey_with_alpha_and_opacity(tmp_path, unpacked):
    folder = tmp_path / "kinds"
    folder.mkdir()
    write_png8(folder / "k_color.png", np.arange(64).reshape(8, 8) % 2, palette=[(10, 20, 30), (200, 100, 50)])
    write_png8(folder / "k_roughness.png", np.dstack([np.full((8, 8), 100), np.full((8, 8), 7)]))
    write_png8(folder / "k_opacity.png", np.zeros((8, 8)))
    write_png8(folder / "k_unknown7.png", np.zeros((8, 8)))
    report, albedo, surface = unpacked(folder)
    assert {tuple(c) for c in albedo[..., :3].reshape(-1, 3)} == {(10, 20, 30), (200, 100, 50)}
    assert (surface[..., 2] == 155).all()
    assert "k_opacity.png is left out: layers have no such map" in said(report)
    assert "k_unknown7.png is left out: its name says no map" in said(report)


# --- what is refused ---

def refused(*words):
    return fails_with_one_sentence(run_loam(*words))


def test_folders_that_are_none(tmp_path, material):
    assert "no folder" in refused("pack", tmp_path / "nowhere")
    (tmp_path / "file").write_text("x")
    assert "is a file" in refused("pack", tmp_path / "file")
    (tmp_path / "empty").mkdir()
    assert "no colour map" in refused("pack", tmp_path / "empty")
    (material / "Moss01_Color.png").unlink()
    assert "no colour map" in refused("pack", material)


def test_two_maps_of_a_kind(material):
    write_png8(material / "old_rough.png", np.zeros((8, 8)))
    line = refused("pack", material)
    assert "Moss01_Roughness.png" in line and "old_rough.png" in line and "remove one" in line


def test_damaged_maps(material):
    whole = (material / "Moss01_Color.png").read_bytes()
    for share in (0.01, 0.3, 0.9):
        (material / "Moss01_Color.png").write_bytes(whole[:int(len(whole) * share)])
        assert "Moss01_Color.png" in refused("pack", material)
    (material / "Moss01_Color.png").write_text("no picture")
    assert "text" in refused("pack", material)
    (material / "Moss01_Color.png").write_bytes(b"")
    assert "empty" in refused("pack", material)


def test_jpegs_cut_short_and_of_inks(material, tmp_path):
    image = pytest.importorskip("PIL.Image")
    (material / "Moss01_Color.png").unlink()
    jpeg = material / "Moss01_Color.jpg"
    pixels = np.random.default_rng(3).integers(0, 255, (64, 64, 3), dtype=np.uint8)
    for progressive in (False, True):
        image.fromarray(pixels).save(jpeg, progressive=progressive)
        assert pack(material)["size_texels"] == 64
        whole = jpeg.read_bytes()
        for share in (0.1, 0.5, 0.97):
            jpeg.write_bytes(whole[:int(len(whole) * share)])
            assert "Moss01_Color.jpg" in refused("pack", material)
    image.fromarray(pixels).convert("CMYK").save(jpeg)
    assert "CMYK" in refused("pack", material)


def test_normals_of_one_channel(material):
    write_png8(material / "Moss01_NormalGL.png", np.full((64, 64), 128))
    assert "one channel" in refused("pack", material)


def test_options_that_cannot_be(material, tmp_path):
    for words, part in ((["--size", 100], "power of two"), (["--size", 0], "above 0"), (["--size", 8192], "power of two"),
                        (["--normal", "up"], "gl, dx"), (["--color", "cmyk"], "srgb, linear"), (["--relief", -1], "relief"),
                        (["--relief", "nan"], "nan"), (["-o", tmp_path / "x.png"], ".layer"),
                        (["-o", tmp_path / "no" / "x.layer"], "x.layer")):
        assert part in refused("pack", material, *words)
    (tmp_path / "bad.layer").write_bytes(b"LOAMLYR1")
    assert "bad.layer" in refused("pack", tmp_path / "bad.layer")


def test_a_refused_layer_leaves_the_project_as_it_was(plain, material, tmp_path):
    def state():
        return {f: f.read_bytes() for f in sorted(plain.rglob("*")) if f.is_file() and f.parent.name == "layers" or f.name == "project.toml"}
    before = state()
    with loam.open(str(plain), read_only=True) as p:
        taken = p.layers[0]
        with pytest.raises(loam.Error, match="read-only"):
            p.add_layer(str(material))
    for words, part in (([material, "--name", taken], "choose another name"), ([material, "--tile", 0], "tile_m"),
                        ([material, "--tile", 1e9], "tile_m"), ([tmp_path / "nowhere"], "no folder"),
                        ([material, "--name", ""], "empty"), ([material, "--size", 3], "power of two")):
        assert part in refused("layer", "add", plain, *words)
    assert "add" in refused("layer", "remove", plain, material)
    with loam.open(str(plain)):
        assert str(plain) in refused("layer", "add", plain, material)
    with loam.open(str(plain)) as p, pytest.raises(loam.Error, match="one of gl, dx"):
        p.add_layer(str(material), normal="west")
    assert state() == before
    assert run_loam("info", plain).returncode == 0


def test_a_layer_that_cannot_be_written(plain, material):
    # A folder where the file of the new project.toml would be: everything before it is taken back.
    (plain / "project.toml.new").mkdir()
    before = sorted((plain / "layers").iterdir())
    assert "project.toml" in refused("layer", "add", plain, material)
    assert sorted((plain / "layers").iterdir()) == before
    (plain / "project.toml.new").rmdir()
    assert run_loam("layer", "add", plain, material).returncode == 0


# --- real materials ---

@pytest.mark.parametrize("name", SETS)
def test_photographed_sets(name):
    if not (MATERIALS / name).is_dir():
        pytest.skip(f"{MATERIALS / name} is not there")
    report = pack(MATERIALS / name)
    assert report["size_texels"] == 1024
    assert "normals taken as OpenGL" in said(report)
    assert report["bytes_texel_after"] < report["bytes_texel_before"]
    for channel in ("colour", "normal", "gloss", "occlusion", "reveal", "metalness"):
        assert chosen(report, channel)["fits"], channel
    assert report["fused_round_trip"]["max"] < 1e-3
    assert report["fused_round_trip"]["max_8bit"] < 0.006
