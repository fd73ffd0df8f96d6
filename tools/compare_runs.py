"""Says what grew between two runs of pellucid_bench, and exits with 1 if something did.

    python3 compare_runs.py BEFORE.json NOW.json

A time grew if its 10th percentile lies above the 90th of before, and its median is over 3 % longer: devices repeat
medians within 3 %. An error or a number of spots grew if it is over 2 % larger, as drivers round halves differently.
"""
import json
import sys

SAME_TIME, SAME_ERROR = 1.03, 1.02
ERRORS = "relative_rmse", "truth_relative_rmse", "flip", "spots", "spots_appear", "spots_vanish"


def rows_of(run):
    """By what a row measures."""
    return {": ".join(row[key] for key in ("section", "frame", "size", "kind", "of", "name") if key in row): row
            for row in run["results"]}


def what_grew(before, now):
    """A line each. Raises ValueError for times of two devices."""
    timed = [any("us" in row for row in run["results"]) for run in (before, now)]
    if all(timed) and before["device"] != now["device"]:
        raise ValueError(f"times of {before['device']} and of {now['device']} are not to be compared")
    old, recent = rows_of(before), rows_of(now)
    for key in recent.keys() & old.keys():
        was, row = old[key], recent[key]
        if "us" in was and "us" in row and row["p10_us"] > was["p90_us"] and row["us"] > SAME_TIME * was["us"]:
            yield (f"slower: {key}: {row['us']:.1f} us ({row['p10_us']:.1f} .. {row['p90_us']:.1f}) and not "
                   f"{was['us']:.1f} us ({was['p10_us']:.1f} .. {was['p90_us']:.1f})")
        for error in ERRORS:
            if error in was and (row.get(error) or 0) > SAME_ERROR * (was[error] or 0):
                yield f"worse: {key}: {error} {row[error]:.4g} and not {was[error]:.4g}"
    common = recent.keys() & old.keys()
    print(f"{len(common)} rows compared; {len(recent) - len(common)} are new, {len(old) - len(common)} were not measured")


def read(path):
    with open(path, encoding="utf-8") as file:
        run = json.load(file)
    if not isinstance(run, dict) or not isinstance(run.get("results"), list):
        raise ValueError(f"{path} holds no results of pellucid_bench")
    return run


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        lines = sorted(what_grew(read(sys.argv[1]), read(sys.argv[2])))
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"compare_runs.py: {error!r}" if isinstance(error, KeyError) else f"compare_runs.py: {error}")
    print("\n".join(lines), end="\n" if lines else "")
    sys.exit(1 if lines else 0)
