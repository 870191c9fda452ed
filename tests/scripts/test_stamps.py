"""Stamps: pictures laid on the ground as height, layer and colour, by the program and from Python."""
import json
import math

import loam
import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam
from PIL import Image


def cubic(row, u):
    """Catmull-Rom through the texels of a row of numbers, its ends repeated; u: 0 ... 1."""
    texel = u * len(row) - 0.5
    first = math.floor(texel)
    t = texel - first
    weights = (((-0.5 * t + 1) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1, ((-1.5 * t + 2) * t + 0.5) * t,
               (0.5 * t - 0.5) * t * t)
    return sum(w * row[min(max(first + i - 1, 0), len(row) - 1)] for i, w in enumerate(weights))


@pytest.fixture
def hill(tmp_path):
    """A 16-bit picture of 40 x 32 texels: a cone, black at the edges."""
    y, x = np.mgrid[0:32, 0:40]
    level = np.clip(1 - np.hypot((x - 19.5) / 19, (y - 15.5) / 15), 0, 1)
    file = tmp_path / "hill.png"
    Image.fromarray((level * 65535).astype(np.uint16)).save(file)
    return file


def test_a_stamp_is_the_picture_at_every_place(plain, hill):
    made = run_loam("stamp", plain, hill, "--json")
    assert made.returncode == 0, made.stderr
    assert json.loads(made.stdout) == {"name": "hill", "width": 40, "height": 32, "colours": False, "cover": False,
                                       "black": 0, "white": 65535, "notes": []}
    texels = np.asarray(Image.open(hill)).astype(float)[::-1] / 65535  # rows from the south
    with loam.open(str(plain)) as p:
        start = p.digest()
        assert p.stamps() == ["hill"]
        rng = np.random.default_rng(1)
        x, y = rng.uniform(60, 200, 400), rng.uniform(60, 200, 400)
        before = p.height(x, y)
        heading, half = 0.8, (50.0, 30.0)
        p.stamp("hill", 128, 120, half_m=half, heading_rad=heading, height_m=25, edge=0)
        after = p.height(x, y)
        across = ((x - 128) * math.cos(heading) - (y - 120) * math.sin(heading)) / half[0] / 2 + 0.5
        along = ((x - 128) * math.sin(heading) + (y - 120) * math.cos(heading)) / half[1] / 2 + 0.5
        inside = 0
        for i in range(len(x)):
            u, v = across[i], along[i]
            # Away from the edge, where the ground jumps.
            if min(u, v) < -0.05 or max(u, v) > 1.05:
                assert after[i] == before[i]
            elif min(u, v) > 0.05 and max(u, v) < 0.95:
                level = min(max(cubic([cubic(row, u) for row in texels], v), 0), 1)
                assert abs(after[i] - before[i] - 25 * level) < 0.02, (u, v)  # heights between samples of the map
                inside += 1
        assert inside > 80
        p.undo()
        assert p.digest() == start and (p.height(x, y) == before).all()
    assert loam.verify(str(plain)) == []


def test_modes_layer_and_colour(plain, tmp_path):
    Image.new("RGB", (8, 8), (255, 128, 64)).save(tmp_path / "orange.png")
    half = np.zeros((8, 8, 4), np.uint8)
    half[:, :, :3] = 255
    half[:, 4:, 3] = 255  # the east half is there
    Image.fromarray(half).save(tmp_path / "half.png")
    with loam.open(str(plain)) as p:
        assert p.add_stamp(str(tmp_path / "orange.png"))["colours"]
        assert p.add_stamp(str(tmp_path / "half.png"), name="east")["cover"]
        ground = float(p.height(128, 128))
        p.stamp("east", 128, 128, half_m=[20, 20], mode="blend", base_m=ground - 5, height_m=2, edge=0)
        assert float(p.height(118, 128)) == pytest.approx(float(ground), abs=0.5)
        assert float(p.height(140, 128)) == pytest.approx(ground - 3, abs=1e-3)
        before = p.layer(60, 60), p.layer(60, 90)
        assert 2 not in before
        p.stamp("orange", 60, 60, half_m=[10, 10], height_m=0, layer=p.layers[2], layer_from=0.2, colour=True, edge=0)
        p.stamp("orange", 60, 90, half_m=[10, 10], height_m=0, layer=p.layers[2], layer_from=0.9, edge=0)
        assert p.layer(60, 60) == 2 and p.layer(60, 90) == before[1]  # 0.9 is brighter than the picture
        # Moved, and taken away.
        stamp = next(op for op in p.operators() if op["kind"] == "stamp" and op["image"] == "east")
        p.edit_operator(stamp["id"], x=200.0)
        assert float(p.height(140, 128)) == pytest.approx(ground, abs=0.5)
        for op in p.operators():
            p.remove_operator(op["id"])
        assert (p.layer(60, 60), p.layer(60, 90)) == before


@pytest.mark.usefixtures("has_device")
def test_colours_of_a_stamp_are_seen(plain, tmp_path):
    Image.new("RGB", (8, 8), (255, 128, 64)).save(tmp_path / "orange.png")
    above, size = (60, 60, 40, 0, -90), (160, 90)
    with loam.open(str(plain), validation=True) as p:
        p.add_stamp(str(tmp_path / "orange.png"))
        bare = p.render(above, size=size)[40:50, 75:85, :3].mean(axis=(0, 1))
        p.stamp("orange", 60, 60, half_m=[10, 10], height_m=0, colour=True)
        stamped = p.render(above, size=size)[40:50, 75:85, :3].mean(axis=(0, 1))
        assert stamped[2] / stamped[0] < 0.6 * bare[2] / bare[0]
        assert p.count_stale_pages() == 0 and p.validation_messages() == 0


def test_pictures_that_are_odd(plain, tmp_path):
    floats = np.linspace(-3, 5, 64, dtype=np.float32).reshape(8, 8)
    floats[2, 2] = np.nan
    Image.fromarray(floats).save(tmp_path / "floats.tif")
    Image.fromarray(np.zeros((2, 9000), np.uint8)).save(tmp_path / "wide.png")
    Image.fromarray(np.zeros((9000, 1), np.uint8)).save(tmp_path / "tall.png")
    Image.new("L", (1, 1), 128).save(tmp_path / "dot.png")
    (tmp_path / "text.png").write_text("not a picture")
    with loam.open(str(plain)) as p:
        made = p.add_stamp(str(tmp_path / "floats.tif"))
        assert (made["black"], made["white"]) == (-3, 5) and "1 numbers were not finite" in made["notes"][0]
        wide = p.add_stamp(str(tmp_path / "wide.png"))
        assert (wide["width"], wide["height"]) == (2250, 1)
        assert "4096" in wide["notes"][0] and "no relief" in wide["notes"][1]
        assert "1 x 9000 texels made 1 x 2250" in p.add_stamp(str(tmp_path / "tall.png"))["notes"][0]
        ground = float(p.height(128, 128))
        p.add_stamp(str(tmp_path / "dot.png"))
        p.stamp("dot", 128, 128, half_m=[10, 10], height_m=10, edge=0)
        assert float(p.height(128, 128)) == pytest.approx(ground + 10 * 128 / 255, abs=1e-3)
    for words, says in ((("text.png",), "text.png"), (("missing.png",), "missing.png"),
                        (("dot.png",), 'a stamp "dot" already'), (("dot.png", "--name", "../dot"), "is no name of a stamp")):
        sentence = fails_with_one_sentence(run_loam("stamp", plain, tmp_path / words[0], *words[1:]))
        assert says in sentence, sentence


def test_a_picture_that_is_gone_is_said_and_nothing_is_lost(plain, hill):
    with loam.open(str(plain)) as p:
        p.add_stamp(str(hill))
        with pytest.raises(loam.Error, match='unknown stamp "hll" .known: hill'):
            p.stamp("hll", 1, 1)
        for wrong in ({"mode": "melt"}, {"half_m": [0, 1]}, {"height_m": math.nan}, {"edge": 2}, {"layer": "nothing"}):
            with pytest.raises(loam.Error):
                p.stamp("hill", 1, 1, **wrong)
        p.stamp("hill", 128, 128, height_m=12)
        with_stamp = float(p.height(128, 128))
    file = plain / "stamps" / "hill.stamp"
    file.rename(plain / "elsewhere")
    assert any("hill" in fault for fault in loam.verify(str(plain)))
    with loam.open(str(plain)) as p:
        assert float(p.height(128, 128)) < with_stamp - 5
        assert [op["kind"] for op in p.operators()] == ["stamp"]
        p.show_operator(p.operators()[0]["id"], False)  # it can still be handled
        p.undo()
    (plain / "elsewhere").rename(file)
    with loam.open(str(plain)) as p:
        assert float(p.height(128, 128)) == with_stamp
    assert loam.verify(str(plain)) == []
