"""Holes in the ground: seen in the picture, by rays, by queries and by the sun; filled, undone, too many, refused."""
import json

import loam
import numpy as np
import pytest

from conftest import fails_with_one_sentence, run_loam


def look(p, size=(320, 180), side=(-20, -30), up=22, **options):
    z = p.height(128, 128)
    camera = loam.Camera.look_at((128 + side[0], 128 + side[1], z + up), (128, 128, z))
    return np.asarray(p.render(camera=camera, size=size, **options))[..., :3].astype(int)


def changed(a, b, by=8):
    return (np.abs(a - b).max(-1) > by).mean()


def test_a_hole_is_seen_filled_and_undone(plain, has_device):
    with loam.open(str(plain), validation=True) as p:
        start = look(p)
        z = p.height(128, 128)
        p.cutout("cylinder", at=(128, 128, z), half_m=(8, 8, 5))
        open_ = look(p)
        hole = np.abs(open_ - start).max(-1) > 8
        assert 0.02 < hole.mean() < 0.4
        # Around it nothing has changed, and in it there is no ground: the same picture wherever it is cut.
        assert changed(open_[:30], start[:30]) == 0
        assert p.stats()["frame"]["cutouts"]["mixed"] == 4, "it lies where four pages meet"
        assert changed(open_, look(p, reference=True), 60) < 0.01, "the reference shows the same hole"
        p.cutout("brush", dabs=[(128, 128)], radius_m=12, fill=True)
        assert changed(look(p), start) == 0
        p.undo()
        assert changed(look(p), open_) == 0
        p.undo()
        assert changed(look(p), start, 0) == 0
        assert p.count_stale_pages() == 0 and p.validation_messages() == 0


def test_what_is_cut_away_is_the_sky(plain, has_device):
    """Straight down into a box of the whole map: every pixel is the sky, and no patch is drawn."""
    with loam.open(str(plain), validation=True) as p:
        down = loam.Camera.look_at((128, 128.01, 60), (128, 128, 0))
        ground = np.asarray(p.render(camera=down, size=(64, 64)))[..., :3]
        p.cutout("box", at=(128, 128, 0), half_m=(400, 400, 400))
        sky = np.asarray(p.render(camera=down, size=(64, 64)))[..., :3]
        assert changed(sky.astype(int), ground.astype(int)) == 1
        assert p.stats()["frame"]["patches"] == 0 and p.stats()["frame"]["cutouts"]["mixed"] == 0
        assert p.ray_cast((128, 128, 60), (0, 0, -1)) is None
        assert p.validation_messages() == 0


@pytest.mark.parametrize("up", [40, 150])
def test_picture_query_and_ray_agree(plain, has_device, up):
    """Height is one: where a picture from above shows the sky, queries say cut and rays pass; from afar, through coarser
    patches, the same outline."""
    with loam.open(str(plain)) as p:
        rng = np.random.default_rng(5)
        z = p.height(128, 128)
        wide = up / 40
        for form in ("box", "cylinder"):
            p.cutout(form, at=(*(128 + wide * rng.uniform(-13, 13, 2)), z), half_m=(5 * wide, 7 * wide, 9),
                     direction=(0.3, 0.2, -1), roll_rad=0.6)
        corners = [(x, y, z + h) for x in (118, 126) for y in (134, 142) for h in (-4, 4)]
        p.cutout("convex", corners=[(128 + wide * (x - 128), 128 + wide * (y - 128), h) for x, y, h in corners])
        p.cutout("brush", dabs=[(128 + wide * i, 128 - wide * (8 + 2 * np.sin(i))) for i in range(-12, 13)],
                 radius_m=2 * wide)
        camera = loam.Camera.look_at((128, 128, z + up), (128, 128.001, z))
        before = np.asarray(p.render(camera=camera, size=(256, 256), debug="heights"))[..., :3].astype(int)
        p.cutout("box", at=(128, 128, z), half_m=(4000, 4000, 400))
        sky = np.asarray(p.render(camera=camera, size=(256, 256), debug="heights"))[..., :3].astype(int)
        p.undo()
        is_sky = np.abs(before - sky).max(-1) <= 2
        asked = differ = 0
        for row, column in rng.integers(3, 253, (3000, 2)):
            window = is_sky[row - 1:row + 2, column - 1:column + 2]
            if window.min() != window.max():
                continue  # an outline within a pixel
            # The ray of a pixel's middle, from straight above: north is up.
            x = (column + 0.5) / 128 - 1
            y = 1 - (row + 0.5) / 128
            tangent = np.tan(np.radians(57) / 2)
            hit = p.ray_cast((128, 128, z + up), (x * tangent, y * tangent, -1))
            asked += 1
            differ += (hit is None) != is_sky[row, column]
            if hit is not None:
                assert not p.is_cut(hit[0], hit[1])
                assert abs(p.height(hit[0], hit[1]) - hit[2]) < 0.5e-3
        assert asked > 1500 and differ == 0
        assert 0.05 < is_sky.mean() < 0.6


