"""Terrain decals, splines and volumes on the ground: pages equal their composition from nothing, kinds lie over each other in
their order, a carve is one height everywhere, and taking everything away gives the ground back."""
import math
import random
import shutil

import loam
import numpy as np
import pytest
from conftest import run_loam
from PIL import Image

pytestmark = pytest.mark.usefixtures("has_device")
ABOVE = (128, 128, 40, 0, -90)
SIZE = (160, 90)
RED, GREEN, BLUE = [1, 0, 0], [0, 1, 0], [0, 0, 1]


def random_material(rng, layers):
    material = {"layer": rng.choice(layers + [""]), "colour": [rng.random() for _ in range(3)], "opacity": rng.random(),
                "edge": rng.random(), "rough": rng.random(), "seed": rng.randrange(99)}
    if rng.random() < 0.5:
        names = ("albedo", "normal", "gloss", "metalness", "occlusion")
        material["channels"] = {name: rng.random() for name in names}
    return material


def random_shape(rng, p, layers):
    """A kind and its parameters."""
    side = p.bounds[2]
    x, y = rng.uniform(0, side), rng.uniform(0, side)
    if rng.random() < 0.5:  # where two of the cameras look
        x, y = rng.uniform(110, 146), rng.uniform(110, 146)
    kind = rng.choice(("decal", "spline", "volume", "stamp"))
    half = [rng.choice((-1, 1)) * math.exp(rng.uniform(-2, 3)) for _ in range(2)]
    material = random_material(rng, layers)
    outline = rng.choice(("rectangle", "ellipse"))
    if kind == "decal":
        return kind, {"x": x, "y": y, "half_m": half, "heading_rad": rng.uniform(-4, 4), "outline": outline,
                      "displacement_m": rng.choice((0, rng.uniform(-1, 1))), **material}
    if kind == "volume":
        return kind, {"at": [x, y, float(p.height(x, y)) + rng.uniform(-1, 1)], "half_m": half + [rng.uniform(0.5, 9)],
                      "direction": [rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, -0.1)],
                      "roll_rad": rng.uniform(-4, 4), "outline": outline, **material}
    if kind == "stamp":
        return kind, {"image": rng.choice(p.stamps()), "x": x, "y": y, "half_m": half, "heading_rad": rng.uniform(-4, 4),
                      "mode": rng.choice(("add", "max", "min", "blend")), "height_m": rng.uniform(-6, 6),
                      "base_m": float(p.height(x, y)), "strength": rng.random(), "edge": rng.choice((0, rng.random())),
                      "layer": rng.choice(layers + [""]), "layer_from": rng.random(), "colour": rng.random() < 0.5}
    points = [[x + rng.uniform(-40, 40), y + rng.uniform(-40, 40), rng.uniform(-3, 8), rng.uniform(0.2, 8)]
              for _ in range(rng.choice((4, 7)))]
    return kind, {"points": points, "carve": rng.choice((0, rng.random())), "shoulder_m": rng.uniform(0, 6),
                  "fade_m": rng.choice((0, rng.uniform(0, 20))), **material}


def random_command(rng, p, layers):
    ids = [op["id"] for op in p.operators()]
    kind = rng.random()
    if kind < 0.08 and p.can_undo:
        return {"cmd": "undo"}
    if kind < 0.12 and p.can_redo:
        return {"cmd": "redo"}
    if ids and kind < 0.5:
        one = rng.choice(ids)
        if kind < 0.2:
            return {"cmd": "remove", "id": one}
        if kind < 0.3:
            return {"cmd": "operator", "id": one, "enabled": rng.random() < 0.5}
        if kind < 0.4:
            return {"cmd": "reorder", "id": one, "order": rng.randrange(30)}
        name, shape = random_shape(rng, p, layers)
        return {"cmd": "edit", "id": one, "kind": name, **shape}
    x, y = rng.uniform(100, 156), rng.uniform(100, 156)
    if kind < 0.6:  # the ground moves under volumes
        return {"cmd": "sculpt", "mode": rng.choice(("raise", "lower", "smooth")), "dabs": [[x, y]],
                "radius_m": rng.uniform(0.5, 20), "strength": rng.random()}
    if kind < 0.68:
        return {"cmd": "crater", "x": x, "y": y, "radius_m": rng.uniform(0.5, 9), "seed": rng.randrange(99)}
    name, shape = random_shape(rng, p, layers)
    return {"cmd": name, **shape}


