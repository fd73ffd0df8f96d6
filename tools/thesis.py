"""Figures and tables of Whelan 2009 (docs/thesis.md), by the command `pellucid`.

    python3 thesis.py PELLUCID FOLDER [figures] [MODEL.glb OPTION...]     thesis.png, and angles.png
    python3 thesis.py PELLUCID FOLDER angles                              angles.png: figures 4.7 and 4.8
    python3 thesis.py PELLUCID FOLDER times MODEL.glb [OPTION...]         tables 5.1 to 5.3, times of the device
    python3 thesis.py PELLUCID FOLDER dots MODEL.glb [OPTION...]          dots.json, of --set angle=minimum-dot-azimuth
    python3 thesis.py PELLUCID FOLDER views R,G,B [MODEL.glb OPTION...]   views.png: six views by a color filter
    python3 thesis.py PELLUCID FOLDER perception ANSWERS.csv              table 5.4

OPTION is of `pellucid capture`. Without a model, the procedural ear is drawn. Needs numpy, scipy, matplotlib
and what sheet.py needs.
"""
import csv
import itertools
import json
import math
import os
import re
import subprocess
import sys

import numpy

EAR = ["--procedural", "ear"]


def scene_of(options):
    """Options of `pellucid capture`, of the procedural ear where they name no model and no scene."""
    named = options and not options[0].startswith("-") or "--procedural" in options
    return options if named else EAR + options


class Refused(Exception):
    """What is wrong with the input, in a sentence."""


