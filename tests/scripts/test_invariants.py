"""The invariant: after any history of edits every resident page equals its composition from nothing, and undoing all of it
gives the original document bit for bit."""
import os
import random

import loam
import numpy as np
import pytest

COUNT = 500
# Short sequences of operators alone; LOAM_SEQUENCES=1000 is what docs/measurements.md speaks of (20 minutes).
SEQUENCES = int(os.environ.get("LOAM_SEQUENCES", "10"))
pytestmark = pytest.mark.usefixtures("has_device")


def random_place(rng, side):
    """Often on a border or corner of pages and sectors, or of the map."""
    def one():
        kind = rng.random()
        if kind < 0.3:
            return min(side, 16.0 * rng.randrange(int(side / 16) + 1))
        if kind < 0.5:
            return min(side, 64.0 * rng.randrange(int(side / 64) + 1) + rng.choice((-0.5, -0.25, 0.25, 0.5)))
        return rng.uniform(0, side)
    return max(0.0, one()), max(0.0, one())


def random_operator(rng, x, y, layers):
    """Of any kind that is not made below, often with a life."""
    size = rng.uniform(0.5, 15)
    near = [x + rng.uniform(-3, 3) * size, y + rng.uniform(-3, 3) * size]
    half = [size * rng.uniform(0.3, 1), size * rng.uniform(0.3, 1)]
    event = {"cmd": "event", "x": x, "y": y, "start_s": rng.uniform(0, 50), "duration_s": rng.uniform(0, 20),
             "seed": rng.randrange(1000)}
    energy = {"energy_j": 4.184e6 * (rng.uniform(0.5, 8) / 0.4) ** 3, "cool_s": rng.choice((0, 9)), "weather_s": rng.choice((0, 30))}
    events = [dict(event, event="crater", **energy),
              dict(event, event="crater_line", to=near, count=rng.randint(1, 6), **energy),
              dict(event, event="barrage", radius_m=2 * size + 1, count=rng.randint(1, 30), **energy),
              dict(event, event="crash", to=[x + 4 * size, y + size], width_m=max(0.3 * size, 0.5), count=rng.randint(0, 12)),
              dict(event, event="landslide", radius_m=size + 1, volume_m3=0.2 * size ** 3),
              dict(event, event="flood", radius_m=3 * size + 1, level_m=rng.uniform(-5, 20))]
    if rng.random() < 0.4:
        return rng.choice(events)
    points = [[x + rng.uniform(-2, 2) * size, y + rng.uniform(-2, 2) * size, rng.uniform(-5, 20)] for _ in range(7)]
    operator = rng.choice((
        {"cmd": "decal", "x": x, "y": y, "half_m": half, "heading_rad": rng.uniform(0, 6), "layer": rng.choice(layers),
         "displacement_m": rng.choice((0, rng.uniform(-1, 1)))},
        {"cmd": "spline", "points": points, "width_m": max(0.3 * size, 0.1), "carve": rng.random(), "layer": rng.choice(layers)},
        {"cmd": "volume", "at": [x, y, rng.uniform(-5, 20)], "half_m": half + [size], "direction": [0.3, 0.2, -1]},
        {"cmd": "decal", "x": x, "y": y, "half_m": half, "function": rng.choice(("moss", "frost", "gravel", "scorch"))},
        {"cmd": "cutout", "form": "brush", "dabs": [[x, y], near], "radius_m": size, "fill": rng.random() < 0.3},
        {"cmd": "cutout", "form": "box", "at": [x, y, rng.uniform(-5, 20)], "half_m": half + [4 * size]},
        {"cmd": "slide", "x": x, "y": y, "radius_m": size, "to": near, "to_radius_m": 1.5 * size, "volume_m3": 0.2 * size ** 3},
        {"cmd": "flood", "x": x, "y": y, "radius_m": 3 * size + 1, "level_m": rng.uniform(-5, 20), "layer": rng.choice(layers)}))
    if rng.random() < 0.6:
        begins = rng.uniform(0, 50)
        operator["life"] = {"from_s": begins, "until_s": begins + rng.uniform(5, 40), "rise_s": rng.uniform(0, 5),
                            "fade_s": rng.uniform(0, 10)}
    return operator


def random_command(rng, side, layers, open_undo, open_redo):
    kind = rng.random()
    if kind < 0.1 and open_undo:
        return {"cmd": "undo"}
    if kind < 0.15 and open_redo:
        return {"cmd": "redo"}
    x, y = random_place(rng, side)
    if kind < 0.25:
        return {"cmd": "time", "time_s": rng.uniform(-5, 80)}
    if kind < 0.5:
        return random_operator(rng, x, y, layers)
    if kind < 0.6:
        id = rng.randrange(1, 120)
        return rng.choice(({"cmd": "remove", "id": id}, {"cmd": "operator", "id": id, "enabled": rng.random() < 0.5},
                           {"cmd": "reorder", "id": id, "order": rng.randrange(120)}))
    kind = rng.uniform(0.18, 1)
    dabs = [[x + i * rng.uniform(-3, 3), y + i * rng.uniform(-3, 3)] for i in range(rng.randint(1, 5))]
    if kind < 0.45:
        mode = rng.choice(("raise", "lower", "smooth", "flatten"))
        command = {"cmd": "sculpt", "mode": mode, "dabs": dabs, "radius_m": rng.uniform(0.5, 25), "hardness": rng.random()}
        command["strength_m" if mode in ("raise", "lower") else "strength"] = rng.uniform(0.05, 0.9)
        if mode == "flatten":
            command["target_m"] = rng.uniform(-5, 30)
        return command
    if kind < 0.7:
        command = {"cmd": "paint", "dabs": dabs, "radius_m": rng.uniform(0.5, 20), "layer": rng.choice(layers),
                   "strength": rng.random(), "hardness": rng.random(), "seed": rng.randrange(1000)}
        if rng.random() < 0.5:
            command["tint"] = [rng.random(), rng.random(), rng.random()]
        return command
    if kind < 0.85:
        return {"cmd": "crater", "x": x, "y": y, "radius_m": rng.uniform(0.5, 20), "seed": rng.randrange(1000)}
    prints = [{"x": x + 0.4 * i, "y": y, "heading_rad": rng.uniform(0, 6), "foot": i % 2} for i in range(rng.randint(1, 4))]
    return {"cmd": "footprints", "prints": prints, "seed": rng.randrange(1000)}


