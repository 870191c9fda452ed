"""Numbers stay good far from the origin, near the ground, high above it, and at the ends of their range."""
import math

import loam
import numpy as np
import pytest
from conftest import make_flat

SIZE = (320, 180)
MAP_M = 16800.0  # the largest map
FAR_M = 16384.0  # a power of two: pages and sectors of every level have the same phase at both places
PLACE_M = 208.0  # middle of the far corner: FAR_M + 2 * PLACE_M = MAP_M
HEIGHT_LIMIT_M = 16384.0


@pytest.fixture
def large(plain_template, tmp_path):
    return make_flat(plain_template, tmp_path / "large", MAP_M)


def make_scene(p, x, y):
    """Hills, paint, a crater, footprints around (x, y)."""
    rock = p.layers[5]
    p.sculpt("raise", [(x - 40, y + 30), (x + 25, y + 45)], radius_m=45, strength=12, hardness=0.2)
    p.sculpt("lower", [(x + 10, y - 30)], radius_m=30, strength=6)
    # Full hardness: soft rims are dithered by the texel's coordinates on purpose.
    p.paint([(x - 20, y + 10), (x - 10, y + 12)], layer=rock, radius_m=14, hardness=1)
    p.paint([(x + 30, y + 20)], tint=(0.9, 0.5, 0.3), radius_m=20)
    p.crater(x, y, radius_m=12, seed=7)
    p.footprints([(x - 15 + 0.1 * i, y - 25 + 0.7 * i, 0.1) for i in range(8)], seed=3)


# Eyes around the scene, looking down enough to see no border of the map: (east, north, height, yaw, pitch).
VIEWS = [(0, -60, 145, 0, -40), (50, 50, 170, 225, -50), (-14, -26, 102, 10, -50), (0, 0, 240, 0, -90)]


@pytest.mark.usefixtures("has_device")
def test_the_origin_and_the_far_corner_look_the_same(large):
    pictures = {}
    with loam.open(str(large)) as p:
        for offset in (0.0, FAR_M):
            make_scene(p, PLACE_M + offset, PLACE_M + offset)
        x, y = np.random.default_rng(5).uniform(-60, 60, (2, 200))
        near, far = (p.height(PLACE_M + o + x, PLACE_M + o + y) for o in (0.0, FAR_M))
        assert np.ptp(near) > 5
        np.testing.assert_allclose(near, far, atol=1e-4)
    for offset in (0.0, FAR_M):
        with loam.open(str(large), read_only=True) as p:
            pictures[offset] = [p.render((PLACE_M + offset + e, PLACE_M + offset + n, z, yaw, pitch), size=SIZE)
                                for e, n, z, yaw, pitch in VIEWS]
            assert p.stats()["settled"]
    for view, near, far in zip(VIEWS, *pictures.values()):
        difference = np.abs(near.astype(int) - far).max(axis=2)
        equal = (difference <= 1).mean()
        print(f"{view}: {100 * equal:.3f} % within 1/255, largest difference {difference.max()}")
        assert near[..., :3].std() > 5
        assert equal >= 0.999, (view, equal, difference.max())


def error_db(picture, truth):
    return -10 * math.log10(((picture[..., :3].astype(float) - truth[..., :3]) ** 2).mean() / 255 ** 2)


def sharpness(picture):
    """Mean square of the Laplacian of the luma."""
    y = picture[..., :3].astype(float) @ (0.2126, 0.7152, 0.0722)
    return ((4 * y[1:-1, 1:-1] - y[:-2, 1:-1] - y[2:, 1:-1] - y[1:-1, :-2] - y[1:-1, 2:]) ** 2).mean()


@pytest.mark.usefixtures("has_device")
@pytest.mark.parametrize("filter", ["trilinear", "tiles"])
def test_a_drift_of_a_millimetre_is_as_sharp_and_steady_far_away(large, filter):
    """An eye near the ground moves by a millimetre: a fraction of a pixel, and 2^-24 of the map."""
    with loam.open(str(large)) as p:
        for offset in (0.0, FAR_M):
            make_scene(p, PLACE_M + offset, PLACE_M + offset)
    figures = {}
    # The horizon is in row 29: rows from 36 on show the scene alone, not the kilometres beyond it that only one place has.
    scene = slice(36, None)
    for offset in (0.0, FAR_M):
        at = PLACE_M + offset
        with loam.open(str(large), read_only=True) as p:
            pictures, truths = ([p.render((at - 15 + k * 0.001, at - 28, 101.6, 20, -14), size=(192, 108), **how)[scene]
                                 for k in range(3)] for how in ({"filter": filter}, {"reference": True}))
            assert p.stats()["settled"]
        figures[offset] = {
            "error": [error_db(a, b) for a, b in zip(pictures, truths)],
            "sharp": [sharpness(a) / sharpness(b) for a, b in zip(pictures, truths)],
            "step": [np.abs(a.astype(int) - b).mean() for a, b in zip(pictures, pictures[1:])],
            "its own": [np.abs(a.astype(int) - b).mean() for a, b in zip(truths, truths[1:])]}
        print(offset, figures[offset])
    near, far = figures[0.0], figures[FAR_M]
    np.testing.assert_allclose(far["error"], near["error"], atol=0.02)
    np.testing.assert_allclose(far["sharp"], near["sharp"], rtol=0.002)
    # Every step is seen, and none is larger than elsewhere.
    assert min(near["step"] + far["step"]) > 0
    np.testing.assert_allclose(far["step"], near["step"], rtol=0.02)
    np.testing.assert_allclose(far["its own"], near["its own"], rtol=0.02)