class Pellucid:
    def __init__(self, command, folder):
        self.command, self.folder = command, folder
        os.makedirs(folder, exist_ok=True)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *arguments):
        done = subprocess.run([self.command, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, check=False)
        if done.returncode != 0:
            raise Refused(f"pellucid {' '.join(map(str, arguments))}:\n{done.stdout}")
        return done.stdout


# ---- Figures 4.1 to 5.3: pictures


def figures(pellucid, source):
    from sheet import sheet

    size = [] if "--size" in source else ["--size", "256x256"]
    images = []  # file, label, exposure
    replayed = {}  # files by capture and options: figures share pictures

    def capture(name, *options):
        pellucid.run("capture", *source, *size, *options, "-o", pellucid.path(name + ".exr"))

    def picture(label, name, exposure, *options):
        key = (name, *options)
        if key not in replayed:
            replayed[key] = pellucid.path(f"picture.{len(replayed)}.exr")
            pellucid.run("replay", pellucid.path(name + ".exr"), "--mode", "thesis", "--repeat", 0, *options, "-o", replayed[key])
        images.append((replayed[key], label, exposure))

    # Exposures: 20 mm of thickness are white, and all light is as it is.
    camera, model = ["--set", "thickness=camera"], not source[0].startswith("--")
    capture("scene")
    picture("4.1 without", "scene", 1, "--set", "features=diffusion")
    picture("4.1 with forward scattering", "scene", 1, *camera)
    picture("4.3 thickness", "scene", .05, *camera, "--debug", "thickness")
    picture("4.3 transmittance", "scene", 1, *camera, "--debug", "transmittance")
    picture("4.3 combined", "scene", 1, *camera)
    if model:
        capture("farthest", "--back", "farthest")
        picture("4.5 farthest: thickness", "farthest", .05, *camera, "--debug", "thickness")
        picture("4.5 farthest back face", "farthest", 1, *camera)
        picture("4.5 nearest back face", "scene", 1, *camera)
    capture("unshadowed", "--shadow-size", 0)
    picture("4.6 without shadow map", "unshadowed", 1, *camera)
    picture("4.6 with shadow map", "scene", 1, *camera)
    picture("4.9 equal in R, G, B", "scene", 1, *camera, "--set", "filter=.373,.373,.373")
    picture("4.9 .55 .29 .28", "scene", 1, *camera, "--set", "filter=.55,.29,.28")
    if model:
        capture("simplified", "--simplify", .05)
        picture("4.10 full model", "scene", 1, *camera)
        picture("4.10 a twentieth of the triangles", "simplified", 1, *camera)
    picture("5.2 full light", "scene", 1, *camera)
    picture("5.2 a quarter of it", "scene", 1, *camera, "--set", "filter=.25,.25,.25")
    picture("5.3 thesis", "scene", 1, *camera)
    physical, truth = pellucid.path("physical.exr"), pellucid.path("truth.exr")
    pellucid.run("replay", pellucid.path("scene.exr"), "--repeat", 0, "--set", "gather=16", "-o", physical)
    pellucid.run("truth", *source, *size, "--seconds", 20, "--overwrite", "-o", truth)
    images += [(physical, "5.3 Pellucid", 1), (truth + "@truth", "5.3 path traced, 20 s", 1)]
    files, labels, exposures = zip(*images)
    sheet(files, pellucid.path("thesis.png"), 5, exposures, labels)
    print("wrote", pellucid.path("thesis.png"))
    angles(pellucid)


# ---- Figures 4.7 and 4.8: curves of the angle between camera and light

QUADRATIC = [2.14506, -2.27844, 0.595752]  # equation 4.4, lowest power first; radians
CUBIC = [-5.07621, 7.75534, -3.9017, 0.650897]  # equation 4.5


def angle_factors(radians):
    """Curves by name: what --set angle=cosine, inverse-cosine and polynomial make of the angle."""
    cosine = -numpy.cos(radians)
    printed = [numpy.polynomial.polynomial.polyval(radians, c) for c in (QUADRATIC, CUBIC)]
    return {
        "dot product": numpy.clip(cosine, 0, 1),
        "inverse cosine": numpy.clip(1 - 2 * numpy.arccos(numpy.clip(cosine, -1, 1)) / math.pi, 0, 1),
        "quadratic, eq. 4.4": printed[0],
        "cubic, eq. 4.5": printed[1],
        "clamped, polynomial=quadratic": numpy.clip(printed[0], 0, 1),
        "clamped, polynomial=cubic": numpy.clip(printed[1], 0, 1),
    }


def angles(pellucid):
    pyplot = plotting()
    degrees = numpy.linspace(90, 180, 181)
    curves = list(angle_factors(numpy.radians(degrees)).items())
    figure, panels = pyplot.subplots(1, 2, figsize=(14.4, 5.2))
    for panel, title, shown in zip(panels, ("4.7", "4.8"), (curves[:2], curves[2:])):
        for (name, values), color in zip(shown, ("tab:red", "tab:blue", "tab:gray", "tab:green")):
            panel.plot(degrees, values, "--" if name.startswith("clamped") else "-", color=color, label=name)
        panel.set(title=f"Whelan 2009, figure {title}", xlabel="angle between camera and light, degrees",
                  ylabel="factor of the light that comes through", xlim=(90, 180), ylim=(-.2, 1.4))
        panel.grid(True, color="0.9")
        panel.legend(loc="upper left")
    figure.tight_layout()
    figure.savefig(pellucid.path("angles.png"), dpi=100)
    print("wrote", pellucid.path("angles.png"))


def plotting():
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    return pyplot


# ---- Tables 5.1 to 5.3: times

# The thesis turns the light faster than the head, and does not say how fast. In its table 5.1 a threshold of .005 leaves
# .59 of the cost of transmittance, and one of .01 .32: what a light does that turns once in 1000 frames. The head turns
# once in 2500, so that both come round together.
FRAMES, HEAD_TURN, LIGHT_TURN, TIMED = 5000, 2500, 1000, 12


def turntable_cosines():
    """Of the directions from the head to the eye and to the light, which is raised by a fifth, in each frame."""
    return numpy.cos(2 * math.pi * numpy.arange(FRAMES) / LIGHT_TURN) / math.hypot(1, .2)


def coherent_share(cosines, threshold, necessary=None):
    """Share of the frames in which the cosine has changed by more than the threshold since transmittance was computed last.
    Frames that are not necessary compute none and keep nothing."""
    kept, computed = None, 0
    for k, cosine in enumerate(cosines):
        if necessary is not None and not necessary[k]:
            kept = None
        elif kept is None or abs(cosine - kept) > threshold:
            kept, computed = cosine, computed + 1
    return computed / len(cosines)


def times(pellucid, source):
    cosines = turntable_cosines()
    necessary = cosines < 0
    picked = [i * FRAMES // TIMED for i in range(TIMED)]
    size = [] if "--size" in source else ["--size", "1280x720"]
    pellucid.run("capture", *source, *size, "--camera", "auto", "--light=directional:0,-.2,-1", "--turntable", HEAD_TURN,
                 "--light-turntable", LIGHT_TURN, "--frames", ",".join(str(k + 1) for k in picked), "-o",
                 pellucid.path("turn.####.exr"))

    def mean(frames, *options):
        found = []
        for k in frames:
            said = pellucid.run("replay", pellucid.path(f"turn.{k + 1:04}.exr"), *options, "-o", pellucid.path("turned.exr"))
            found.append(float(re.search(r"^all\s+([\d.]+)", said, re.M).group(1)))
        return sum(found) / len(found)

    diffused = mean(picked, "--set", "features=diffusion")
    through = mean([k for k in picked if necessary[k]], "--mode", "thesis", "--set", "features=translucency")
    if through == 0:
        raise Refused("times: no light comes through the model; --material '*=skin1' makes it of skin")
    whole = mean(picked)
    share = numpy.mean(necessary)
    coherent = {t: coherent_share(cosines, t) for t in (.005, .01)}
    both = {t: coherent_share(cosines, t, necessary) for t in (.005, .01)}
    rows = [  # table, row, microseconds, frames per second of the thesis
        ("5.1", "diffusion", diffused, 304),
        ("5.1", "diffusion + transmittance", diffused + through, 217),
        ("5.1", "the same, when necessary", diffused + share * through, 248),
        ("5.1", "coherence .005", diffused + coherent[.005] * through, 246),
        ("5.1", "coherence .01", diffused + coherent[.01] * through, 269),
        ("5.1", "when necessary, coherence .005", diffused + both[.005] * through, 266),
        ("5.1", "when necessary, coherence .01", diffused + both[.01] * through, 282),
        ("5.3", "alternate frames", diffused + through / 2, 261),
        ("5.3", "alternate frames, when necessary, coherence .005", diffused + both[.005] * through / 2, 296),
        ("-", "Pellucid, 8 samples", whole, None),
    ]
    print(f"of {FRAMES} frames: {share:.3f} with light that comes through; coherence .005 computes {coherent[.005]:.3f}, "
          f".01 {coherent[.01]:.3f}; with both {both[.005]:.3f} and {both[.01]:.3f}")
    print(f"{'table':<6}{'row':<50}{'us':>10}{'effect':>9}{'thesis':>9}")
    for table, name, microseconds, fps in rows:
        theirs = f"{304 / fps - 1:+9.1%}" if fps else "        -"
        print(f"{table:<6}{name:<50}{microseconds:10.1f}{microseconds / diffused - 1:+9.1%}{theirs}")
    print("Without the rasterizer's passes, which the thesis's times contain. Table 5.2 takes its passes away one by one,\n"
          "and the other rows of 5.3 join them: the command's translucency is one dispatch.")


# ---- 4.6.2: minimum dots


def swing_directions(entries, steps):
    """For each light around +y, beginning at +z: its direction, and dots and directions of the eye, which swings about +y from
    90 degrees beside the light to opposite it, both ways."""
    for i in range(entries):
        azimuth = 2 * math.pi * i / entries
        light = numpy.array([math.sin(azimuth), 0, math.cos(azimuth)])
        sideways = numpy.cross([0, 1, 0], light)
        eyes = []
        for step in range(steps + 1):
            dot = math.cos(math.pi / 2 * (1 + step / steps)) if step else 0
            away = math.sqrt(max(0, 1 - dot * dot)) * sideways
            eyes.append((dot, [dot * light + away, dot * light - away] if step < steps else [dot * light]))
        yield light, eyes


def minimum_dots(swings, threshold):
    """swings: for each light (dot, light that comes through) of each step. The dot at which more than `threshold` of the most
    light of all comes through for the first time, linear between two steps; -1 where it never does."""
    enough = threshold * max(light for swing in swings for _, light in swing)
    dots = []
    for swing in swings:
        first = next((i for i, (_, light) in enumerate(swing) if light > enough), None)
        dot = -1
        if first == 0:
            dot = 0
        elif first is not None:
            (d0, l0), (d1, l1) = swing[first - 1], swing[first]
            dot = d0 + (d1 - d0) * (enough - l0) / (l1 - l0)
        dots.append(round(dot, 4) + 0.0)
    return dots


def light_through(pellucid, source, light, eye):
    """Mean over the material's pixels and the channels."""
    from matplotlib import image

    def numbers(values):
        return ",".join(f"{v:.6f}" for v in values)

    capture, triptych = pellucid.path("dot.exr"), pellucid.path("dot.png")
    pellucid.run("capture", *source, "--size", "64x64", "--shadow-size", 128, "--projection", "orthographic",
                 "--camera", "auto", "--view=" + numbers(eye), "--light=directional:" + numbers(-light), "-o", capture)
    # Gathered light knows no minimum dot.
    linear = []
    for exposure in (1, 32):  # eight bits of bright and of dark pixels
        pellucid.run("replay", capture, "--repeat", 0, "--set", "features=translucency", "--set", "gather=0",
                     "--exposure", exposure, "--triptych", triptych, "-o", pellucid.path("dot.out.exr"))
        encoded = image.imread(triptych)[..., :3]
        left = (encoded.shape[1] - 64) // 2
        middle = encoded[:, left : left + 64]
        linear.append(numpy.where(middle <= .04045, middle / 12.92, ((middle + .055) / 1.055) ** 2.4) / exposure)
    light_alone = numpy.where(linear[1] < .99 / 32, linear[1], linear[0])
    pixels = sum(map(int, re.findall(r"^  material: index .* pixels (\d+)", pellucid.run("info", capture), re.M)))
    return float(light_alone.sum()) / 3 / max(pixels, 1)


def dots(pellucid, source, entries=12, steps=6, threshold=.25):
    swings = []
    for i, (light, eyes) in enumerate(swing_directions(entries, steps)):
        swings.append([(dot, max(light_through(pellucid, source, light, eye) for eye in ways)) for dot, ways in eyes])
        print(f"light {i + 1} of {entries}", file=sys.stderr)
    found = minimum_dots(swings, threshold)
    table = {"angle": "minimum-dot-azimuth", "face": [0, 0, 1], "up": [0, 1, 0], "minimum-dots": found}
    with open(pellucid.path("dots.json"), "w", encoding="utf-8") as file:
        json.dump(table, file, indent=2)
    print(f"wrote {pellucid.path('dots.json')}: {entries} entries from {min(found)} to {max(found)}; --set @FILE uses it, and "
          "--set center=X,Y,Z says where the object is, for lights that are not directional")


# ---- 3.4.1 and table 5.4: perception


def views(pellucid, color, source):
    """The camera stands -50 to 50 degrees from the front."""
    from sheet import sheet

    frames = [32, 34, 36, 2, 4, 6]
    chosen = ",".join(map(str, sorted(frames)))
    pellucid.run("capture", *source, "--turntable", 36, "--orbit", "--frames", chosen, "-o", pellucid.path("capture.##.exr"))
    pellucid.run("replay", pellucid.path("capture.##.exr"), "--frames", chosen, "--overwrite", "--set", "filter=" + color, "-o",
                 pellucid.path("view.##.exr"))
    sheet([pellucid.path(f"view.{frame:02}.exr") for frame in frames], pellucid.path("views.png"))
    print("wrote", pellucid.path("views.png"))


HEADER = ["participant", "scene", "red", "green", "blue", "seconds"]


def read_answers(file):
    """Scenes and participants in the file's order, and colors[channel, scene, participant]."""
    with open(file, encoding="utf-8", newline="") as lines:
        rows = list(csv.reader(lines))
    if not rows or rows[0] != HEADER:
        raise Refused(f"{file}: does not begin with \"{','.join(HEADER)}\"")
    answers = {}
    for number, row in enumerate(rows[1:], 2):
        if not row:
            continue
        where = f"{file}:{number}"
        try:
            color = [float(text) for text in row[2:5]]
        except ValueError as error:
            raise Refused(f"{where}: {error}") from error
        if len(row) != len(HEADER) or not all(0 <= c <= 1 for c in color):
            raise Refused(f"{where}: \"{','.join(row)}\" is not six fields with colors of 0..1")
        if (row[0], row[1]) in answers:
            raise Refused(f"{where}: \"{row[0]}\" has answered scene \"{row[1]}\" twice")
        answers[row[0], row[1]] = color
    participants, scenes = (list(dict.fromkeys(key[i] for key in answers)) for i in (0, 1))
    if len(participants) < 2 or len(scenes) < 2:
        raise Refused(f"{file}: an analysis needs two participants and two scenes; there are {len(participants)} and "
                      f"{len(scenes)}")
    for participant, scene in itertools.product(participants, scenes):
        if (participant, scene) not in answers:
            raise Refused(f"{file}: \"{participant}\" has not answered scene \"{scene}\"")
    colors = numpy.array([[answers[p, s] for p in participants] for s in scenes])  # scene, participant, channel
    return scenes, participants, numpy.moveaxis(colors, 2, 0)


def two_way_anova(cells):
    """cells[i, j, k]: answers at level i of the first factor and j of the second. Fixed effects with interaction (Montgomery,
    Design and Analysis of Experiments, 5.3). Squares, degrees, F and P by source; the residual has no F."""
    from scipy import stats

    a, b, n = cells.shape
    all_, first, second, mean = cells.mean(), cells.mean((1, 2)), cells.mean((0, 2)), cells.mean(2)
    squares = {
        "first": (n * b * ((first - all_) ** 2).sum(), a - 1),
        "second": (n * a * ((second - all_) ** 2).sum(), b - 1),
        "interaction": (n * ((mean - first[:, None] - second + all_) ** 2).sum(), (a - 1) * (b - 1)),
    }
    residual = (((cells - mean[..., None]) ** 2).sum(), a * b * (n - 1))
    noise = residual[0] / residual[1]
    table = {}
    for source, (value, degrees) in squares.items():
        f = value / degrees / noise if noise > 0 else (math.inf if value > 0 else 0.0)
        table[source] = (value, degrees, f, stats.f.sf(f, degrees, residual[1]))
    table["residual"] = (*residual, None, None)
    return table


def compare_levels(cells, table):
    """Bonferroni's comparisons of the first factor's levels 0 and 1 at each level of the second: difference, t and P."""
    from scipy import stats

    squares, degrees = table["residual"][:2]
    error = math.sqrt(2 * squares / degrees / cells.shape[2])
    for difference in (cells[0] - cells[1]).mean(1):
        t = abs(difference) / error if error > 0 else (math.inf if difference else 0.0)
        yield difference, t, min(1.0, 2 * stats.t.sf(t, degrees) * cells.shape[1])


def significance(p):
    return "***" if p < .001 else "**" if p < .01 else "*" if p < .05 else "ns"


def perception(file):
    scenes, participants, colors = read_answers(file)
    # Red is the largest by construction of the question; the thesis compares green and blue.
    pair = colors[1:]
    table = two_way_anova(pair)
    print(f"{len(participants)} participants\n{'scene: mean, st. error':<24}{'red':>23}{'green':>23}{'blue':>23}")
    means, errors = colors.mean(2), colors.std(2, ddof=1) / math.sqrt(len(participants))
    for j, scene in enumerate(scenes):
        print(f"{scene:<24}" + "".join(f"{means[c, j]:14.4f} {errors[c, j]:8.4f}" for c in range(3)))
    print(f"\nanalysis of variance, green and blue\n{'':<16}{'squares':>13}{'degrees':>9}{'F':>11}{'P':>11}")
    for name, (squares, degrees, f, p) in zip(("channel", "scene", "interaction", "residual"), table.values()):
        print(f"{name:<16}{squares:13.5g}{degrees:9}" + ("" if f is None else f"{f:11.4g}{p:11.3g} {significance(p)}"))
    print(f"\ngreen against blue, Bonferroni's comparisons\n{'scene':<24}{'difference':>13}{'t':>11}{'P':>11}")
    for scene, (difference, t, p) in zip(scenes, compare_levels(pair, table)):
        print(f"{scene:<24}{difference:13.4f}{t:11.3f}{p:11.3g} {significance(p)}")


def main(command, folder, *rest):
    pellucid, rest = Pellucid(command, folder), list(rest)
    task = rest.pop(0) if rest and rest[0] in ("figures", "angles", "times", "dots", "views", "perception") else "figures"
    if task == "angles":
        angles(pellucid)
    elif task == "perception":
        if len(rest) != 1:
            raise Refused("perception: which answers?")
        perception(rest[0])
    elif task in ("times", "dots"):
        if not rest or rest[0].startswith("-"):
            raise Refused(f"{task}: which model? Procedural scenes have cameras and lights of their own")
        {"times": times, "dots": dots}[task](pellucid, rest)
    elif task == "views":
        if not rest:
            raise Refused("views: which color filter, as R,G,B?")
        views(pellucid, rest[0], scene_of(rest[1:]))
    else:
        figures(pellucid, scene_of(rest))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
    except (Refused, OSError) as refusal:
        sys.exit(f"thesis.py: {refusal}")
