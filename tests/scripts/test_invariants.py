"""The invariant: after any history of edits every resident page equals its composition from nothing, and undoing all of it
gives the original document bit for bit."""
import random

import loam
import pytest

COUNT = 500
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


def random_command(rng, side, layers, open_undo, open_redo):
    kind = rng.random()
    if kind < 0.12 and open_undo:
        return {"cmd": "undo"}
    if kind < 0.18 and open_redo:
        return {"cmd": "redo"}
    x, y = random_place(rng, side)
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
            p.apply(random_command(rng, side, p.layers, p.can_undo, p.can_redo))
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