# From level ground and from a slope of the crater, where triangles of 2 m lie up to 0.2 m beside the queries' ground.
LEVEL_M = -68.0
EXTREME_VIEWS = [(at, z, pitch) for at in (LEVEL_M, 3.0) for z in (0.01, 1.7, 10_000.0) for pitch in (0.0, -90.0, 90.0, -1.0, -45.0)]


@pytest.mark.usefixtures("has_device")
@pytest.mark.parametrize("corner_m", [PLACE_M, FAR_M + PLACE_M])
def test_no_view_makes_nan_or_infinity(large, corner_m):
    with loam.open(str(large), validation=True) as p:
        make_scene(p, corner_m, corner_m)
        for at, above, pitch in EXTREME_VIEWS:
            x, y = corner_m + at, corner_m + at
            camera = (x, y, p.height(x, y) + above, 30, pitch)
            picture = p.render(camera, size=(160, 90))
            buffers = p.ground_buffers(camera, size=(160, 90))
            assert np.isfinite(buffers["gbuffer"].astype(np.float32)).all(), (at, above, pitch)
            assert buffers["gbuffer"].shape == (90, 160, 4)
            depth = buffers["depth"]
            if depth is not None:
                assert np.isfinite(depth).all() and (depth >= 0).all() and (depth <= 1).all(), (at, above, pitch)
                # Below is ground, above is sky; from 10 km the map's corner ends within the picture.
                if at == LEVEL_M and pitch == -90:
                    assert (depth > 0).any() and (above > 100 or (depth > 0).all()), above
                if at == LEVEL_M and pitch == 90:
                    assert (depth == 0).all(), above
            # A NaN is stored in 8 bits as 0 in every channel; daylight has no such black.
            assert (picture[..., :3].max(axis=2) > 0).all(), (at, above, pitch)
            assert (picture[..., 3] == 255).all()
        assert p.validation_messages() == 0


@pytest.mark.parametrize("mode,limit_m", [("raise", HEIGHT_LIMIT_M), ("lower", -HEIGHT_LIMIT_M)])
def test_heights_saturate_rather_than_wrap(plain, mode, limit_m):
    """10,000 dabs at one spot, more than enough to pass the limit of the millimetres and of 32 bits."""
    at = (128, 128)
    with loam.open(str(plain)) as p:
        before = p.digest()
        last = p.height(*at)
        for _ in range(10):
            p.sculpt(mode, [at] * 1000, radius_m=3, strength=1000, hardness=0.8)
            now = p.height(*at)
            assert now >= last - 1e-6 if mode == "raise" else now <= last + 1e-6
            last = now
        assert last == pytest.approx(limit_m, abs=0.01)
        assert np.isfinite(p.normal(np.linspace(120, 136, 33), 128.0)).all()
        # A crater over it and its undo leave the ground finite as well.
        p.crater(*at, radius_m=10, seed=1)
        assert abs(p.height(*at)) <= HEIGHT_LIMIT_M + 100
        while p.can_undo:
            p.undo()
        assert p.digest() == before


def test_ten_thousand_raises_as_commands_of_their_own_saturate(plain):
    command = {"cmd": "sculpt", "mode": "raise", "dabs": [[60, 60]], "radius_m": 0.6, "hardness": 1, "strength_m": 5}
    with loam.open(str(plain)) as p:
        for _ in range(10_000):
            p.apply(command)
        assert p.height(60, 60) == pytest.approx(HEIGHT_LIMIT_M, abs=0.01)
        p.undo()
    assert loam.verify(str(plain)) == []


@pytest.mark.parametrize("with_renderer", [False, True])
def test_queries_at_nan_and_outside(plain, with_renderer, request):
    if with_renderer:
        request.getfixturevalue("has_device")
    with loam.open(str(plain), read_only=True) as p:
        if with_renderer:
            p.step((128, 60, 40, 0, -30), 2, size=(64, 36))
        bad = [math.nan, math.inf, -math.inf, 1e300, -1e300, -5.0, 1e9]
        for x in bad:
            for y in (*bad, 128.0):
                assert math.isfinite(p.height(x, y)), (x, y)
                assert np.linalg.norm(p.normal(x, y)) == pytest.approx(1, abs=1e-3), (x, y)
                assert 0 <= p.layer(x, y) < len(p.layers), (x, y)
        assert p.height(-5, 300) == p.height(0, 256)
        assert p.ray_cast((math.nan, 0, 10), (0, 0, -1)) is None
        assert p.ray_cast((128, 128, math.inf), (0, 0, -1)) is None
        assert p.ray_cast((-50, 128, 500), (0, 0, -1)) is None
        assert p.ray_cast((128, 128, 500), (0, 0, -1), math.inf) is not None
        assert p.ray_cast((128, 128, 500), (0, 0, -1), math.nan) is None
