"""Parallax: what lies under the surface of layers that ask for depth."""

import loam
import numpy as np
import pytest
from conftest import fails_with_one_sentence, make_flat, run_loam
from PIL import Image

DEPTH_M = 0.25 * 0.5  # where the channel is 1, and of a reveal map of a half


@pytest.fixture
def ice(plain_template, tmp_path):
    """A flat map of one layer that is half as deep everywhere as its amount says: an even displacement is the middle."""
    path = tmp_path / "ice"
    make_flat(plain_template, path, 256)
    folder = tmp_path / "Slab"
    folder.mkdir()
    random = np.random.default_rng(5)
    spots = random.integers(0, 2, (32, 32)) * 130 + 60
    colour = np.kron(spots, np.ones((8, 8))).astype(np.uint8)
    Image.fromarray(colour).convert("RGB").save(folder / "Slab_Color.png")
    Image.fromarray(np.zeros((256, 256), np.uint8)).save(folder / "Slab_Displacement.png")
    added = run_loam("layer", "add", path, folder, "--name", "slab", "--tile", 4)
    assert added.returncode == 0, added.stderr
    with loam.open(str(path)) as p:
        p.fill(layer="slab")
    return path


def choose(path, amount, channels='["depth"]'):
    lines = [line for line in (path / "project.toml").read_text().splitlines()
             if line != "[texture]" and not line.startswith("channels =")]
    (path / "project.toml").write_text("\n".join(lines + ["[texture]", f"channels = {channels}", ""]))
    if amount is not None:
        assert run_loam("set", path, "layer.slab.depth", amount).returncode == 0


def look(path, up_m=0.0, side=(0.0, 3.0), size=(320, 180)):
    with loam.open(str(path), read_only=True) as p:
        z = float(p.height(128, 128))
        camera = loam.Camera.look_at((128, 128, z + 2 + up_m), (128 + side[0], 128 + side[1], z + up_m))
        return np.asarray(p.render(camera=camera, size=size))[..., :3].astype(int)


def error(a, b):
    return float(np.abs(a - b)[60:].mean())  # not where the ground is so far that footprints differ


def test_an_even_depth_is_a_lower_plane(ice, has_device):
    """The same material seen from so much higher: a closed form, sideways too."""
    for side in ((0.0, 3.0), (2.5, 1.0)):
        choose(ice, 0)
        plain, higher = look(ice, 0.0, side), look(ice, 0.8 * DEPTH_M, side)
        choose(ice, 0.8)
        deep = look(ice, 0.0, side)
        assert error(deep, plain) > 10, "it is another picture"
        assert error(deep, higher) < 1.0, ("that of the plane below", error(deep, higher))


def test_straight_down_nothing_moves_and_without_amounts_nothing_is_searched(ice, has_device):
    choose(ice, 0)
    plain = look(ice, side=(0.0, 0.001))
    choose(ice, 1)
    below = look(ice, side=(0.0, 0.001))
    middle = np.s_[85:95, 155:165]
    assert np.abs(plain[middle] - below[middle]).mean() < 3
    choose(ice, 0, "[]")
    bare = look(ice)
    choose(ice, 0)
    assert (look(ice) == bare).all()


def test_live_amounts_and_what_covers_them(ice, has_device):
    choose(ice, 0)
    with loam.open(str(ice)) as p:
        z = float(p.height(128, 128))
        camera = loam.Camera.look_at((128, 128, z + 2), (128, 131, z))

        def seen():
            return np.asarray(p.render(camera=camera, size=(320, 180)))[..., :3].astype(int)

        plain = seen()
        p.set("layer.slab.depth", "0.8")
        deep = seen()
        assert error(deep, plain) > 10
        p.paint([(128, 132)], layer=p.layers[0], radius_m=20)  # it asks for no depth
        painted = seen()
        p.set("layer.slab.depth", "0")
        assert error(seen(), painted) == 0
        p.undo()
        assert error(seen(), plain) < 0.2
        for name, value, sentence in (("layer.slab.depth", "2", "depth"), ("layer.slab.depth", "deep", "must be a number"),
                                      ("layer.slob.depth", "1", "no layer \"slob\""), ("layer.slab", "1", "no setting"),
                                      ("layer.slab.colour", "1", "known: tile_m, softness, scattering")):
            with pytest.raises(loam.Error, match=sentence):
                p.set(name, value)


def test_five_channels_are_refused(ice):
    choose(ice, None, '["scattering", "thermal", "emissive", "glint", "depth"]')
    line = fails_with_one_sentence(run_loam("info", ice))
    assert "names 5, pages hold 4" in line
    choose(ice, None, '["deep"]')
    assert "known: scattering, thermal, emissive, glint, depth" in fails_with_one_sentence(run_loam("info", ice))
