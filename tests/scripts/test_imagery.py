"""Imagery over the map as its far look: from any picture, by the program and from Python."""
import json
import shutil

import loam
import numpy as np
import pytest
from conftest import fails_with_one_sentence, run_loam
from PIL import Image


def seen(p):
    """Straight down on a map of 256 m: the whole of it, north up."""
    camera = loam.Camera.look_at((128, 127.9, 420), (128, 128, 0))
    return np.asarray(p.render(camera=camera, size=(256, 256)))[..., :3].astype(int)


def quarters(size=(400, 400), mode="RGB"):
    """Red, green, blue and grey: north-west, north-east, south-west, south-east."""
    picture = Image.new(mode, size)
    w, h = size[0] // 2, size[1] // 2
    for at, colour in (((0, 0), (200, 20, 20)), ((w, 0), (20, 200, 20)), ((0, h), (20, 20, 200)),
                       ((w, h), (128, 128, 128))):
        picture.paste(colour + ((255,) if mode == "RGBA" else ()), at + (at[0] + w, at[1] + h))
    return picture


def test_every_corner_is_where_the_picture_has_it(plain, tmp_path):
    quarters().save(tmp_path / "map.png")
    made = run_loam("imagery", plain, tmp_path / "map.png", "--distance", 1, "--json")
    assert made.returncode == 0, made.stderr
    facts = json.loads(made.stdout)
    assert facts["file"] == "imagery/map.imagery" and facts["strength"] == 1 and facts["notes"] == []
    assert facts["texel_m"] <= 256 / 400 and (facts["width"], facts["height"]) == (400, 400)
    with loam.open(str(plain)) as p:
        picture = seen(p)
        for y, x, channel in ((90, 90, 0), (90, 165, 1), (165, 90, 2)):
            spot = picture[y - 6:y + 6, x - 6:x + 6].mean(axis=(0, 1))
            assert spot.argmax() == channel and spot[channel] > 2 * np.delete(spot, channel).max(), (x, y, spot)
        grey = picture[159:171, 159:171].mean(axis=(0, 1))
        assert np.ptp(grey) < 0.2 * grey.max()
        # Half strength lies between, none is the picture without; the edits of the ground go on under it.
        p.set("imagery.strength", "0.5")
        half = seen(p)
        p.set("imagery.strength", "0")
        bare = seen(p)
        assert 0 < np.abs(half - bare).mean() < np.abs(picture - bare).mean()
        p.set("imagery.strength", "1")
        assert np.abs(seen(p) - picture).max() <= 1
        p.set("imagery.file", "")
        assert (seen(p) == bare).all()
        p.set("imagery.file", "imagery/map.imagery")
        assert np.abs(seen(p) - picture).max() <= 1
        # What begins farther away than the camera is not seen.
        p.set("imagery.distance_m", "16384")
        assert (seen(p) == bare).all()
        with pytest.raises(loam.Error, match="imagery.distance_m"):
            p.set("imagery.distance_m", "0")


def test_where_it_has_no_cover_the_layers_show(plain, tmp_path):
    picture = quarters(mode="RGBA")
    picture.paste((255, 255, 255, 0), (200, 0, 400, 400))
    picture.save(tmp_path / "half.png")
    with loam.open(str(plain)) as p:
        bare = seen(p)
        facts = p.add_imagery(str(tmp_path / "half.png"), distance_m=1)
        assert facts["notes"] == []
        laid = seen(p)
        assert np.abs(laid[:, 140:] - bare[:, 140:]).max() <= 1
        assert np.abs(laid[70:186, 75:120] - bare[70:186, 75:120]).mean() > 10


def test_pictures_of_every_kind(plain, tmp_path):
    rng = np.random.default_rng(2)
    with loam.open(str(plain)) as p:
        def notes_of(name, image):
            image.save(tmp_path / name)
            return p.add_imagery(str(tmp_path / name))

        assert notes_of("one.png", Image.new("RGB", (1, 1), (9, 90, 9)))["texel_m"] >= 64
        assert "in grey" in notes_of("grey.png", Image.fromarray(rng.integers(0, 255, (37, 37), dtype=np.uint8)))["notes"][0]
        assert "stretched" in notes_of("wide.jpg", quarters((400, 100)))["notes"][0]
        dark = Image.fromarray(rng.integers(0, 900, (64, 64), dtype=np.uint16))
        assert any("stretch its contrast" in n for n in notes_of("dark.png", dark)["notes"])
        # A name that is taken gets a number; the one before stays.
        assert notes_of("one.png", Image.new("RGB", (3, 5)))["file"] == "imagery/one-2.imagery"
        assert p.render(size=(64, 36)) is not None
    assert run_loam("verify", plain).returncode == 0


def test_bad_input_is_one_sentence(plain, tmp_path):
    quarters().save(tmp_path / "map.png")
    whole = (tmp_path / "map.png").read_bytes()
    (tmp_path / "cut.png").write_bytes(whole[:len(whole) // 2])
    (tmp_path / "text.png").write_text("no picture")
    Image.new("CMYK", (8, 8)).save(tmp_path / "ink.tif")
    before = (plain / "project.toml").read_text()
    for name, said in (("nowhere.png", "does not exist"), ("cut.png", "cut short"), ("text.png", "text file"),
                       ("ink.tif", "inks")):
        sentence = fails_with_one_sentence(run_loam("imagery", plain, tmp_path / name))
        assert name in sentence and said in sentence
    for arguments, said in ((("imagery", plain, tmp_path / "map.png", "--strength", 2), "imagery.strength is 2"),
                            (("set", plain, "imagery.file", "../map.png"), "outside the project"),
                            (("set", plain, "imagery.file", "imagery/nowhere.imagery"), "nowhere.imagery cannot be read")):
        assert said in fails_with_one_sentence(run_loam(*arguments))
    assert (plain / "project.toml").read_text() == before
    assert not list((plain / "imagery").glob("*"))


def test_a_project_without_its_imagery_opens(plain, tmp_path):
    quarters().save(tmp_path / "map.png")
    with loam.open(str(plain)) as p:
        bare = seen(p)
        p.add_imagery(str(tmp_path / "map.png"), distance_m=1)
        laid = seen(p)
    file = plain / "imagery" / "map.imagery"
    shutil.move(file, tmp_path)
    with loam.open(str(plain)) as p:
        assert np.abs(seen(p) - bare).max() <= 1
    verified = run_loam("verify", plain)
    assert verified.returncode == 1 and "map.imagery cannot be read" in verified.stdout + verified.stderr
    damaged = bytearray((tmp_path / "map.imagery").read_bytes())
    damaged[200] ^= 1
    file.write_bytes(damaged)
    verified = run_loam("verify", plain)
    assert verified.returncode == 1 and "damaged" in verified.stdout + verified.stderr
    shutil.move(tmp_path / "map.imagery", file)
    with loam.open(str(plain)) as p:
        assert (seen(p) == laid).all()
