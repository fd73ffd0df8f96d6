"""EXR files of one size side by side in a PNG, under one exposure.

    python3 sheet.py FILE[@LAYER]... -o PNG [--columns N] [--exposure E[,E...]] [--label WORDS]...

Needs numpy, Pillow and OpenImageIO (Debian: python3-numpy, python3-pil, python3-openimageio).
"""
import argparse
import os

import numpy
import OpenImageIO
from PIL import Image, ImageDraw

GAP = 4


def read(name):
    """R, G and B of FILE or FILE@LAYER."""
    path, layer = name.rsplit("@", 1) if "@" in name and not os.path.exists(name) else (name, "")
    source = OpenImageIO.ImageInput.open(path)
    if source is None:
        raise SystemExit(f"{name}: {OpenImageIO.geterror()}")
    names, pixels = source.spec().channelnames, source.read_image("float")
    wanted = [layer and layer + "." + c or c for c in "RGB"]
    if not set(wanted) <= set(names):
        raise SystemExit(f"{name}: the file has no channels {', '.join(wanted)}, but {', '.join(names)}")
    return pixels[..., [names.index(c) for c in wanted]]


def srgb(linear):
    linear = numpy.clip(numpy.nan_to_num(linear), 0, 1)
    return numpy.rint(255 * numpy.where(linear <= .0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - .055)).astype("uint8")


def sheet(files, output, columns=3, exposures=(), labels=()):
    """exposures: none for the 99th percentile at 0.8, one for all, or one for each file. labels: none, or one for each."""
    images = [read(file) for file in files]
    for file, image in zip(files, images):
        if image.shape != images[0].shape:
            raise SystemExit(f"{file}: the image is {image.shape[1]} x {image.shape[0]}, and {files[0]} {images[0].shape[1]} x {images[0].shape[0]}")
    for name, values, least in (("--exposure", exposures, 1), ("--label", labels, len(files))):
        if values and len(values) not in (least, len(files)):
            raise SystemExit(f"{name}: {len(values)} are given for {len(files)} images")
    if not exposures:
        lit = numpy.concatenate([image[numpy.isfinite(image) & (image > 0)] for image in images])
        exposures = [.8 / numpy.percentile(lit, 99) if lit.size else 1]
    if len(exposures) == 1:
        exposures = exposures * len(files)
    height, width = images[0].shape[:2]
    columns = min(columns, len(files))
    rows = -(-len(files) // columns)
    picture = Image.new("RGB", (columns * (width + GAP) - GAP, rows * (height + GAP) - GAP))
    for i, image in enumerate(images):
        part = Image.fromarray(srgb(image * exposures[i]))
        if labels:
            draw = ImageDraw.Draw(part)
            _, _, right, bottom = draw.textbbox((2, 2), labels[i])
            draw.rectangle((0, height - bottom - 2, right + 2, height), fill="black")
            draw.text((2, height - bottom), labels[i], fill="white")
        picture.paste(part, (i % columns * (width + GAP), i // columns * (height + GAP)))
    picture.save(output)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="EXR files of one size side by side in a PNG.")
    parser.add_argument("files", nargs="+", metavar="FILE[@LAYER]")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--columns", type=int, default=3)
    parser.add_argument("--exposure", default="", help="a factor, or one for each file; default: from the pictures")
    parser.add_argument("--label", action="append", default=[], help="words on a picture: one for each file, in their order")
    given = parser.parse_args()
    sheet(given.files, given.output, given.columns, [float(e) for e in given.exposure.split(",") if e], given.label)
