#!/usr/bin/python3
"""Half a minute of a quiet valley: a path is laid, someone walks, a truck passes, a plane comes down, the valley is cratered, and
time is wound back. Makes a picture a frame, and a video where ffmpeg is installed.

    loam new out/valley --recipe valley --size 4096 --seed 7
    PYTHONPATH=build/release/python /usr/bin/python3 projects/quiet_valley.py out/valley out/tour

The project is copied first: nothing is changed in it. The last picture is the first one, bit for bit.
"""
import argparse
import math
import os
import shutil
import subprocess
import tempfile

import loam
import numpy as np
from PIL import Image

# Seconds of the tour at which things happen.
PATH, WALK, TRUCK, CRASH, BARRAGE, BACK, END = 1.0, 3.0, 9.0, 14.0, 18.0, 25.0, 30.0


def flattest(p, width, height, half):
    """A place that a road would choose: of a grid over the middle of the map the one of the least relief around it."""
    best = None
    for x in np.linspace(0.3 * width, 0.7 * width, 9):
        for y in np.linspace(0.3 * height, 0.7 * height, 9):
            gx, gy = np.meshgrid(np.linspace(x - half, x + half, 7), np.linspace(y - half, y + half, 7))
            relief = float(np.ptp(p.height(gx, gy)))
            if best is None or relief < best[0]:
                best = (relief, x, y)
    return best[1:]


class Tour:
    def __init__(self, project, size):
        self.p, self.size = project, size
        _, _, width, height = project.bounds
        self.unit = min(60.0, min(width, height) / 10)  # metres: half of what the camera sees of the path
        self.x, self.y = flattest(project, width, height, self.unit)
        self.soft = "sand" if "sand" in project.layers else project.layers[0]
        eye = (self.x - 0.5 * self.unit, self.y - 1.5 * self.unit)
        top = max(float(project.height(*eye)), float(project.height(self.x, self.y))) + 0.55 * self.unit
        self.camera = loam.Camera.look_at((*eye, top), (self.x, self.y, float(project.height(self.x, self.y))))
        self.laid = self.walked = self.driven = 0
        self.last = -1.0

    def along(self, share):
        """The path: from west to east, with a bend."""
        x = self.x + self.unit * (2 * share - 1)
        return x, self.y + 0.18 * self.unit * math.sin(2.6 * (2 * share - 1))

    def heading(self, share):
        (x0, y0), (x1, y1) = self.along(share - 0.01), self.along(share + 0.01)
        return math.atan2(x1 - x0, y1 - y0)

    def act(self, t):
        """What begins between the last moment and this one."""
        def begins(at):
            return self.last < at <= t

        p, u = self.p, self.unit
        if begins(PATH):
            places = [(*self.along(s), float(p.height(*self.along(s)))) for s in np.linspace(0, 1, 6)]
            p.spline(p.spline_through(places, 0.07 * u), layer=self.soft, carve=0.8, shoulder_m=0.05 * u, edge=0.5, rough=0.4,
                     fade_m=0.2 * u, life={"from_s": PATH, "rise_s": 1.5})
        if t >= WALK:
            length = 2.1 * u
            steps = int(length / 0.75)
            until = min(int(steps * (t - WALK) / (TRUCK - WALK)), steps)
            for i in range(self.walked, until):
                share = i / steps
                (x, y), heading = self.along(share), self.heading(share)
                side = 0.12 if i % 2 else -0.12
                p.events.step(1, i % 2, (x + side * math.cos(heading), y - side * math.sin(heading)), heading)
            self.walked = max(self.walked, until)
        if t >= TRUCK:
            calls = 60
            until = min(int(calls * (t - TRUCK) / (CRASH - TRUCK)), calls)
            for i in range(self.driven, until):
                x, y = self.along(i / calls)
                p.events.tread(2, (x, y + 0.06 * u), weight_kg=1200, gauge_m=2.0)
            self.driven = max(self.driven, until)
        if begins(CRASH):
            p.event("crash", x=self.x - 0.9 * u, y=self.y + 0.9 * u, to=(self.x + 0.1 * u, self.y + 0.4 * u), width_m=0.1 * u,
                    start_s=CRASH, duration_s=2.5, seed=4)
        if begins(BARRAGE):
            p.event("barrage", x=self.x, y=self.y, radius_m=1.2 * u, count=90, energy_j=4.184e6 * (0.14 * u / 0.4) ** 3,
                    start_s=BARRAGE, duration_s=5, cool_s=6, seed=8)
        self.last = t

    def picture(self, moment):
        """Forward until BACK, then the same time wound back, faster, to before anything was there."""
        if moment <= BACK:
            self.act(moment)
            time_s = moment
        else:
            time_s = BACK * max(0.0, 1 - (moment - BACK) / (END - 1 - BACK))
        self.p.time_s = time_s
        if moment <= 0 or moment >= END:
            return self.p.render(self.camera, size=self.size)
        return self.p.render(self.camera, size=self.size, max_frames=20)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("project")
    parser.add_argument("out", help="folder for the pictures")
    parser.add_argument("--size", default="960x540")
    parser.add_argument("--fps", type=float, default=10)
    options = parser.parse_args()
    width, height = (int(side) for side in options.size.split("x"))
    os.makedirs(options.out, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "valley")
        shutil.copytree(options.project, copy)
        with loam.open(copy) as project:
            project.time_s = 0
            tour = Tour(project, (width, height))
            count = int(END * options.fps)
            for i in range(count + 1):
                pixels = tour.picture(END * i / count)
                Image.fromarray(pixels[:, :, :3].copy()).save(os.path.join(options.out, f"tour-{i:04d}.png"))
    print(f"{count + 1} pictures in {options.out}")
    if shutil.which("ffmpeg"):
        video = os.path.join(options.out, "tour.mp4")
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-framerate", str(options.fps), "-i", os.path.join(options.out, "tour-%04d.png"),
                        "-pix_fmt", "yuv420p", video], check=True)
        print(video)


if __name__ == "__main__":
    main()
