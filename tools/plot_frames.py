"""Plots of time against error, a panel a frame: frames_SIZE.png from the results of `pellucid_bench --json`.

    python3 plot_frames.py bench/baselines/nvidia-h200.json docs/images [SIZE...]

Needs matplotlib (Debian: python3-matplotlib).
"""
import json
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker


def decades(values):
    return 10 ** math.floor(math.log10(min(values))), 10 ** math.ceil(math.log10(max(values)))


def main(results, folder, *sizes):
    with open(results, encoding="utf-8") as file:
        rows = [row for row in json.load(file)["results"] if row.get("kind") == "whole"]
    points = {}  # by size, frame and family: what stands before the comma of the members' names
    truth = set()  # frames whose error is that of the whole image
    for row in rows:
        error = row.get("truth_relative_rmse", row.get("relative_rmse"))
        if error is None or (sizes and row["size"] not in sizes):
            continue
        if "truth_relative_rmse" in row:
            truth.add(row["frame"])
        frame = points.setdefault(row["size"], {}).setdefault(row["frame"], {})
        frame.setdefault(row["name"].split(",")[0], []).append((error, max(row["us"], 1)))
    os.makedirs(folder, exist_ok=True)
    for size, frames in points.items():
        figure, panels = pyplot.subplots(1, len(frames), figsize=(4.5 * len(frames), 4), squeeze=False)
        for panel, (name, families) in zip(panels[0], frames.items()):
            for family, values in families.items():
                panel.plot(*zip(*values), "o", markersize=4, label=family)
            source = "path tracing" if name in truth else "brute force, of the diffusion"
            panel.set(title=f"{name}, {size}", xscale="log", yscale="log", xlabel=f"relative RMSE from {source}",
                      ylabel="microseconds")
            errors, times = zip(*[point for values in families.values() for point in values])
            panel.set(xlim=decades(errors), ylim=decades(times))
            panel.xaxis.set_minor_formatter(ticker.NullFormatter())  # labels of a single decade would overlap
            panel.grid(True, which="both", color="0.92")
            panel.legend(fontsize="small")
        figure.tight_layout()
        path = os.path.join(folder, f"frames_{size}.png")
        figure.savefig(path, dpi=80)
        pyplot.close(figure)
        print("wrote", path)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
