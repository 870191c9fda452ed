"""Events and lives: the time of the map, what games call for their actors, and that the picture, the query and a ray agree."""
import json
import math
import subprocess
import sys

import loam
import numpy as np
import pytest
from conftest import SOURCE, fails_with_one_sentence, run_loam
from PIL import Image

CAMERA = (128, 40, 60, 0, -30)
EVENTS = (
    ("crater", {"x": 100, "y": 120, "energy_j": 4e9, "weather_s": 40, "cool_s": 10}),
    ("crater_line", {"x": 60, "y": 60, "to": (190, 80), "count": 6, "energy_j": 5e8, "duration_s": 4}),
    ("barrage", {"x": 150, "y": 150, "radius_m": 40, "count": 60, "energy_j": 2e8, "duration_s": 10}),
    ("crash", {"x": 60, "y": 170, "to": (140, 200), "width_m": 5, "count": 20}),
    ("landslide", {"x": 180, "y": 100, "radius_m": 15, "volume_m3": 600, "to": (210, 140)}),
    ("flood", {"x": 128, "y": 128, "radius_m": 90, "level_m": 2, "from_m": -5, "duration_s": 8}),
)


def set_off(p):
    for i, (kind, keywords) in enumerate(EVENTS):
        p.event(kind, start_s=2 + i, seed=i, **keywords)


def sampled(p, n=40):
    x, y = np.meshgrid(np.linspace(1, 255, n), np.linspace(1, 255, n))
    return p.height(x, y)


def test_the_time_winds_forward_and_back(plain):
    with loam.open(str(plain)) as p:
        quiet = sampled(p)
        set_off(p)
        assert (sampled(p) == quiet).all(), "nothing has happened yet"
        seen = {}
        for t in (3, 6.5, 9, 20, 60):
            p.time_s = t
            seen[t] = sampled(p)
        assert len({heights.tobytes() for heights in seen.values()}) == 5
        for t in (20, 3, 60, 9, 6.5):
            p.time_s = t
            assert (sampled(p) == seen[t]).all()
        p.time_s = 0
        assert (sampled(p) == quiet).all()
        digest = p.digest()
        p.time_s = 60
        assert p.digest() == digest, "looking at another time changes nothing that is saved"
        with pytest.raises(loam.Error, match="must be a number"):
            p.time_s = math.inf
    with loam.open(str(plain)) as p:
        assert p.time_s == 60, "the project is as it was left"
        for _ in EVENTS:
            p.undo()
        assert (sampled(p) == quiet).all()
    assert loam.verify(str(plain)) == []


def test_every_operator_may_have_a_life(plain):
    with loam.open(str(plain)) as p:
        before = p.height(128, 128)
        p.apply({"cmd": "crater", "x": 128, "y": 128, "radius_m": 10, "depth_m": 4,
                 "life": {"from_s": 10, "rise_s": 16, "until_s": 100, "fade_s": 16}})
        depth = {}
        for t in (9, 10, 18, 26, 90, 100):
            p.time_s = t
            depth[t] = before - p.height(128, 128)
        assert depth[9] == 0 and depth[100] == 0
        assert depth[10] == pytest.approx(depth[26] / 16, rel=0.05)
        assert depth[18] == pytest.approx(depth[26] * 9 / 16, rel=0.05)
        assert 0 < depth[90] < depth[26]
        p.edit_operator(1, radius_m=12)
        assert p.operators()[0]["life"]["from_s"] == 10, "an edit keeps the life"


def test_events_cost_their_parameters(plain):
    with loam.open(str(plain)) as p:
        p.event("crater", x=100, y=100)
        p.event("crater_line", x=10, y=10, to=(200, 200), count=1000)
        p.event("barrage", x=128, y=128, radius_m=100)
        cost = [p.event_cost(i) for i in (1, 2, 3)]
        assert [c["parts"] for c in cost] == [1, 1000, 1200]
        assert max(c["stored_bytes"] for c in cost) < 300


