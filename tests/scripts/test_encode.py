"""`loam encode`: textures that other programs read as Loam believes they show, and bad input."""
import json
import shutil
import struct
import subprocess

import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam, write_png16
from PIL import Image

pytestmark = pytest.mark.usefixtures("has_device")


def picture(path, width=70, height=45, alpha=False):
    """Ground-like: slopes of colour and noise; a flat square, two-colour stripes. No side is a multiple of 4 or 6."""
    random = np.random.default_rng(7)
    y, x = np.mgrid[0:height, 0:width]
    base = np.stack([60 + x * 1.5, 90 + y * 2.0, 40 + x * 0.7], axis=-1)
    pixels = base * (0.7 + 0.3 * random.random((height, width, 1))) + random.normal(0, 3, (height, width, 3))
    pixels[12:24, 12:24] = (200, 10, 77)
    pixels[24:36, 0:24:2] = (255, 255, 255)
    pixels[24:36, 1:24:2] = (3, 2, 1)
    pixels = np.clip(pixels, 0, 255).astype(np.uint8)
    if alpha:
        pixels = np.dstack([pixels, ((x * 3) % 256).astype(np.uint8)])
    Image.fromarray(pixels).save(path)
    return np.asarray(Image.open(path).convert("RGBA")).astype(int)


def encode(source, texture, *options):
    process = run_loam("encode", source, "-o", texture, "--json", *options)
    assert process.returncode == 0, process.stderr
    return json.loads(process.stdout)


def astcenc():
    for name in ("astcenc", "astcenc-avx2", "astcenc-sse4.1", "astcenc-sse2"):
        if shutil.which(name):
            return name
    pytest.skip("astcenc is not installed")


@pytest.mark.parametrize("side", [4, 6])
@pytest.mark.parametrize("alpha", [False, True])
def test_astcenc_decodes_what_loam_shows(tmp_path, side, alpha):
    source = picture(tmp_path / "in.png", alpha=alpha)
    figures = encode(tmp_path / "in.png", tmp_path / "t.astc", "--format", f"astc{side}x{side}", "--shown", tmp_path / "shown.png")
    data = (tmp_path / "t.astc").read_bytes()
    assert data[:7] == bytes([0x13, 0xab, 0xa1, 0x5c, side, side, 1])
    blocks = -(-70 // side) * -(-45 // side)
    assert len(data) == 16 + 16 * blocks and figures["bytes"] == 16 * blocks and figures["blocks_per_s"] > 0
    subprocess.run([astcenc(), "-dl", str(tmp_path / "t.astc"), str(tmp_path / "theirs.png")], check=True, capture_output=True)
    theirs = np.asarray(Image.open(tmp_path / "theirs.png").convert("RGBA")).astype(int)
    ours = np.asarray(Image.open(tmp_path / "shown.png").convert("RGBA")).astype(int)
    assert np.abs(theirs - ours).max() <= 1
    assert (theirs[12:24, 12:24] == source[12:24, 12:24]).all() or alpha  # one colour is exact
    psnr = 10 * np.log10(255**2 / np.square(theirs[..., :3] - source[..., :3]).mean())
    assert psnr == pytest.approx(figures["psnr_db"], abs=0.3)
    assert psnr > (32 if side == 4 else 26)
    # The comparison can fail: a bit of a block changed.
    broken = bytearray(data)
    broken[16 + 16 * (blocks // 2) + 12] ^= 0x10
    (tmp_path / "t.astc").write_bytes(broken)
    subprocess.run([astcenc(), "-dl", str(tmp_path / "t.astc"), str(tmp_path / "theirs.png")], check=True, capture_output=True)
    assert np.abs(np.asarray(Image.open(tmp_path / "theirs.png").convert("RGBA")).astype(int) - ours).max() > 1


@pytest.mark.parametrize("name, code", [("bc1", b"DXT1"), ("bc1-fine", b"DXT1"), ("bc3", b"DXT5")])
def test_dds_as_pillow_reads_it(tmp_path, name, code):
    source = picture(tmp_path / "in.png", width=72, height=44, alpha=name == "bc3")
    figures = encode(tmp_path / "in.png", tmp_path / "t.dds", "--format", name)
    data = (tmp_path / "t.dds").read_bytes()
    assert data[:4] == b"DDS " and struct.unpack("<II", data[12:20]) == (44, 72) and data[84:88] == code
    theirs = np.asarray(Image.open(tmp_path / "t.dds").convert("RGBA")).astype(int)
    psnr = 10 * np.log10(255**2 / np.square(theirs[..., :3] - source[..., :3]).mean())
    assert psnr == pytest.approx(figures["psnr_db"], abs=0.3)
    assert psnr > 28


def test_fine_is_nearer_and_bc4_keeps_red(tmp_path):
    picture(tmp_path / "in.png")
    live, fine = (encode(tmp_path / "in.png", tmp_path / "t.dds", "--format", f)["psnr_db"] for f in ("bc1", "bc1-fine"))
    assert fine > live
    assert encode(tmp_path / "in.png", tmp_path / "t.dds", "--format", "bc4")["psnr_db"] > 36
    weighted = encode(tmp_path / "in.png", tmp_path / "t.dds", "--format", "bc1", "--weights", 0, 1, 0)
    assert weighted["psnr_db"] < live


def test_bad_input(tmp_path):
    picture(tmp_path / "in.png")
    out = tmp_path / "t.astc"

    def line(*words):
        return fails_with_one_sentence(run_loam("encode", *words))

    assert "does not exist" in line(tmp_path / "no.png", "-o", out)
    (tmp_path / "empty.png").write_bytes(b"")
    assert "empty" in line(tmp_path / "empty.png", "-o", out)
    (tmp_path / "text.png").write_text("no picture\n")
    assert "text" in line(tmp_path / "text.png", "-o", out)
    (tmp_path / "cut.png").write_bytes((tmp_path / "in.png").read_bytes()[:300])
    assert "cut short" in line(tmp_path / "cut.png", "-o", out)
    zero = bytearray((tmp_path / "in.png").read_bytes())
    zero[16:20] = bytes(4)  # a picture of no width
    (tmp_path / "zero.png").write_bytes(zero)
    assert "no pixels" in line(tmp_path / "zero.png", "-o", out)
    write_png16(tmp_path / "wide.png", np.zeros((1, 16385)))
    assert "16384" in line(tmp_path / "wide.png", "-o", out)
    assert "astc8x8" in line(tmp_path / "in.png", "-o", out, "--format", "astc8x8")
    assert ".dds" in line(tmp_path / "in.png", "-o", out, "--format", "bc1")
    assert ".astc" in line(tmp_path / "in.png", "-o", tmp_path / "t.png")
    assert "-o" in line(tmp_path / "in.png")
    assert "--weights" in line(tmp_path / "in.png", "-o", out, "--weights", -1, 1, 1)
    assert "no folder" in line(tmp_path / "in.png", "-o", tmp_path / "no folder" / "t.astc")
    assert not out.exists()
