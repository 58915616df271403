#!/usr/bin/env python3
"""How long a still takes on many machines, from the measured costs of its tiles.

    simulate.py SCENE-40.seconds [--seconds 1200] [--starts 90] [--latency 2.2]
        [--merge 0.01] [--write 0.4]

The file has the processor seconds of each task, and those for reading and building the scene (measure.sh writes it). The
picture is scaled to --seconds of work on one machine; reading the scene is not scaled. The scheduler starts --starts
tasks a second, the first one --latency seconds after the submission (starts.sh measures both), and the merge, which
waits as long to be started, reads one tile every --merge seconds and writes the picture in
--write seconds. Tasks are given to machines in order, the next one to the machine that is free first, as an array of
Slurm does.
"""

import argparse
import heapq
import random

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("file")
parser.add_argument("--seconds", type=float, default=1200)
parser.add_argument("--starts", type=float, default=90)
parser.add_argument("--latency", type=float, default=2.2)
parser.add_argument("--merge", type=float, default=0.01)
parser.add_argument("--write", type=float, default=0.4)
# A picture of 1920x1080 has so many blocks of 32x32 pixels.
parser.add_argument("--most", type=int, default=2040)
options = parser.parse_args()

with open(options.file) as file:
    lines = [line.split() for line in file if line.strip()]
reading = next(float(words[-1]) for words in lines if words[0] == "#")
# Every task has read the scene; what is left is its tile.
measured = [max(float(words[0]) - reading, 0.0) for words in lines if words[0] != "#"]
mean = sum(measured) / len(measured)
# How unlike the tiles are; finer tiles are assumed to be as unlike.
ratios = [cost / mean for cost in measured]


def margin(tiles):
    """What antialiasing adds at the edges: a row of first rays (a fifth of all) around square tiles."""
    side = (1920 * 1080 / tiles) ** 0.5
    return 4 / side / 5


def run(nodes, tiles, seed):
    """Seconds until the last tile is done, and what each task took."""
    draw = random.Random(1000 * tiles + seed)
    shares = [draw.choice(ratios) for _ in range(tiles)]
    work = options.seconds * (1 + margin(tiles)) / sum(shares)
    tasks = [reading + work * share for share in shares]
    free = [0.0] * nodes
    end = 0.0
    for index, task in enumerate(tasks):
        begin = max(heapq.heappop(free), index / options.starts)
        heapq.heappush(free, begin + task)
        end = max(end, begin + task)
    return end, tasks


def mean_run(nodes, tiles):
    """The mean of several draws."""
    runs = [run(nodes, tiles, seed) for seed in range(9)]
    longest = sum(max(tasks) for _, tasks in runs) / len(runs)
    return sum(end for end, _ in runs) / len(runs), sum(runs[0][1]), longest


print(f"{'nodes':>6} {'tiles':>6} {'tiles [s]':>10} {'merge [s]':>10} {'all [s]':>9} {'speed-up':>9} {'efficiency':>10}  bound by")
for nodes in [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]:
    best = None
    for each in [0.25, 0.5, 1, 2, 4, 8]:
        tiles = min(max(int(nodes * each), 1), options.most)
        end, work, longest = mean_run(nodes, tiles)
        merge = options.latency + options.write + tiles * options.merge
        end += options.latency
        if best is None or end + merge < best[0]:
            bounds = {
                "work": work / min(nodes, tiles),
                "waiting to be started": 2 * options.latency,
                "the longest tile": longest,
                "starting tasks": tiles / options.starts,
                "reading the scene": reading * max(tiles / nodes, 1),
                "merging": merge,
            }
            best = (end + merge, tiles, end, merge, max(bounds, key=bounds.get))
    all_, tiles, end, merge, bound = best
    speed = options.seconds / all_
    print(f"{nodes:>6} {tiles:>6} {end:>10.1f} {merge:>10.1f} {all_:>9.1f} {speed:>9.1f} {100 * speed / nodes:>9.1f}%  {bound}")
