#!/usr/bin/python3
"""Makes the pictures of the README from the example project, with the program itself.

    loam new out/valley --recipe valley --size 4096 --seed 7
    PYTHONPATH=build/release/python /usr/bin/python3 projects/pictures.py out/valley docs/pictures

The project is copied first: nothing is changed in it.
"""
import math
import os
import shutil
import sys
import tempfile

import loam
import numpy as np
from PIL import Image


def ground(project, x, y, above):
    return project.height(x, y) + above


def look(project, eye, target, above_eye, above_target=0.0, fov=55):
    """Camera (x, y, z, yaw in degrees, pitch in degrees, fov) from a place above the ground to another."""
    z0, z1 = ground(project, *eye, above_eye), ground(project, *target, above_target)
    dx, dy = target[0] - eye[0], target[1] - eye[1]
    yaw = math.degrees(math.atan2(dx, dy))
    pitch = math.degrees(math.atan2(z1 - z0, math.hypot(dx, dy)))
    return (eye[0], eye[1], z0, yaw, pitch, fov)


def picture(project, camera, path, **options):
    pixels = project.render(camera=camera, size=(1280, 720), supersample=2, **options)
    Image.fromarray(pixels[:, :, :3].copy()).save(path, quality=88)
    print(path)


def walk(project, start, end, stride=0.75):
    """Footprints along a line, left and right in turn."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    heading = math.atan2(dx, dy)
    side = (math.cos(heading), -math.sin(heading))
    prints = []
    for i in range(int(length / stride)):
        t, off = i * stride / length, 0.12 if i % 2 else -0.12
        prints.append({"x": start[0] + dx * t + side[0] * off, "y": start[1] + dy * t + side[1] * off,
                       "heading_rad": heading, "foot": i % 2})
    project.apply({"cmd": "footprints", "prints": prints, "length_m": 0.32, "depth_m": 0.03, "seed": 5})


def road_picture(project, path):
    """A road that cuts into a slope, a track that crosses it, a decal where it begins, rock projected onto a steep face."""
    places = [(1820, 2262), (1880, 2292), (1935, 2318), (1985, 2338), (2035, 2372), (2075, 2405), (2130, 2425), (2185, 2455)]
    z = [float(project.height(*at)) for at in places]
    for _ in range(2):  # an even grade
        z = [z[0]] + [(z[i - 1] + 2 * z[i] + z[i + 1]) / 4 for i in range(1, len(z) - 1)] + [z[-1]]
    road = project.spline_through([(x, y, h) for (x, y), h in zip(places, z)], 8)
    project.spline(road, carve=1, shoulder_m=8, layer="scree", edge=0.3, rough=0.35, fade_m=8, colour=[0.92, 0.9, 0.86])
    track = project.spline_through([(2005, 2225), (2000, 2262), (1985, 2300), (1978, 2334), (1960, 2375), (1955, 2420)], 3.2)
    project.spline(track, layer="dirt", edge=0.8, rough=0.6, fade_m=15, colour=[0.85, 0.78, 0.68])
    project.decal(1992, 2288, half_m=[8, 5], heading_rad=0.6, outline="ellipse", layer="dirt", edge=0.5, rough=0.8,
                  colour=[0.9, 0.82, 0.72])
    x, y = 2022, 2340
    facing = [-float(n) for n in project.normal(x, y)]
    project.volume((x, y, float(project.height(x, y))), half_m=[13, 8, 8], direction=facing, layer="rock", edge=0.3,
                   rough=0.9, outline="ellipse")
    picture(project, look(project, (1958, 2268), (2004, 2345), 20, fov=60), path)


def stamp_picture(project, folder, path):
    """A ridge of noise, made here, laid twice: added with rock on its heights, and mirrored, turned and cut off by the ground."""
    side = 512
    rng = np.random.default_rng(3)
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(side), np.fft.fftfreq(side)))
    frequency[0, 0] = 1
    noise = np.fft.ifft2(np.fft.fft2(rng.normal(size=(side, side))) / frequency**1.9).real
    y, x = np.mgrid[0:side, 0:side]
    level = np.clip(1 - 3 * np.abs(noise) / np.abs(noise).max(), 0, 1) * np.clip(1.1 - np.hypot(x - 256, y - 256) / 256, 0, 1)
    Image.fromarray((level / level.max() * 65535).astype(np.uint16)).save(f"{folder}/crag.png")
    project.add_stamp(f"{folder}/crag.png")
    project.stamp("crag", 2230, 2200, half_m=[330, 330], heading_rad=0.4, height_m=170, edge=0.3, layer="rock", layer_from=0.5)
    project.stamp("crag", 2700, 2420, half_m=[-260, 200], heading_rad=1.2, mode="max", height_m=150, edge=0.3,
                  base_m=float(project.height(2700, 2420)) - 30)
    picture(project, look(project, (1900, 1450), (2400, 2300), 130, 60), path)
    for one in project.operators():
        if one["kind"] == "stamp":
            project.remove_operator(one["id"])


def imagery_picture(project, folder, path):
    """Imagery made here of the map's own heights: fields in the valley, woods on its flanks, bare above. Without and with it."""
    side = 2048
    x, y = np.meshgrid(np.linspace(0, 4096, side), np.linspace(4096, 0, side))  # row 0 is north
    z = np.asarray(project.height(np.clip(x, 0, project.bounds[2]), np.clip(y, 0, project.bounds[3])))
    rng = np.random.default_rng(5)

    def noise(texels):
        small = Image.fromarray((rng.random((side // texels, side // texels)) * 255).astype(np.uint8))
        return np.asarray(small.resize((side, side), Image.BICUBIC), dtype=float)[..., None] / 255

    fine, patches = noise(1), 0.5 * noise(64) + 0.3 * noise(16) + 0.2 * noise(4)
    slope = np.hypot(*np.gradient(z, 2.0))[..., None]
    high = np.clip((z - np.quantile(z, 0.1)) / (np.quantile(z, 0.95) - np.quantile(z, 0.1)), 0, 1)[..., None]
    fields = np.array([[0.50, 0.46, 0.28], [0.36, 0.41, 0.24], [0.56, 0.51, 0.36], [0.31, 0.37, 0.23]])
    plot = (x * 0.9 + y * 0.44) // 170 * 7 + (y * 0.9 - x * 0.44) // 80 * 13
    meadow = np.array([0.42, 0.41, 0.27]) * (0.8 + 0.4 * patches)
    colour = np.where(slope < 0.12, fields[plot.astype(int) % 4], meadow) * (0.85 + 0.3 * fine)
    woods = np.array([0.15, 0.2, 0.12]) * (0.5 + fine)
    bare = np.array([0.5, 0.47, 0.43]) * (0.75 + 0.3 * fine + 0.2 * patches)
    colour = np.where((slope > 0.12) & (high < 0.55) & (patches > 0.45), woods, colour)
    colour = np.where(high + 0.6 * (patches - 0.5) > 0.7, bare, colour)
    Image.fromarray((np.clip(colour, 0, 1) * 255).astype(np.uint8)).save(f"{folder}/ortho.png")
    camera = look(project, (2000, 1500), (2260, 3000), 260, 0)
    views = []
    project.add_imagery(f"{folder}/ortho.png", distance_m=200)
    for strength in ("0", "1"):
        project.set("imagery.strength", strength)
        views.append(project.render(camera=camera, size=(800, 560))[..., :3])
    Image.fromarray(np.concatenate(views, axis=1)).save(path, quality=90)
    project.set("imagery.file", "")


def functions_picture(project, path):
    """Decals that are functions, on level ground: a trodden path with puddles, a truck's marks and its oil, and what lies around.
    Undone afterwards."""
    x, y = 520, 1840

    def spline(places, width, name, **keywords):
        points = project.spline_through([(x + i, y + j, float(project.height(x + i, y + j))) for i, j in places], width)
        return project.spline(points, function=name, fade_m=width, **keywords)

    def patch(i, j, half, name, heading=0.0, **keywords):
        return project.decal(x + i, y + j, half_m=half, heading_rad=heading, function=name, outline="ellipse",
                             **{"edge": 0.6, "seed": int(7 * i + 3 * j + 150), **keywords})

    made = [
        spline([(-9, -7), (-3, -2), (2, 1), (7, 6), (12, 12)], 2.4, "footpath", edge=0.7, seed=2),
        spline([(-12, 3), (-4, 2.5), (3, -1.5), (11, -3)], 2.6, "tyre_marks", parameters={"depth": 0.8}, edge=0.1),
        patch(-2.2, -1.5, [1.7, 1.1], "puddle", 0.8, parameters={"fill": 0.75}),
        patch(3.9, 2.9, [1.3, 0.9], "puddle", 0.6, parameters={"fill": 0.7}),
        patch(-5.2, 0.3, [2.2, 1.5], "cracks", 0.3),
        patch(6.5, 1.0, [2.3, 1.6], "leaf_litter", 0.4, parameters={"amount": 0.75}),
        patch(-1.5, 4.6, [2.2, 1.5], "moss", 0.2, parameters={"growth": 0.65, "cushion": 0.35}),
        patch(2.6, -3.2, [2.0, 1.3], "gravel", 0.9, parameters={"stone": 0.1, "amount": 0.75}),
        patch(5.0, -0.6, [1.0, 0.8], "oil", 1.2, edge=0.3),
        patch(-4.2, 7.6, [3.4, 2.2], "snow_patch", 0.5, parameters={"melt": 0.35}),
        patch(5.0, 8.6, [2.2, 1.6], "scorch", 0.1),
        patch(-0.3, -4.6, [1.7, 1.0], "sand_ripples", 1.3),
        patch(9.5, 5.2, [1.9, 1.5], "frost", 0.2),
    ]
    picture(project, look(project, (x - 0.5, y - 8.6), (x + 0.5, y + 0.3), 5.4), path)
    for _ in made:
        project.undo()


def event_pictures(project, crash, cratered):
    """A plane has come down; then craters all over its valley, the first ones weathered. Undone afterwards."""
    x, y = 2100, 2220
    project.time_s = 0
    project.event("crash", x=x - 75, y=y - 20, to=(x + 10, y + 15), width_m=6, count=90, start_s=1, seed=3)
    project.time_s = 12
    picture(project, look(project, (x + 52, y - 12), (x - 8, y + 10), 17), crash)
    project.event("barrage", x=x, y=y, radius_m=260, count=420, energy_j=4.184e6 * (9 / 0.4) ** 3, start_s=12, duration_s=60,
                  weather_s=60, seed=5)
    project.time_s = 75
    picture(project, look(project, (x - 60, y - 300), (x, y), 110), cratered)
    project.undo()
    project.undo()


def noise(shape, cells, random):
    """Smooth noise that repeats, 0 … 1: a few octaves of random values between which cosines lead."""
    out, weight, total = np.zeros(shape), 1.0, 0.0
    while cells <= shape[0] // 2:
        values = random.random((cells, cells))
        at = np.arange(shape[0]) * cells / shape[0]
        low = at.astype(int)
        t = (1 - np.cos((at - low) * np.pi)) / 2
        rows = values[low % cells] * (1 - t)[:, None] + values[(low + 1) % cells] * t[:, None]
        out += weight * (rows[:, low % cells] * (1 - t) + rows[:, (low + 1) % cells] * t)
        total, weight, cells = total + weight, weight * 0.55, cells * 2
    return out / total


def ice_layer(folder, size=1024):
    """Clear ice: stones and silt at its bottom, white cracks that stand in it, frost on top."""
    random = np.random.default_rng(11)
    shape = (size, size)
    bottom, pebbles, frost = noise(shape, 4, random), noise(shape, 24, random), noise(shape, 6, random)
    crack = np.zeros(shape)
    for cells, width, strength in ((3, 0.006, 1.0), (6, 0.010, 0.7), (12, 0.014, 0.35)):
        line = np.abs(noise(shape, cells, random) - 0.5)
        crack = np.maximum(crack, strength * np.clip(1 - line / width, 0, 1))
    stones = np.clip((pebbles - 0.52) * 9, 0, 1)
    colour = np.array([0.10, 0.20, 0.23]) * (0.6 + 0.8 * bottom)[..., None]
    colour = colour * (1 - stones)[..., None] + np.array([0.34, 0.36, 0.33]) * (stones * (0.5 + pebbles))[..., None]
    colour = colour * (1 - crack)[..., None] + np.array([0.80, 0.88, 0.92]) * crack[..., None]
    dust = np.clip((frost - 0.60) * 7, 0, 1)[..., None]
    colour = colour * (1 - dust) + np.array([0.86, 0.90, 0.94]) * dust
    height = np.maximum(0.1 + 0.25 * bottom + 0.2 * stones + 0.05 * crack, np.clip((frost - 0.5) * 4, 0, 1))
    os.makedirs(folder)
    Image.fromarray((255 * np.sqrt(np.clip(colour, 0, 1))).astype(np.uint8)).save(f"{folder}/ice_Color.png")
    Image.fromarray((255 * np.clip(height, 0, 1)).astype(np.uint8)).save(f"{folder}/ice_Displacement.png")
    rough = 60 + 120 * dust[..., 0] + 20 * crack
    Image.fromarray(np.clip(rough, 0, 255).astype(np.uint8)).save(f"{folder}/ice_Roughness.png")
    Image.fromarray(np.full(shape + (3,), (128, 128, 255), np.uint8)).save(f"{folder}/ice_NormalGL.png")


def ice_picture(source, folder, path):
    """A frozen pool on a map with the channel of depth: flat ice on the left, deep on the right."""
    copy = os.path.join(folder, "ice")
    shutil.copytree(source, copy)
    with open(f"{copy}/project.toml", "a") as project:
        project.write('\n[texture]\nchannels = ["depth"]\n')
    ice_layer(f"{folder}/ice_layer")
    with loam.open(copy) as project:
        project.add_layer(f"{folder}/ice_layer", name="ice", tile_m=3)
        x, y = 2040, 1905
        project.sculpt("flatten", [(x, y)], radius_m=40, strength=1, target_m=float(project.height(x, y)))
        project.paint([(x, y)], layer="ice", radius_m=22, hardness=0.9)
        camera = look(project, (x, y), (x + 2, y + 5), 1.7, fov=60)
        halves = []
        for depth in ("0", "0.5"):
            project.set("layer.ice.depth", depth)
            halves.append(project.render(camera=camera, size=(1280, 720), supersample=2)[:, :, :3])
    Image.fromarray(np.hstack([halves[0][:, :640], halves[1][:, 640:]])).save(path, quality=88)
    print(path)


def main(source, out):
    os.makedirs(out, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "project")
        shutil.copytree(source, copy)
        ice_picture(source, folder, f"{out}/ice.jpg")
        with loam.open(copy) as project:
            picture(project, look(project, (2000, 1500), (2260, 3000), 150, 40), f"{out}/valley.jpg")
            picture(project, look(project, (3000, 1200), (2600, 1900), 60), f"{out}/ridge.jpg")
            imagery_picture(project, folder, f"{out}/imagery.jpg")
            stamp_picture(project, folder, f"{out}/stamps.jpg")
            road_picture(project, f"{out}/road.jpg")
            functions_picture(project, f"{out}/functions.jpg")
            event_pictures(project, f"{out}/crash.jpg", f"{out}/cratered.jpg")
            for i, (x, y, r) in enumerate([(2040, 1905, 14), (2075, 1935, 6), (2010, 1940, 9), (2120, 1990, 22)]):
                project.apply({"cmd": "crater", "x": x, "y": y, "radius_m": r, "seed": 3 + i})
            walk(project, (2004.5, 1855), (2034, 1886))
            picture(project, look(project, (1985, 1850), (2052, 1915), 24), f"{out}/craters.jpg")
            picture(project, look(project, (2005.6, 1853.6), (2010, 1861), 1.7, fov=60), f"{out}/footprints.jpg")
            picture(project, look(project, (2000, 1500), (2260, 3000), 150, 40), f"{out}/pages.jpg", debug="mips")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: pictures.py PROJECT OUT")
    main(sys.argv[1], sys.argv[2])