def test_feet_sink_as_deep_as_the_ground_is_soft(plain):
    with loam.open(str(plain)) as p:
        p.fill(rect=(0, 0, 128, 256), layer="snow")
        p.fill(rect=(128, 0, 257, 256), layer="rock")
        before = sampled(p, 2)
        assert p.events.step(1, 0, (60, 60), 0.0) is True
        assert p.events.step(1, 1, (60.2, 60.7), 0.0) is True
        assert p.events.step(1, 0, (200, 60), 0.0) is False, "rock takes no print"
        assert p.events.waiting == 2
        dirt = p.events.flush()
        assert dirt["height"] and p.events.waiting == 0
        prints = p.operators()
        assert [op["foot"] for op in prints] == [0, 1]
        light, heavy = prints[0]["depth_m"], None
        p.set("layer.snow.softness", 0.5)
        p.events.step(2, 0, (70, 60), 0.0)
        p.events.flush()
        assert p.operators()[-1]["depth_m"] == pytest.approx(light / 2)
        p.events.step(2, 0, (80, 60), 0.0, weight_kg=60)
        p.events.flush()
        heavy = p.operators()[-1]["depth_m"]
        assert heavy == pytest.approx(light / 2 * 60 / 80)
        p.undo()
        assert len(p.operators()) == 2, "a walk is undone as one, to where something else was changed"
        p.undo()
        assert len(p.operators()) == 0
        assert (sampled(p, 2) == before).all()
        for bad in ({"foot": 2}, {"at": (math.nan, 0)}, {"length_m": 0}, {"weight_kg": -1}):
            with pytest.raises(loam.Error):
                p.events.step(**{"actor": 1, "foot": 0, "at": (1, 1), "heading_rad": 0.0, **bad})
        with pytest.raises(loam.Error):
            p.events.keep = -1


def test_prints_fade_and_are_gone(plain):
    with loam.open(str(plain)) as p:
        p.fill(layer="snow")
        p.events.lifetime_s, p.events.fade_s = 100, 50
        before = p.height(60, 60)
        p.time_s = 10
        p.events.step(1, 0, (60, 60), 0.0)
        p.time_s = 11  # lays what was gathered, at the time it was stepped on
        assert p.operators()[0]["life"] == {"from_s": 10, "until_s": 110, "fade_s": 50}
        fresh = before - p.height(60, 60)
        p.time_s = 90
        assert 0 < before - p.height(60, 60) < 0.6 * fresh
        p.time_s = 110
        assert p.height(60, 60) == before
        p.time_s = 12
        assert before - p.height(60, 60) == fresh


def test_treads_follow_the_actor_evenly_however_often_it_calls(plain):
    tracks = []
    for calls in (10, 173):
        with loam.open(str(plain)) as p:
            p.fill(layer="sand")
            p.events.lifetime_s = 0
            for i in range(calls + 1):
                p.events.tread(7, (40 + 30 * i / calls, 50), width_m=0.37, gauge_m=2)
            p.events.flush()
            places = sorted((round(op["x"], 6), round(op["y"], 6)) for op in p.operators())
            assert {y for _, y in places} == {49, 51}
            xs = [x for x, y in places if y == 49]
            assert np.allclose(np.diff(xs), 0.5), "half a piece apart"
            depth = [-(p.height(x, 49.0) - p.height(x, 45.0)) for x in np.linspace(50, 60, 37)]
            assert min(depth) > 0.7 * max(depth), "the rut is even"
            tracks.append(places)
            while p.can_undo:
                p.undo()
    assert tracks[0] == tracks[1]


def test_the_oldest_prints_are_dropped(plain):
    with loam.open(str(plain)) as p:
        p.fill(layer="snow")
        p.events.keep = 20
        for i in range(50):
            p.events.step(1, i % 2, (50 + 0.5 * i, 60), 1.57)
            if i % 7 == 0:
                p.events.flush()
        p.events.flush()
        assert len(p.operators()) == 20
        assert [op["id"] for op in p.operators()] == list(range(31, 51))
        p.crater(200, 200, radius_m=3)  # no print: it stays
        p.events.step(1, 0, (90, 60), 1.57)
        p.events.flush()
        assert len(p.operators()) == 21
        p.undo()
        assert [op["id"] for op in p.operators()] == list(range(31, 52)), "undo brings back what was dropped"
        many = [{"x": 20 + 0.2 * i, "y": 200} for i in range(30)]
        p.apply({"cmd": "footprints", "prints": many, "life": {"until_s": 50}, "keep": 12})
        left = [op for op in p.operators() if op["kind"] == "footprint"]
        assert [op["x"] for op in left] == pytest.approx([print["x"] for print in many[-12:]]), "of one command too"


