"""Golden pictures of a small edited project; README.md here says how they are compared and renewed."""
import os
import struct
import sys
import zlib
from pathlib import Path

import loam
import numpy as np
import pytest

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "scripts"))
from conftest import has_device, plain_template  # noqa: E402, F401  (fixtures)

FAILED = Path(os.environ.get("LOAM_BINARY_DIR", HERE.parents[1] / "build" / "release")) / "golden"
BLESS = os.environ.get("LOAM_BLESS") == "1"
SIZE = (320, 180)
MOST_BYTES = 100 * 1024
# Single pixels at the borders of mips, layers and shadows may round otherwise on another driver; the look may not move.
MEAN_LIMIT, PERCENTILE_LIMIT = 1.0, 20.0

# Eye and target in world metres; heights are above the ground under them.
VIEWS = {
    "map": ((20, 10, 110), (140, 150, 0)),
    "crater": ((108, 98, 14), (130, 132, 0)),
    "footprints": ((117, 88.5, 1.6), (119.2, 93, 0)),
}


def write_png(path, picture):
    """8-bit RGB; every row is stored as its difference to the one above (filter 2)."""
    height, width, _ = picture.shape
    above = np.vstack([np.zeros((1, width, 3), np.uint8), picture[:-1]])
    rows = b"".join(b"\2" + row.tobytes() for row in (picture - above))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def read_png(path):
    """What write_png wrote."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        if kind == b"IDAT":
            packed += body
        at += length + 12
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 3 * width)
    assert (rows[:, 0] == 2).all(), f"{path.name}: not written by this test"
    return np.cumsum(rows[:, 1:].reshape(height, width, 3), axis=0, dtype=np.uint8)


def edit(p):
    p.sculpt("raise", [(170, 190), (200, 170), (80, 200)], radius_m=40, strength=14, hardness=0.2)
    p.sculpt("lower", [(60, 110), (75, 120)], radius_m=22, strength=4)
    p.paint([(165, 120), (175, 130), (185, 135)], layer="rock", radius_m=12)
    p.paint([(90, 150)], layer="sand", radius_m=18)
    p.paint([(150, 160)], tint=(0.8, 0.45, 0.3), radius_m=14, strength=0.8)
    p.crater(130, 132, radius_m=14, seed=7)
    p.crater(118, 112, radius_m=4, seed=8)
    p.footprints([(117.5 + 0.22 * i, 89 + 0.68 * i, 0.3) for i in range(9)], seed=3)


def render(p, view):
    (ex, ey, above), (tx, ty, up) = VIEWS[view]
    camera = loam.Camera.look_at((ex, ey, p.height(ex, ey) + above), (tx, ty, p.height(tx, ty) + up))
    picture = p.render(camera, size=SIZE)
    assert p.stats()["settled"], view
    return np.ascontiguousarray(picture[..., :3])


def difference_of(picture, golden):
    """Mean and 99.9 percentile of the absolute difference over all channels, in 1/255."""
    difference = np.abs(picture.astype(int) - golden)
    return difference.mean(), np.percentile(difference, 99.9)


def is_close(picture, golden):
    mean, percentile = difference_of(picture, golden)
    return mean <= MEAN_LIMIT and percentile <= PERCENTILE_LIMIT


@pytest.fixture(scope="module")
def pictures(plain_template, tmp_path_factory, has_device):  # noqa: F811
    """Of every view: the picture before and after the edits."""
    import shutil
    path = tmp_path_factory.mktemp("golden") / "plain"
    shutil.copytree(plain_template, path)
    with loam.open(str(path)) as p:
        before = {view: render(p, view) for view in VIEWS}
        edit(p)
        return {view: (before[view], render(p, view)) for view in VIEWS}


@pytest.mark.parametrize("view", VIEWS)
def test_picture_is_the_golden_one(view, pictures):
    picture, file = pictures[view][1], HERE / f"{view}.png"
    if BLESS:
        write_png(file, picture)
    assert file.stat().st_size <= MOST_BYTES
    golden = read_png(file)
    mean, percentile = difference_of(picture, golden)
    print(f"{view}: mean {mean:.3f}, 99.9 percentile {percentile:.1f} of 255, {file.stat().st_size} bytes")
    if not is_close(picture, golden):
        FAILED.mkdir(parents=True, exist_ok=True)
        write_png(FAILED / f"{view}.png", picture)
        write_png(FAILED / f"{view}_golden.png", golden)
        write_png(FAILED / f"{view}_difference.png", np.clip(np.abs(picture.astype(int) - golden) * 8, 0, 255).astype(np.uint8))
        pytest.fail(f"{view}: mean difference {mean:.3f} (limit {MEAN_LIMIT}), 99.9 percentile {percentile:.1f} (limit "
                    f"{PERCENTILE_LIMIT}); see {FAILED}")


@pytest.mark.parametrize("view", VIEWS)
def test_the_unedited_ground_is_told_apart(view, pictures):
    """The tolerance is not so wide that the edits would not be missed."""
    assert not is_close(pictures[view][0], read_png(HERE / f"{view}.png"))