@pytest.fixture
def plain(plain, tmp_path):
    """With two stamps: grey, and with colours and cover."""
    rng = np.random.default_rng(5)
    Image.fromarray(rng.integers(0, 256, (24, 16), np.uint8)).save(tmp_path / "grey.png")
    Image.fromarray(rng.integers(0, 256, (9, 40, 4), np.uint8)).save(tmp_path / "colours.png")
    for name in ("grey", "colours"):
        assert run_loam("stamp", plain, tmp_path / f"{name}.png").returncode == 0
    return plain


def test_random_edits_of_every_kind_leave_no_stale_page_and_undo_to_the_start(plain):
    rng = random.Random(4)
    cameras = [(128, 60, 40, 0, -30), (128, 128, 12, 45, -60), (128, 128, 300, 0, -89), (236, 236, 5, 225, -20)]
    with loam.open(str(plain), validation=True) as p:
        original = p.digest()
        p.step(cameras[0], 6, size=SIZE)
        for i in range(500):
            p.apply(random_command(rng, p, p.layers))
            if i % 3 == 0:
                p.step(cameras[(i // 60) % len(cameras)], 1, size=SIZE)
            if i % 100 == 99:
                p.render(cameras[(i // 60) % len(cameras)], size=SIZE)
                assert p.count_stale_pages() == 0, f"after {i + 1} commands"
        assert {op["kind"] for op in p.operators()} >= {"decal", "spline", "volume", "stamp"}
        while p.can_undo:
            p.undo()
        assert p.digest() == original
        p.render(cameras[1], size=SIZE)
        assert p.count_stale_pages() == 0
        assert p.validation_messages() == 0
    assert loam.verify(str(plain)) == []


def test_taking_everything_away_gives_the_ground_back(plain):
    rng = random.Random(9)
    with loam.open(str(plain), validation=True) as p:
        bare = p.render(ABOVE, size=SIZE)
        heights = p.height(np.linspace(90, 160, 500), np.linspace(100, 150, 500))
        for _ in range(20):
            name, shape = random_shape(rng, p, p.layers)
            p.apply({"cmd": name, **shape})
        assert (p.render(ABOVE, size=SIZE) != bare).any()
        for op in p.operators():
            p.remove_operator(op["id"])
        assert (p.render(ABOVE, size=SIZE) == bare).all()
        assert (p.height(np.linspace(90, 160, 500), np.linspace(100, 150, 500)) == heights).all()
        assert p.count_stale_pages() == 0


def colour_at_middle(p):
    """Which of red, green and blue the picture's middle is."""
    picture = p.render(ABOVE, size=SIZE)[40:50, 70:90, :3].mean(axis=(0, 1))
    return "rgb"[int(picture.argmax())]


def test_kinds_lie_over_each_other_in_their_order_and_within_one_in_the_users(plain):
    flat = {"edge": 0.05, "opacity": 1}
    with loam.open(str(plain)) as p:
        ground = float(p.height(128, 128))
        # Added in the opposite order: what counts is the kind.
        p.volume((128, 128, ground), half_m=[4, 4, 8], colour=BLUE, **flat)
        assert colour_at_middle(p) == "b"
        p.decal(128, 128, half_m=[6, 6], colour=GREEN, **flat)
        p.spline([[100, 128], [118, 128], [138, 128], [156, 128]], width_m=14, colour=RED, **flat)
        assert colour_at_middle(p) == "b"
        p.show_operator(1, False)
        assert colour_at_middle(p) == "g"
        p.show_operator(2, False)
        assert colour_at_middle(p) == "r"
        p.show_operator(2)
        p.decal(128, 128, half_m=[6, 6], colour=RED, **flat)
        assert colour_at_middle(p) == "r"
        p.reorder_operator(4, 1)
        assert colour_at_middle(p) == "g"
        p.edit_operator(2, x=60.0)
        assert colour_at_middle(p) == "r"
        p.undo()
        assert colour_at_middle(p) == "g"
        assert p.count_stale_pages() == 0


def test_a_pass_is_recorded_only_when_there_is_something_for_it(plain):
    def passes(p):
        seen = set()
        for _ in range(8):
            p.step(ABOVE, 1, size=SIZE)
            seen |= {row["pass"] for row in p.stats()["frame"]["passes"]}
        return seen & {"texture splines", "texture decals", "texture volumes", "texture compose"}
    with loam.open(str(plain)) as p:
        p.render(ABOVE, size=SIZE)
        p.paint([[128, 128]], layer=p.layers[1])
        assert passes(p) == {"texture compose"}
        p.decal(128, 128)
        assert passes(p) == {"texture compose", "texture decals"}
        p.spline([[100, 128], [118, 128], [138, 128], [156, 128]])
        assert passes(p) == {"texture compose", "texture decals", "texture splines"}
        p.volume((128, 128, float(p.height(128, 128))))
        assert passes(p) == {"texture compose", "texture decals", "texture splines", "texture volumes"}


def test_a_carved_height_is_one_height(plain):
    rng = np.random.default_rng(2)
    with loam.open(str(plain), validation=True) as p:
        points = p.spline_through([(60, 60, 9), (120, 100, 5), (150, 160, 12), (210, 180, 7)], width_m=8)
        p.spline(points, carve=1, shoulder_m=6, layer=p.layers[1])
        x, y = rng.uniform(50, 220, 2000), rng.uniform(50, 200, 2000)
        asked = p.height(x, y)
        hits = [p.ray_cast((a, b, 200), (0, 0, -1))[2] for a, b in zip(x, y)]
        assert np.abs(asked - hits).max() < 5e-4
        # On the middle line the ground is the profile, to the flatness of the path and the samples' spacing.
        assert abs(float(p.height(120, 100)) - 5) < 0.1
        # Reversed infinite depth is near / distance: the ratio of two is that of the distances of two rays.
        depths, distances = [], []
        for eye, to in (((120, 80, 40), (120, 100, 5)), ((150, 130, 60), (150, 160, 12))):
            camera = loam.Camera.look_at(eye, to, 30)
            p.render(camera, size=(161, 91))
            depth = p.ground_buffers(camera, size=(161, 91))["depth"]
            if depth is None:
                pytest.skip("depth is not read back as floats on this device")
            depths.append(float(depth[45, 80]))
            hit = p.ray_cast(eye, np.subtract(to, eye))
            distances.append(float(np.linalg.norm(np.subtract(hit, eye))))
        assert depths[0] / depths[1] == pytest.approx(distances[1] / distances[0], rel=2e-3)
        assert p.count_stale_pages() == 0
        assert p.validation_messages() == 0


def test_the_reference_draws_the_same_decals(plain):
    with loam.open(str(plain), validation=True) as p:
        ground = float(p.height(128, 128))
        bare = p.render(ABOVE, size=SIZE, reference=True).astype(int)
        p.spline([[90, 120], [110, 150], [140, 100], [170, 140]], width_m=6, layer=p.layers[1], edge=0.4)
        p.decal(120, 132, half_m=[5, -3], heading_rad=0.7, colour=[0.9, 0.2, 0.1], rough=0.5,
                channels={"albedo": 0.8, "normal": 0.1, "gloss": 1, "metalness": 0, "occlusion": 0.5})
        p.volume((138, 124, ground), half_m=[4, 4, 6], direction=[0.4, 0.2, -1], outline="ellipse", colour=[0.1, 0.3, 0.9])
        cached = p.render(ABOVE, size=SIZE, supersample=2).astype(int)[..., :3]
        exact = p.render(ABOVE, size=SIZE, reference=True).astype(int)[..., :3]
        changed = np.abs(exact - bare[..., :3]).mean()
        assert changed > 4
        assert np.abs(cached - exact).mean() < 0.25 * changed
        assert p.validation_messages() == 0


def test_replayed_scripts_and_bad_decals(plain, tmp_path):
    fresh = shutil.copytree(plain, tmp_path / "fresh")
    with loam.open(str(plain)) as p:
        p.record_to(str(tmp_path / "script.jsonl"))
        p.decal(10, 20, layer=p.layers[0])
        p.spline([[0, 0, 1], [50, 10, 2], [90, 40, 3], [120, 90, 4]], carve=1, width_m=3.3)
        p.edit_operator(1, half_m=[0.1 + 0.2, 7], heading_rad=1 / 3)
        with pytest.raises(loam.Error, match="unknown layer"):
            p.edit_operator(1, layer="lava")
        with pytest.raises(loam.Error, match="no operator 9"):
            p.edit_operator(9, x=1.0)
        with pytest.raises(loam.Error, match="one place"):
            p.spline([[5, 5]] * 4)
        digest = p.digest()
    assert run_loam("replay", fresh, tmp_path / "script.jsonl").returncode == 0
    with loam.open(str(fresh)) as p:
        assert p.digest() == digest
    assert loam.verify(str(fresh)) == []


def test_a_layer_that_shares_its_file_is_laid_and_a_transition_is_refused(plain):
    toml = plain / "project.toml"
    text = toml.read_text()
    with loam.open(str(plain)) as p:
        dirt = p.layers[1]
    entry = next(part for part in text.split("[[layer]]")[1:] if f'"{dirt}"' in part).split("\n[")[0]
    toml.write_text(text.rstrip() + "\n\n[[layer]]" + entry.replace(f'name = "{dirt}"', 'name = "twin"').rstrip() + "\n")
    with loam.open(str(plain)) as p:
        assert p.layers[-1] == "twin"
        bare = p.render(ABOVE, size=SIZE)
        p.decal(128, 128, half_m=[6, 6], layer=dirt)
        laid = p.render(ABOVE, size=SIZE)
        assert (laid != bare).any()
        p.edit_operator(1, layer=p.layers[2])
        assert (p.render(ABOVE, size=SIZE) != laid).any()
        p.edit_operator(1, layer="twin")
        assert (p.render(ABOVE, size=SIZE) == laid).all(), "the same textures by another name"
        p.transition("edge", p.layers[0], dirt)
        with pytest.raises(loam.Error, match=f'"edge" is a transition without one: name a layer, such as "{dirt}"'):
            p.edit_operator(1, layer="edge")
        with pytest.raises(loam.Error, match="is a transition"):
            p.spline([[0, 0], [50, 10], [90, 40], [120, 90]], width_m=3, layer="edge")
        assert (p.render(ABOVE, size=SIZE) == laid).all()


def seen_from_above(p, size, ground, up=60.0):
    """The albedo of the ground around (128, 128) from straight above, and the pixels' x and y on level ground."""
    picture = p.render((128, 128, ground + up, 0, -90, 40), size, debug="albedo").astype(float)
    row, column = np.mgrid[0:size[1], 0:size[0]]
    scale = 2 * up * math.tan(math.radians(20)) / size[1]
    return picture, 128 + (column + 0.5 - size[0] / 2) * scale, 128 - (row + 0.5 - size[1] / 2) * scale


def cover_of_red(before, after):
    """Blended as square roots of linear light, which is what pages keep."""
    return 1 - (after[..., 2] / 255) ** 1.1 / np.maximum((before[..., 2] / 255) ** 1.1, 1e-3)


def test_a_decal_displaces_the_ground_that_it_is_painted_on(plain):
    """Heights are evaluated on the CPU, colours in a shader: the rough edge of both is the same. From straight above, colour over
    colour and height over height are both the decal's cover."""
    size, half, raised = (400, 400), 18.0, 0.05
    flat = dict(half_m=[half, 0.7 * half], heading_rad=0.6, edge=0.4, rough=0.7, seed=5, outline="ellipse")
    with loam.open(str(plain)) as p:
        ground = p.height(128, 128)
        before, x, y = seen_from_above(p, size, ground)
        p.decal(128, 128, colour=RED, displacement_m=raised, **flat)
        after, _, _ = seen_from_above(p, size, ground)
        heights = p.height(x.ravel(), y.ravel()).reshape(x.shape)
        p.undo()
        cover = (heights - p.height(x.ravel(), y.ravel()).reshape(x.shape)) / raised
        assert cover.min() > -1e-3 and cover.max() < 1 + 1e-3
        assert 0.05 < (cover > 0.99).mean() < 0.6 and (cover == 0).mean() > 0.2

        painted = cover_of_red(before, after)
        assert np.abs(painted - cover).mean() < 0.003
        assert np.abs(painted - cover).max() < 0.08, "a metre of the height map lies between its samples"
        p.decal(128, 128, colour=RED, displacement_m=-2, life={"from_s": 0, "rise_s": 10}, **flat)
        p.time_s = 5
        half_way = p.height(128, 128) - ground
        p.time_s = 10
        assert p.height(128, 128) - ground == pytest.approx(-2, abs=1e-3) and -1.9 < half_way < -0.1
        assert p.count_stale_pages() == 0


def test_a_road_is_carved_where_it_is_painted(plain):
    """The carve is a sum over segments on the CPU, the paint one over pieces in a shader."""
    size = (400, 400)
    with loam.open(str(plain)) as p:
        ground = float(p.height(128, 128))
        top = ground + 0.2
        points = [[112, 118, top, 3], [124, 112, top, 5], [126, 140, top, 7], [144, 138, top, 4]]
        before, x, y = seen_from_above(p, size, ground)
        old = p.height(x.ravel(), y.ravel()).reshape(x.shape)
        p.spline(points, carve=1, shoulder_m=0, edge=0, colour=RED)
        after, _, _ = seen_from_above(p, size, ground)
        carved = (p.height(x.ravel(), y.ravel()).reshape(x.shape) - old) / (top - old)
        painted = cover_of_red(before, after)
        inside, outside = carved > 0.999, np.abs(carved) < 1e-3
        assert inside.sum() > 5000 and outside.sum() > 50000
        # A pixel's filter is as wide as two; what lies between is no wider than the height map's samples are apart.
        assert (painted[inside] < 0.5).mean() < 0.005 and (painted[outside] > 0.5).mean() < 0.005
        assert painted[inside].min() > 0.2 and painted[outside].max() < 0.8
        assert (~inside & ~outside).sum() < 0.5 * inside.sum()


def test_a_volume_paints_the_ground_in_its_box(plain):
    """By plain arithmetic on the composed heights; any direction, rolled, mirrored."""
    size = (400, 400)
    with loam.open(str(plain)) as p:
        ground = float(p.height(128, 128))
        before, x, y = seen_from_above(p, size, ground)
        z = p.height(x.ravel(), y.ravel()).reshape(x.shape)
        for direction, roll, half in (((0, 0, -1), 0.4, [9, 5, 2]), ((0.5, 0.2, -1), -1.1, [-8, 6, 3]), ((1, -2, -1.5), 2.5, [6, 9, 4])):
            p.volume([130, 126, ground + 0.3], half_m=half, direction=list(direction), roll_rad=roll, edge=0, deep_edge=1e-4,
                     colour=RED)
            after, _, _ = seen_from_above(p, size, ground)
            p.undo()
            axis_z = -np.array(direction, float) / np.linalg.norm(direction)
            level = math.hypot(axis_z[0], axis_z[1])
            flat = np.array([-axis_z[1], axis_z[0], 0]) / level if level > 1e-9 else np.array([1.0, 0, 0])
            side = np.cross(axis_z, flat)
            axes = (flat * math.cos(roll) + side * math.sin(roll), side * math.cos(roll) - flat * math.sin(roll), axis_z)
            away = np.stack([x - 130, y - 126, z - (ground + 0.3)], axis=-1)
            # How far inside, the nearest side counting; metres.
            inside = np.min([abs(h) - np.abs(away @ axis) for axis, h in zip(axes, half)], axis=0)
            painted = cover_of_red(before, after)
            assert (inside > 0.3).sum() > 4000
            assert painted[inside > 0.3].min() > 0.5, (direction, roll)
            assert painted[inside < -0.3].max() < 0.5, (direction, roll)