def test_commands_and_pictures_take_the_time(plain, tmp_path, has_device):
    script = tmp_path / "events.jsonl"
    lines = [{"cmd": "event", "event": kind, "start_s": 2, **keywords} for kind, keywords in EVENTS]
    script.write_text("".join(json.dumps(line) + "\n" for line in lines + [{"cmd": "time", "time_s": 5}]))
    assert run_loam("replay", plain, script).returncode == 0
    pictures = []
    for t in (0, 5, 30):
        out = tmp_path / f"{t}.png"
        run = run_loam("render", plain, "--time", t, "--size", "160x90", "-o", out)
        assert run.returncode == 0, run.stderr
        pictures.append(out.read_bytes())
    assert len(set(pictures)) == 3
    run = run_loam("render", plain, "--size", "160x90", "-o", tmp_path / "left.png")
    assert (tmp_path / "left.png").read_bytes() == pictures[1], "as the script left it"
    fails_with_one_sentence(run_loam("render", plain, "--time", "soon"))
    bad = tmp_path / "bad.jsonl"
    bad.write_text('{"cmd":"event","event":"crash","x":1,"y":1}\n')
    assert '"to" is missing' in fails_with_one_sentence(run_loam("replay", plain, bad))


def test_an_event_in_the_picture_is_wound_back_to_the_bit(plain, has_device):
    with loam.open(str(plain), validation=True) as p:
        first = p.render(CAMERA, size=(320, 180))
        set_off(p)
        for t in (3, 5, 7.5, 12, 25):
            p.time_s = t
            p.step(CAMERA, 2, size=(320, 180))  # while it goes on
        late = p.render(CAMERA, size=(320, 180))
        assert p.count_stale_pages() == 0
        assert (late[:, :, :3].astype(int) - first[:, :, :3]).__abs__().max() > 40
        p.time_s = 0
        assert (p.render(CAMERA, size=(320, 180)) == first).all()
        assert p.count_stale_pages() == 0
        assert p.validation_messages() == 0


def test_height_is_one_after_events(plain, has_device):
    """Query, ray and the depth of the picture at thousands of places, a hole included."""
    with loam.open(str(plain)) as p:
        set_off(p)
        p.cutout("brush", dabs=[(120, 100)], radius_m=4)
        p.time_s = 25
        rng = np.random.default_rng(1)
        x, y = rng.uniform(2, 254, 10_000), rng.uniform(2, 254, 10_000)
        heights, cut = p.height(x, y), p.is_cut(x, y)
        assert cut.any()
        worst = 0.0
        for i in range(x.size):
            hit = p.ray_cast((x[i], y[i], 500), (0, 0, -1))
            if cut[i]:
                assert hit is None
            else:
                worst = max(worst, abs(hit[2] - heights[i]))
        assert worst < 0.0005, worst
        # What the picture shows, at vertices of its patches (8 x 8 quads for 64 x 64 samples of 0.25 m) straight below
        # the camera: reversed infinite depth is near / distance. Between vertices it is the patch's triangles.
        near = []
        for at in rng.integers(15, 112, (60, 2)) * 2:
            if p.is_cut(*at):
                continue
            height = float(p.height(*at))
            camera = loam.Camera.look_at((*at, height + 6), (at[0], at[1] + 1e-7, height))
            p.step(camera, 10, size=(33, 33))
            depth = p.ground_buffers(camera, size=(33, 33))["depth"]
            if depth is None:
                pytest.skip("depth is not read back as floats on this device")
            near.append(float(depth[16, 16]) * 6)
        errors = np.abs(6 * 0.004 / np.array(near) - 6)  # near / depth, the near plane 4 mm away
        assert errors.size > 50
        assert errors.max() < 0.0005


def test_the_tour_ends_where_it_began(plain, tmp_path, has_device):
    """projects/quiet_valley.py on the plain: things happen, and the last picture is the first one."""
    out = tmp_path / "tour"
    run = subprocess.run([sys.executable, str(SOURCE / "projects" / "quiet_valley.py"), str(plain), str(out), "--size", "160x90",
                          "--fps", "1"], capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
    pictures = [np.asarray(Image.open(file)).astype(int) for file in sorted(out.glob("tour-*.png"))]
    assert len(pictures) == 31
    assert (pictures[0] == pictures[-1]).all()
    changed = [np.abs(pictures[i] - pictures[0]).mean() for i in (1, 8, 13, 17, 24)]
    assert min(changed) > 0 and changed[1] > 5 * changed[0] and changed[-1] > 10 * changed[1], changed