@pytest.mark.parametrize("seed", [1])
def test_random_edits_leave_no_stale_page_and_undo_to_the_start(plain, seed):
    rng = random.Random(seed)
    size = (160, 90)
    cameras = [(128, 60, 40, 0, -30), (20, 20, 12, 45, -40), (128, 128, 300, 0, -89), (236, 236, 5, 225, -20)]
    with loam.open(str(plain), validation=True) as p:
        side = p.bounds[2]
        original = p.digest()
        p.step(cameras[0], 6, size=size)
        for i in range(COUNT):
            try:
                p.apply(random_command(rng, side, p.layers, p.can_undo, p.can_redo))
            except loam.Error as refused:
                assert "there is no operator" in str(refused)
            if i % 3 == 0:
                p.step(cameras[(i // 60) % len(cameras)], 1, size=size)
            if i % 100 == 99:
                p.render(cameras[(i // 60) % len(cameras)], size=size)
                assert p.count_stale_pages() == 0, f"after {i + 1} commands"
        while p.can_undo:
            p.undo()
        assert p.digest() == original
        p.render(cameras[0], size=size)
        assert p.count_stale_pages() == 0
        assert p.validation_messages() == 0
    assert loam.verify(str(plain)) == []


def random_step(rng, p, side):
    """Adds, moves, reorders, hides, scrubs, deletes or undoes, near the middle of the map."""
    ids = [op["id"] for op in p.operators()]
    kind = rng.random()
    if kind < 0.1 and p.can_undo:
        return {"cmd": "undo"}
    if kind < 0.2:
        return {"cmd": "time", "time_s": rng.uniform(-5, 80)}
    if ids and kind < 0.45:
        one = rng.choice(ids)
        return rng.choice(({"cmd": "remove", "id": one}, {"cmd": "operator", "id": one, "enabled": rng.random() < 0.5},
                           {"cmd": "reorder", "id": one, "order": rng.randrange(2000)}))
    x, y = rng.uniform(100, 156), rng.uniform(100, 156)
    made = random_operator(rng, x, y, p.layers)
    if ids and kind < 0.6:  # what was there is something else somewhere else now
        made["kind"] = made.pop("cmd")
        return {"cmd": "edit", "id": rng.choice(ids), **made}
    if kind < 0.65:
        return {"cmd": "crater", "x": x, "y": y, "radius_m": rng.uniform(0.5, 12), "seed": rng.randrange(1000)}
    if kind < 0.7:
        return {"cmd": "footprints", "prints": [{"x": x, "y": y, "heading_rad": rng.uniform(0, 6), "foot": rng.randrange(4)}]}
    return made


def test_sequences_of_operators_compose_as_from_nothing_and_leave_nothing(plain):
    """After each sequence every resident page of every map equals its composition from nothing; with all operators deleted the
    map is the base map's, bit for bit."""
    camera, size = (128, 100, 45, 0, -50), (96, 54)
    x, y = np.meshgrid(np.linspace(90, 166, 60), np.linspace(90, 166, 60))
    with loam.open(str(plain), validation=True) as p:
        base = p.render(camera, size=size)
        heights, layers, cut = p.height(x, y), p.layer(x, y), p.is_cut(x, y)
        changed = 0
        for seed in range(SEQUENCES):
            rng = random.Random(seed)
            for i in range(rng.randint(4, 12)):
                try:
                    p.apply(random_step(rng, p, 256))
                except loam.Error as refused:
                    assert "of a crash is" in str(refused) or "there is no operator" in str(refused), refused
                if i % 4 == 3:
                    p.step(camera, 1, size=size)
            changed += (p.render(camera, size=size) != base).any()
            assert p.count_stale_pages() == 0, f"sequence {seed}"
            for op in p.operators():
                p.remove_operator(op["id"])
            assert (p.render(camera, size=size) == base).all(), f"sequence {seed}"
            assert (p.height(x, y) == heights).all() and (p.is_cut(x, y) == cut).all(), f"sequence {seed}"
            assert all(a == b for a, b in zip(np.ravel(p.layer(x, y)), np.ravel(layers))), f"sequence {seed}"
            assert p.count_stale_pages() == 0, f"sequence {seed}, all deleted"
        assert changed > 0.6 * SEQUENCES
        assert p.validation_messages() == 0
    assert loam.verify(str(plain)) == []