def test_light_falls_through(plain, has_device):
    """A wall with the sun behind it: the hole in the wall is a light spot in its shadow."""
    with loam.open(str(plain)) as p:
        p.set("sun.elevation_rad", 0.45)
        p.set("sun.azimuth_rad", np.pi / 2)
        p.sculpt("raise", [(140, y) for y in range(100, 157, 2)], radius_m=6, strength=6)
        z = p.height(128, 128)

        def seen():
            camera = loam.Camera.look_at((126, 127.9, z + 30), (126, 128, z))
            return np.asarray(p.render(camera=camera, size=(160, 160)))[..., :3].astype(int)

        dark = seen()
        p.cutout("brush", dabs=[(140, 128)], radius_m=7)
        light = seen()
        brighter = (light.sum(-1) - dark.sum(-1)) > 40
        west = brighter[:, :80]
        assert west.mean() > 0.02, "sunlight on the ground west of the wall"


def test_queries_take_arrays_and_off_the_map_nothing_is_cut(plain):
    with loam.open(str(plain)) as p:
        p.cutout("brush", dabs=[(10, 10)], radius_m=4)
        x = np.array([10.0, 30.0, -5.0, np.nan, np.inf, 256.0])
        assert p.is_cut(x, 10.0).tolist() == [True, False, False, False, False, False]
        assert p.is_cut(10, 10)
        (op,) = p.operators()
        assert json.loads(json.dumps(op))["kind"] == "cutout" and op["form"] == "brush"
        with pytest.raises(loam.Error, match="unknown form"):
            p.cutout("ball", at=(0, 0, 0))
        with pytest.raises(loam.Error, match="span no volume"):
            p.cutout("convex", corners=[(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)])
        assert len(p.operators()) == 1


def test_a_script_cuts_and_what_it_says_wrongly_is_one_sentence(plain, tmp_path):
    script = tmp_path / "cut.jsonl"
    script.write_text('{"cmd":"cutout","form":"box","at":[128,128,0],"half_m":[5,5,50]}\n')
    assert run_loam("replay", plain, script).returncode == 0
    with loam.open(str(plain)) as p:
        assert p.is_cut(128, 128) and not p.is_cut(135, 128)
    script.write_text('{"cmd":"cutout","form":"box"}\n')
    assert '"at" is missing' in fails_with_one_sentence(run_loam("replay", plain, script))


def test_more_pages_than_there_is_room_for(tmp_path, has_device):
    path = tmp_path / "wide"
    loam.new(str(path), recipe="plain", size_m=1280, seed=3, layer_size=64)
    with loam.open(str(path), validation=True) as p:
        spacing = 64  # metres: a hole in every page of a metre's map
        p.cutout("brush", dabs=[(x, y) for x in range(32, 1280, spacing) for y in range(32, 1280, spacing)], radius_m=6)
        z = p.height(640, 640)
        camera = loam.Camera.look_at((640, 560, z + 60), (640, 640, z))
        first = np.asarray(p.render(camera=camera, size=(320, 180)))
        counts = p.stats()["frame"]["cutouts"]
        assert counts["stale"] == 0
        assert counts["not_shown"] == max(0, counts["mixed"] - 254)
        far = loam.Camera.look_at((40, 40, z + 60), (90, 90, z))
        p.render(camera=far, size=(320, 180))
        again = np.asarray(p.render(camera=camera, size=(320, 180)))
        assert (first == again).all(), "a picture does not depend on where the camera was"
        memory = p.stats()["frame"]["memory_bytes"]["cutout pages (GPU)"]
        assert 0 < memory <= 150_000 + 4096
        assert p.count_stale_pages() == 0 and p.validation_messages() == 0
