"""Tables of the documents from the results of `pellucid_bench --json`, and of `./run shader-stats --json`.

    python3 bench_tables.py RESULTS.json[,RESULTS.json...] TABLE [--check FILE | --update FILE]

Without an option the table is printed. The tables headline and samples may join two files; all others are of one.
"""
import json
import math
import sys

from generated_block import put

MODULE = "Pellucid"  # bench/names.h
SUMMARY_SIZE, SUMMARY_TRUTH = "1920x1080", "head_ior1.4"  # a frame with path-traced truth


def number(value):
    return math.nan if value is None else value  # null: no block of a frame shows the measure


def run_of(run):
    return f"{run['device']}, commit `{run['commit']}`, median of {run['repeat']} runs"


def header(*columns):
    return "".join(f"| {column} " for column in columns) + "|\n|" + "-|" * len(columns) + "\n"


def rows_of(run, section, kind):
    rows = [row for row in run["results"] if row["section"] == section and row.get("kind") == kind]
    return rows or sys.exit(f'results: no rows "{kind}" in section "{section}"')


def find(rows, **fields):
    return next((row for row in rows if all(row[field] == value for field, value in fields.items())), None)


def values_of(rows, field):
    return list(dict.fromkeys(row[field] for row in rows))


def sizes_shown(rows):
    """The two sizes that pages show, or all where the run has neither."""
    sizes = values_of(rows, "size")
    return [size for size in sizes if size in ("1920x1080", "3840x2160")] or sizes


def frames_table(run):
    """A row a method, a column a frame. A cell has the times of two sizes, and then the error of the first."""
    frames, rows = rows_of(run, "frames", "frame"), rows_of(run, "frames", "whole")
    sizes, names = sizes_shown(rows), values_of(frames, "frame")
    table = (f"{run_of(run)}; times in microseconds at {' / '.join(sizes)}, then the error; in brackets: the part of "
             "the image with material:\n\n")
    table += header("", *(f"{name} ({find(frames, frame=name)['covered']:.3f})" for name in names))
    for method in values_of(rows, "name"):
        table += f"| {method} |"
        for frame in names:
            cells = [row for row in (find(rows, frame=frame, size=size, name=method) for size in sizes) if row]
            # Path-traced truth says the error where there is some, else brute force of the diffusion.
            errors = [row[field] for row in cells for field in ("truth_relative_rmse", "relative_rmse") if field in row]
            table += " " + " / ".join(f"{row['us']:.0f}" for row in cells)
            table += f", {number(errors[0]):.2g} |" if errors else " |"
        table += "\n"
    return table


def frame_host_table(run):
    """CPU times, memory and dispatches of the first frame at the last size."""
    rows = rows_of(run, "frames", "whole")
    frame, size = rows[0]["frame"], values_of(rows, "size")[-1]
    table = f"{run_of(run)}; {frame} at {size}, CPU times in microseconds:\n\n"
    table += header("", "dispatches", "barriers", "transients, MB", "plan", "constants", "record")
    for row in rows:
        if row["frame"] == frame and row["size"] == size:
            table += f"| {row['name']} | {row['dispatches']} | {row['barriers']} | {row['transient_bytes'] / 1e6:.1f} |"
            for field in ("cpu_plan_us", "cpu_constants_us", "cpu_record_us"):
                table += f" {row[field]:.1f} |" if field in row else " |"
            table += "\n"
    return table


def context_table(run):
    rows = [row for row in run["results"] if row["section"] == "context creation" and "us" in row]
    if not rows:
        sys.exit('results: no times in section "context creation"')
    return f"{run_of(run)}; seconds:\n\n" + header("", "wall clock", "CPU, all threads") + "".join(
        f"| {row['name']} | {row['us'] / 1e6:.2f} | {row['cpu_us'] / 1e6:.2f} |\n" for row in rows)


def paths_table(run):
    """A row a change, a column a method: RMSE and 99.9th percentile in red."""
    rows = rows_of(run, "paths", "path")
    names = values_of(rows, "name")
    table = f"{run['device']}, commit `{run['commit']}`; flicker in red: RMSE, 99.9th percentile:\n\n"
    table += header("change", *names)
    for change in values_of(rows, "change"):
        cells = [find(rows, change=change, name=name) for name in names]
        table += f"| {change} |" + "".join(
            f" {number(row['flicker_rgb'][0]):.4f}, {number(row['p999_rgb'][0]):.2f} |" if row else " |"
            for row in cells) + "\n"
    return table


def accumulation_table(run):
    """A row a frame and size: time with an anchor, and with accumulation too."""
    rows = rows_of(run, "paths", "accumulation")
    table = f"{run_of(run)}; microseconds:\n\n" + header("frame", "anchor", "accumulated", "more")
    for size in sizes_shown(rows):
        for frame in values_of(rows, "frame"):
            anchor, accumulated = (find(rows, size=size, frame=frame, accumulates=on) for on in (False, True))
            if anchor and accumulated:
                before, now = anchor["us"], accumulated["us"]
                table += f"| {frame}, {size} | {before:.0f} | {now:.0f} | {100 * (now / before - 1):.1f} % |\n"
    return table


def rgb(values):
    return " {:.3f} {:.3f} {:.3f} |".format(*map(number, values))


def rows_with_truth(run, field, cells):
    """Whole frames that have path-traced truth and `field`; `cells`: of a row after its error."""
    rows = [row for row in rows_of(run, "frames", "whole") if "truth_relative_rmse_rgb" in row and field in row]
    if not rows:
        sys.exit(f"results: no frame with path-traced truth has {field}")
    return "".join(f"| {row['frame']} {row['size']} | {row['name']} |{rgb(row['truth_relative_rmse_rgb'])}{cells(row)}\n"
                   for row in rows)


