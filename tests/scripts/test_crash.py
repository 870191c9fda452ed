"""Killed at random moments during a replay: every command that was reported as committed is there, and nothing is half-done."""
import json
import os
import random
import shutil
import signal
import subprocess
import time

import loam

KILLS = 50


def test_killed_at_random_moments(plain_template, tmp_path):
    rng = random.Random(11)
    script = tmp_path / "script.jsonl"
    with script.open("w") as out:
        for i in range(4000):
            x, y = rng.uniform(10, 240), rng.uniform(10, 240)
            command = {"cmd": "sculpt", "mode": "raise", "dabs": [[x, y]], "radius_m": rng.uniform(2, 30), "strength_m": 0.1, "hardness": 0.5}
            if i % 5 == 4:
                command = {"cmd": "crater", "x": x, "y": y, "radius_m": rng.uniform(1, 10), "seed": i}
            out.write(json.dumps(command) + "\n")
    program = os.environ["LOAM_PROGRAM"]
    interrupted = 0
    for kill in range(KILLS):
        project = tmp_path / "p"
        shutil.rmtree(project, ignore_errors=True)
        shutil.copytree(plain_template, project)
        process = subprocess.Popen([program, "replay", str(project), str(script), "--commit-log"], stdout=subprocess.PIPE, text=True)
        # Most are killed while commands run, some while the project is being opened, however busy the machine is.
        said = [] if kill % 5 == 0 else [process.stdout.readline()]
        time.sleep(rng.uniform(0.0, 0.2))
        process.send_signal(signal.SIGKILL)
        said = [line.strip() for line in said + process.stdout.read().splitlines(keepends=True) if line.endswith("\n")]
        process.wait()
        complete = [line for line in said if line.startswith("committed ")]
        committed = int(complete[-1].split()[1]) if complete else 0
        interrupted += committed > 0
        with loam.open(str(project)) as p:
            done = len(p.history(100000))
        assert committed <= done <= committed + 1, (kill, committed, done)
        assert loam.verify(str(project)) == []
    assert interrupted >= KILLS * 4 // 5
