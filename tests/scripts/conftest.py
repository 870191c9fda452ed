"""Shared by the script tests: a small project to copy, the program, pictures of heights to import."""
import os
import shutil
import subprocess
from pathlib import Path

import loam
import numpy as np
import pytest

SOURCE = Path(os.environ.get("LOAM_SOURCE_DIR", Path(__file__).resolve().parents[2]))
DEM = SOURCE.parent / "shared" / "data" / "dem"


def run_loam(*words, **options):
    """Runs the program; returns the finished process with its texts."""
    program = os.environ.get("LOAM_PROGRAM", str(SOURCE / "build" / "release" / "bin" / "loam"))
    return subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=300, **options)


def fails_with_one_sentence(process):
    """A failure is a non-zero exit and one line that begins with "loam: VERB: "."""
    assert process.returncode in (1, 2), (process.returncode, process.stdout, process.stderr)
    lines = [line for line in process.stderr.splitlines() if line and "%" not in line]
    assert len(lines) == 1, process.stderr
    assert lines[0].startswith("loam: "), lines[0]
    assert not lines[0].endswith("."), lines[0]
    return lines[0]


@pytest.fixture(scope="session")
def plain_template(tmp_path_factory):
    """A plain of 256 m with small layers, made once."""
    path = tmp_path_factory.mktemp("template") / "plain"
    loam.new(str(path), recipe="plain", size_m=256, seed=3, layer_size=64)
    return path


@pytest.fixture
def plain(plain_template, tmp_path):
    """A fresh copy of the plain."""
    path = tmp_path / "plain"
    shutil.copytree(plain_template, path)
    return path


@pytest.fixture(scope="session")
def has_device(plain_template):
    """Rendering needs a Vulkan device: without one the test is skipped, and says so."""
    with loam.open(str(plain_template), read_only=True) as project:
        try:
            project.step(n=1, size=(64, 36))
        except loam.Error as problem:
            if "device" in str(problem).lower():
                pytest.skip(f"no Vulkan device: {problem}")
            raise


def oiio(*words):
    """oiiotool writes pictures independently of the program under test."""
    tool = shutil.which("oiiotool")
    if not tool:
        pytest.skip("oiiotool is not installed")
    subprocess.run([tool, *map(str, words)], check=True, capture_output=True)


def write_png16(path, samples):
    """A 16-bit grey PNG from an array, row 0 at the top; written by hand with zlib."""
    import struct
    import zlib
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in np.asarray(samples))
    height, width = np.asarray(samples).shape

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)
    Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_tiff_float(path, samples):
    """An uncompressed 32-bit float TIFF from an array, row 0 at the top."""
    import struct
    data = np.asarray(samples, dtype="<f4")
    height, width = data.shape
    tags = [(256, 4, width), (257, 4, height), (258, 3, 32), (259, 3, 1), (262, 3, 1), (273, 4, 8), (277, 3, 1),
            (278, 4, height), (279, 4, data.nbytes), (339, 3, 3)]
    directory = struct.pack("<H", len(tags))
    for tag, kind, value in tags:
        directory += struct.pack("<HHI", tag, kind, 1) + (struct.pack("<HH", value, 0) if kind == 3 else struct.pack("<I", value))
    Path(path).write_bytes(struct.pack("<2sHI", b"II", 42, 8 + data.nbytes) + data.tobytes() + directory + struct.pack("<I", 0))


def read_png16(path):
    """Samples of a 16-bit grey PNG, through Pillow where it is, else skipped."""
    image = pytest.importorskip("PIL.Image")
    return np.asarray(image.open(path)).astype(np.int64)


def make_flat(template, path, side_m, height_m=100.0):
    """A flat, empty map of any size with the layers of `template`. All of them repeat in a whole share of 64 m."""
    import re
    import sqlite3
    shutil.copytree(template, path)
    project = (path / "project.toml").read_text()
    spacing_m = float(re.search(r"height_spacing_m = ([\d.]+)", project)[1])
    samples, height_mm = int(side_m / spacing_m) + 1, int(height_m * 1000)
    project = re.sub(r"height_samples = \[.*?\]", f"height_samples = [{samples}, {samples}]", project)
    project = re.sub(r"default_height_mm = \S+", f"default_height_mm = {height_mm}", project)
    (path / "project.toml").write_text(project.replace("tile_m = 3.0", "tile_m = 4.0"))
    database = sqlite3.connect(path / "terrain.db")
    with database:
        database.execute("DELETE FROM page")
        for name, value in (("height_pages", 0), ("index_pages", 0), ("height_samples_x", samples),
                            ("height_samples_y", samples), ("default_height_mm", height_mm)):
            database.execute("UPDATE meta SET value = ? WHERE name = ?", (value, name))
    database.close()
    return path