def truth_table(run):
    return (f"{run_of(run)}; relative RMSE of 4x4 averages (R G B), isolated pixels, tint, FLIP:\n\n"
            + header("frame", "whole frame", "relative RMSE", "isolated", "tint", "red/green", "FLIP mean",
                     "99th percentile")
            + rows_with_truth(run, "flip", lambda row: f" {row['isolated']} |{rgb(row['tint'])} "
                              f"{number(row['tint_red_green']):.3f} | {row['flip']:.3f} | {row['flip_p99']:.3f} |"))


def engine_table(run):
    """Captures as engines make them, with turned lights beside."""
    return (f"{run['device']}, commit `{run['commit']}`:\n\n"
            + header("frame", "whole frame", "relative RMSE", "FLIP mean", "spots", "flicker", "of the irradiance",
                     "spots appear, vanish")
            + rows_with_truth(run, "flicker_rgb", lambda row: f" {row['flip']:.3f} | {row['spots']} |"
                              f"{rgb(row['flicker_rgb'])}{rgb(row['flicker_irradiance_rgb'])} {row['spots_appear']}, "
                              f"{row['spots_vanish']} |"))


class Summary:
    """The README's tables of two runs, of which either may have both: times, and errors against path tracing."""

    def __init__(self, runs):
        def first(has, what):
            return next((run for run in runs if any(map(has, run["results"]))), None) or sys.exit(f"results: no {what}")
        self.times = first(lambda row: row.get("size") == SUMMARY_SIZE and "us" in row, f"times at {SUMMARY_SIZE}")
        self.errors = first(lambda row: row.get("frame") == SUMMARY_TRUTH and "truth_relative_rmse_rgb" in row,
                            f'frame "{SUMMARY_TRUTH}" with path-traced truth')

    def heading(self):
        same = self.times["device"] == self.errors["device"]
        return (f"Times at {SUMMARY_SIZE}: {run_of(self.times)}. Errors of {SUMMARY_TRUTH}: "
                + (f"commit `{self.errors['commit']}`" if same else run_of(self.errors)) + ".\n\n")

    def row(self, run, frame, size, name):
        return (find(rows_of(run, "frames", "whole"), frame=frame, size=size, name=name)
                or sys.exit(f'results: no "{name}" of frame "{frame}" at {size}'))

    def time(self, frame, name):
        return f" {self.row(self.times, frame, SUMMARY_SIZE, name)['us']:.0f} |"

    def error(self, name):
        row = self.row(self.errors, SUMMARY_TRUTH, rows_of(self.errors, "frames", "frame")[0]["size"], name)
        return f" {row['truth_relative_rmse_rgb'][0]:.3f} | {row['flip']:.3f} |"

    def memory(self, name):
        return f" {self.row(self.times, 'portrait', SUMMARY_SIZE, name)['transient_bytes'] / 1e6:.0f} |"


def headline_table(*runs):
    summary = Summary(runs)
    table = summary.heading() + header("method", "head, us", "face that fills the screen, us",
                                       "no skin on screen, us", "error in red", "mean FLIP")
    for name in (MODULE, "Jimenez 2010 + 2015, 11 taps", "HDRP, 20 samples"):
        times = "".join(summary.time(frame, name) for frame in ("portrait", "closeup", "nothing"))
        table += f"| {name} |{times}{summary.error(name)}\n"
    return table


def samples_table(*runs):
    summary = Summary(runs)
    table = summary.heading() + header("`gatherSamples`", "head, us", "error in red", "mean FLIP", "transients, MB")
    for samples, name in ((0, MODULE + ", 0 samples"), (8, MODULE), (16, MODULE + ", 16 samples")):
        table += f"| {samples} |{summary.time('portrait', name)}{summary.error(name)}{summary.memory(name)}\n"
    return table


def shader_stats_table(run):
    """All statistics of the first card, and registers and waves a SIMD of the others."""
    (name, first), *others = run["families"].items()
    titles = {"vgprs": "vector registers", "spilledVgprs": "spilled", "spilledSgprs": "scalar ones spilled",
              "ldsBytes": "shared bytes", "codeBytes": "code bytes", "waves": "waves a SIMD"}
    table = header("pipeline", *(f"{name}: {title}" for title in titles.values()),
                   *(f"{other}: registers, waves" for other, _ in others))
    for pipeline, row in first["pipelines"].items():
        cells = [row[key] for key in titles]
        for _, other in others:
            cells.append(f"{other['pipelines'][pipeline]['vgprs']}, {other['pipelines'][pipeline]['waves']}")
        table += f"| {pipeline} | " + " | ".join(map(str, cells)) + " |\n"
    return table


TABLES = {"frames": frames_table, "frame_host": frame_host_table, "context": context_table, "truth": truth_table,
          "engine": engine_table, "headline": headline_table, "samples": samples_table, "paths": paths_table,
          "accumulation": accumulation_table, "shader_stats": shader_stats_table}


def main(results, name, mode=None, path=None):
    runs = []
    for result in results.split(","):
        with open(result, encoding="utf-8") as file:
            runs.append(json.load(file))
    if len(runs) > 1 and name not in ("headline", "samples"):
        sys.exit(f"{results}: the table {name} is of one file")
    table = TABLES[name](*runs)
    if not path:
        print(table, end="")
        return
    put(path, name, table, mode)


if __name__ == "__main__":
    arguments = sys.argv[1:]
    if len(arguments) not in (2, 4) or arguments[1] not in TABLES or arguments[2:3] not in ([], ["--check"], ["--update"]):
        sys.exit(__doc__ + "\nTABLE: " + ", ".join(TABLES))
    main(*arguments)
