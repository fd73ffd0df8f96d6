"""Renders a scene of Blender as captures: passes, back faces, shadow maps, and one whole manifest a frame.  docs/captures.md

    blender -b scene.blend -P blender_capture.py -- -o out/                   the current frame: out/capture.json
    blender -b scene.blend -P blender_capture.py -- -o out/ --frames 1-250    out/capture.0001.json and so on

Options: --replay build/bin/pellucid (also makes out/picture.exr and .png), --shadow-size 1024, --samples 16 (of soft and bounced
light), --truth SAMPLES (diffuse light of the file's own materials, with its standard error).
The scene in the file stays as it is. Installed as an add-on, the script has a panel in the properties of the render.
"""
import argparse
import array
import contextlib
import fnmatch
import json
import math
import operator
import os
import struct
import subprocess
import sys
import tempfile

import bpy
from mathutils import Matrix, Vector

bl_info = {"name": "Pellucid capture", "author": "Pellucid", "version": (0, 2, 0), "blender": (3, 4, 0),
           "location": "Properties > Render > Pellucid", "category": "Render",
           "description": "Renders the frame as a capture for pellucid replay"}

VULKAN_FROM_OPENGL = Matrix(((1, 0, 0, 0), (0, -1, 0, 0), (0, 0, 0.5, 0.5), (0, 0, 0, 1)))
LIGHT_KINDS = {"SUN": "directional", "POINT": "point", "SPOT": "spot", "AREA": "point"}


def sheet_factors(spread):
    """Light of a sheet that shines to one side, at equal steps of the angle, over that ahead without spread; Cycles' grid of slats."""
    half = max(spread, math.radians(1)) / 2
    angles = [min(math.pi * i / 63, math.pi / 2) for i in range(64)]
    if half > 1.57:
        return [math.cos(angle) for angle in angles]
    return [math.cos(angle) * max(1 - math.tan(angle) / math.tan(half), 0) / (1 - half / math.tan(half)) for angle in angles]


# A map wider than this has no texels left in its middle: six faces of a cube take its place.
WIDEST_VIEW = math.radians(150)


def column_major(matrix):
    return [matrix[row][column] for column in range(4) for row in range(4)]


def rigid_inverse(matrix):
    """View space of an object: its matrix without scale, inverted."""
    location, rotation, _ = matrix.decompose()
    return (Matrix.Translation(location) @ rotation.to_matrix().to_4x4()).inverted()


class Refused(Exception):
    """Says in a sentence what the scene lacks."""


SAID = set()


def say(sentence):
    """Once a run: frames have most sentences in common."""
    if sentence not in SAID:
        SAID.add(sentence)
        print("pellucid:", sentence, file=sys.stderr)


# ---- Materials


def dipole_alpha(reflectance, boundary):
    """The reduced albedo whose dipole reflects so much; Cycles, bssrdf_dipole_compute_alpha_prime."""
    if reflectance < 1e-4:
        return 0.0
    if reflectance >= 0.995:
        return 0.999999
    low, high = 0.0, 1.0
    for _ in range(12):
        middle = 0.5 * (low + high)
        s = math.sqrt(3 * (1 - middle))
        if 0.5 * middle * (1 + math.exp(-boundary * s)) * math.exp(-s) < reflectance:
            low = middle
        else:
            high = middle
    return middle


def walk_albedo(color, g):
    """The single-scattering albedo of Cycles' random walk (Wrenninge, Villemin and Hery 2017)."""
    def series(*factors):
        return sum(factor * g ** i for i, factor in enumerate(factors))

    a = series(1.8260523782, -1.28451056436, -1.79904629312, 9.19393289202, -22.8215585862, 32.0234874259,
               -23.6264803333, 7.21067002658)
    b = 4.98511194385 + 0.127355959438 * math.exp(series(
        0, 31.1491581433, -201.847017512, 841.576016723, -2018.09288505, 2731.71560286, -1935.41424244, 559.009054474))
    c = series(1.09686102424, -0.394704063468, 1.05258115941, -8.83963712726, 28.8643230661, -46.8802913581,
               38.5402837518, -12.7181042538)
    d = series(0.496310210422, 0.360146581622, -2.15139309747, 17.8896899217, -55.2984010333, 82.065982243,
               -58.5106008578, 15.8478295021)
    e = 4.23190299701 + 0.00310603949088 * math.exp(series(
        0, 76.7316253952, -594.356773233, 2448.8834203, -5576.68528998, 7116.60171912, -4763.54467887, 1303.5318055))
    f = series(2.40602999408, -2.51814844609, 9.18494908356, -79.2191708682, 259.082868209, -403.613804597,
               302.85712436, -87.4370473567)
    blend = color ** 0.25
    albedo = (1 - blend) * a * math.atan(b * color) ** c + blend * d * math.atan(e * color) ** f
    return min(max(albedo, 0.0), 0.999999)


# Steps after which Cycles' walk goes on in the reduced medium, and forgets its direction.
STEPS_WITH_DIRECTION = 10


def walk_density(g):
    """The factor of the scattering that what a walk forgets looks like. A fit to such walks through slabs of .3 to 4 path lengths:
    it errs by 4 % of what comes through in channels of albedo .5 and more, by 10 % in darker ones."""
    return 1 + 0.45 * g / (STEPS_WITH_DIRECTION * (1 - g)) ** 1.5


def medium(radius, color, g, ior, name, millimeters):
    """Scattering coefficients of Cycles' random walk, 1/mm, as a manifest has them."""
    # Fresnel's mean reflectance inside, as Cycles has it from Jensen.
    f_dr = (-1.440 / ior + 0.710) / ior + 0.668 + 0.0636 * ior
    boundary = 4 / 3 * (1 + f_dr) / (1 - f_dr)
    scattering, absorption = [], []
    for length, albedo in zip(radius, color):
        if walks_in_skin(name):
            length *= math.sqrt(3 * (1 - dipole_alpha(albedo, boundary)))
        else:
            length *= 0.25 / math.pi
        sigma_t = 1 / max(length * millimeters, 1e-4) / (1 - g)
        alpha = walk_albedo(albedo, g)
        # Six digits, so that pictures of equal numbers give equal media.
        scattering.append(float(f"{walk_density(g) * alpha * sigma_t:.6g}"))
        absorption.append(float(f"{(1 - alpha) * sigma_t:.6g}"))
    # Light enters a random walk diffusely, without refraction.
    return {"scattering": scattering, "absorption": absorption, "g": g, "ior": 1}


# Cycles ends a walk after 256 steps. A thick body of color .99 reflects so much.
MOST_REFLECTED = 0.93


def walk_reflectance(record):
    """What a thick body of a medium reflects in Cycles, of each channel. It is not the color where g > 0."""
    reflectance = []
    for scattering, absorption in zip(record["scattering"], record["absorption"]):
        reduced = scattering * (1 - record["g"])
        albedo = reduced / (reduced + absorption)
        low, high = 0.0, MOST_REFLECTED
        for _ in range(30):
            middle = (low + high) / 2
            low, high = (middle, high) if walk_albedo(middle, 0) < albedo else (low, middle)
        reflectance.append(low)
    return reflectance


def walk_factor(record, color):
    """Of each channel; 1 where it is so within a hundredth."""
    factors = [found / given if given > 0 else 1 for found, given in zip(walk_reflectance(record), color)]
    return [factor if abs(factor - 1) > 0.01 else 1 for factor in factors]


# Shaders that reflect diffuse light. What the others of a material do is no part of a capture, but for holes.
DIFFUSE_SHADERS = ("BSDF_PRINCIPLED", "SUBSURFACE_SCATTERING", "BSDF_DIFFUSE")
HOLES = ("BSDF_TRANSPARENT", "HOLDOUT")
NO_LIGHT = ("BSDF_GLOSSY", "BSDF_ANISOTROPIC", "BSDF_GLASS", "BSDF_REFRACTION", "EMISSION")


def output_node(material):
    tree = material.node_tree
    return tree.get_output_node("CYCLES") or tree.get_output_node("ALL")


def shaders_behind(tree, socket, groups=()):
    """(tree, node) of the shaders that feed a socket, through mixes, groups, reroutes and muted nodes."""
    for link in socket.links:
        if link.is_muted:
            continue
        node, output = link.from_node, link.from_socket
        if node.mute:
            for passed in node.internal_links:
                if passed.to_socket == output:
                    yield from shaders_behind(tree, passed.from_socket, groups)
        elif node.type == "REROUTE":
            yield from shaders_behind(tree, node.inputs[0], groups)
        elif node.type == "GROUP" and node.node_tree:
            index = list(node.outputs).index(output)
            for end in node.node_tree.nodes:
                if end.type == "GROUP_OUTPUT" and end.is_active_output:
                    yield from shaders_behind(node.node_tree, end.inputs[index], groups + ((tree, node),))
        elif node.type == "GROUP_INPUT":
            outer, group = groups[-1]
            yield from shaders_behind(outer, group.inputs[list(node.outputs).index(output)], groups[:-1])
        elif node.type in ("MIX_SHADER", "ADD_SHADER"):
            for mixed in node.inputs:
                if mixed.type == "SHADER":
                    yield from shaders_behind(tree, mixed, groups)
        else:
            yield tree, node


def shaders(material):
    """Those of a material's surface, each once."""
    output = output_node(material) if material and material.use_nodes else None
    found = {}
    for tree, node in shaders_behind(material.node_tree, output.inputs["Surface"]) if output else ():
        found.setdefault(node.as_pointer(), (tree, node))
    return list(found.values())


def first_input(node, *names):
    """The socket of the first name, as versions of Blender have it; None: the node has none."""
    return next((node.inputs[name] for name in names if name in node.inputs), None)


def every_shader(materials):
    """Those of several materials, which may share groups, each once."""
    return list({node.as_pointer(): (tree, node) for m in materials for tree, node in shaders(m)}.values())


def subsurface_weight(node):
    return first_input(node, "Subsurface Weight", "Subsurface")


def may_scatter(node):
    """Whether light may go under the surface of a shader."""
    if node.type == "SUBSURFACE_SCATTERING":
        return True
    if node.type != "BSDF_PRINCIPLED":
        return False
    weight = subsurface_weight(node)
    return bool(weight.links) or weight.default_value > 0


def method(node):
    return node.falloff if node.type == "SUBSURFACE_SCATTERING" else node.subsurface_method


def walks_in_skin(name):
    """Whether Cycles takes the radius for a diffusion's length and not for that of a path."""
    return name == "RANDOM_WALK_SKIN" or (name == "RANDOM_WALK" and bpy.app.version < (4, 0))


class Beside:
    """New nodes beside a shader that compute from its inputs, whatever feeds these."""

    def __init__(self, tree, node):
        self.tree, self.node, self.made = tree, node, []

    def new(self, kind, **settings):
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        self.made.append(node)
        return node

    def feed(self, source, target):
        """Gives a socket a number, three numbers, what an output has, or what feeds an input."""
        if isinstance(source, bpy.types.NodeSocket):
            if source.is_output or source.links:
                self.tree.links.new(source if source.is_output else source.links[0].from_socket, target)
                return
            source = source.default_value
        given = list(source) if hasattr(source, "__len__") else [source] * 3
        if hasattr(target.default_value, "__len__"):
            target.default_value = given[:3] + [1] * (len(target.default_value) - 3)
        else:
            target.default_value = given[0]

    def operation(self, kind, name, *operands):
        node = self.new(kind, operation=name)
        for operand, socket in zip(operands, node.inputs):
            self.feed(operand, socket)
        return node.outputs[0]

    def math(self, name, *operands):
        return self.operation("ShaderNodeMath", name, *operands)

    def times(self, vector, factor):
        node = self.new("ShaderNodeVectorMath", operation="SCALE")
        self.feed(vector, node.inputs[0])
        self.feed(factor, node.inputs["Scale"])
        return node.outputs[0]

    def sum(self, a, b):
        return self.operation("ShaderNodeVectorMath", "ADD", a, b)

    def triple(self, *numbers):
        node = self.new("ShaderNodeCombineXYZ")
        for number, socket in zip(numbers, node.inputs):
            self.feed(number, socket)
        return node.outputs[0]

    def own_color(self):
        """Of the diffuse light, on and under the surface, before the part of it that metal and glass take."""
        if self.node.type != "BSDF_PRINCIPLED":
            return self.node.inputs["Color"]
        color, below = self.node.inputs["Base Color"], first_input(self.node, "Subsurface Color")
        if below:
            weight = subsurface_weight(self.node)
            color = self.sum(self.times(color, self.math("SUBTRACT", 1, weight)), self.times(below, weight))
        return color

    def color(self):
        """What diffuse light is reflected; Cycles, svm_node_closure_bsdf."""
        if self.node.type != "BSDF_PRINCIPLED":
            return self.own_color()
        diffuse = self.math("MULTIPLY", self.math("SUBTRACT", 1, self.node.inputs["Metallic"]),
                            self.math("SUBTRACT", 1, first_input(self.node, "Transmission Weight", "Transmission")))
        return self.times(self.own_color(), diffuse)

    def share(self):
        """The part of this light that goes under the surface."""
        if self.node.type != "BSDF_PRINCIPLED":
            return float(self.node.type == "SUBSURFACE_SCATTERING")
        weight = subsurface_weight(self.node)
        # Before 4.0 the weight scales the radius.
        return self.math("GREATER_THAN", weight, 1e-5) if "Subsurface Color" in self.node.inputs else weight

    def radius(self):
        if self.node.type == "SUBSURFACE_SCATTERING":
            return self.times(self.node.inputs["Radius"], self.node.inputs["Scale"])
        if self.node.type == "BSDF_DIFFUSE":
            return 0.0
        scale = first_input(self.node, "Subsurface Scale") or subsurface_weight(self.node)
        return self.times(self.node.inputs["Subsurface Radius"], scale)

    def medium(self):
        """1, anisotropy, index of refraction."""
        node = self.node
        of_skin = node.type != "BSDF_DIFFUSE" and walks_in_skin(method(node))
        ior = first_input(node, *(("Subsurface IOR", "IOR") if of_skin else ("IOR", "Subsurface IOR")))
        return self.triple(1.0, first_input(node, "Subsurface Anisotropy", "Anisotropy") or 0.0, ior or 1.4)

    def with_holes(self, node):
        """The shader where the material's alpha has no holes."""
        alpha = self.node.inputs.get("Alpha")
        if not alpha or not alpha.links and alpha.default_value == 1:
            return node
        mix = self.new("ShaderNodeMixShader")
        self.feed(alpha, mix.inputs[0])
        self.tree.links.new(self.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
        self.tree.links.new(node.outputs[0], mix.inputs[2])
        return mix

    def diffuse(self):
        """A shader that reflects all of the diffuse light at the surface, by the lobe of the material's own shader."""
        if self.node.type == "BSDF_PRINCIPLED":  # before 4.0 its roughness makes grazing light 14 % brighter, or 30 % darker
            node = self.new("ShaderNodeBsdfPrincipled")
            self.feed(self.color(), node.inputs["Base Color"])
            self.feed(self.node.inputs["Roughness"], node.inputs["Roughness"])
            subsurface_weight(node).default_value = first_input(node, "Specular IOR Level", "Specular").default_value = 0
        else:
            node = self.new("ShaderNodeBsdfDiffuse")
            self.feed(self.color(), node.inputs["Color"])
        normal = self.node.inputs.get("Normal")
        if normal and normal.links:
            self.feed(normal, node.inputs["Normal"])
        if may_emit(self.tree, self.node):  # its glow lights others
            glow, both = self.new("ShaderNodeEmission"), self.new("ShaderNodeAddShader")
            self.feed(first_input(self.node, "Emission", "Emission Color"), glow.inputs["Color"])
            self.feed(first_input(self.node, "Emission Strength"), glow.inputs["Strength"])
            self.tree.links.new(node.outputs[0], both.inputs[0])
            self.tree.links.new(glow.outputs[0], both.inputs[1])
            node = both
        return self.with_holes(node)

    def times_by_index(self, vector, factors):
        """Times the three factors of the material's pass index; not black, so that light is known of it."""
        index, factor = self.new("ShaderNodeObjectInfo").outputs["Material Index"], (0.0, 0.0, 0.0)
        for key, value in factors.items():
            factor = self.sum(factor, self.times(value, self.math("COMPARE", index, key, 0.5)))
        seen = self.operation("ShaderNodeVectorMath", "MAXIMUM", vector, (1 / 1024,) * 3)
        return self.operation("ShaderNodeVectorMath", "MULTIPLY", seen, factor)

    def shown(self, value):
        """A shader whose picture is a value."""
        node = self.new("ShaderNodeEmission")
        self.feed(value, node.inputs["Color"])
        return self.with_holes(node)


@contextlib.contextmanager
def in_place_of(found, make):
    """While it lasts, make(Beside) stands for each of these (tree, node); where make returns None the node stays."""
    done = []
    try:
        for tree, node in found:
            beside, ends = Beside(tree, node), [link.to_socket for link in node.outputs[0].links]
            done.append((beside, ends))
            made = make(beside)
            for end in ends if made else ():
                tree.links.new(made.outputs[0], end)
        yield
    finally:
        for beside, ends in done:
            for node in beside.made:
                beside.tree.nodes.remove(node)
            for end in ends:
                beside.tree.links.new(beside.node.outputs[0], end)


def showing(value):
    """For in_place_of: a picture of a value of diffuse shaders, black of others, and holes as they are."""
    def make(beside):
        if beside.node.type in HOLES:
            return None
        return beside.shown(value(beside) if beside.node.type in DIFFUSE_SHADERS else 0.0)
    return make


@contextlib.contextmanager
def surface_of(material, make):
    """While it lasts, the material's surface is the last of the shaders that make(nodes, links) returns."""
    tree, output = material.node_tree, output_node(material)
    before = [link.from_socket for link in output.inputs["Surface"].links]
    made = make(tree.nodes, tree.links)
    tree.links.new(made[-1].outputs[0], output.inputs["Surface"])
    try:
        yield
    finally:
        for node in made:
            tree.nodes.remove(node)
        for socket in before:
            tree.links.new(socket, output.inputs["Surface"])


def scattering_materials(depsgraph):
    """Materials of what is rendered under whose surface light may go, each once."""
    found = {}
    for instance in rendered_instances(depsgraph):
        for slot in instance.object.original.material_slots:
            material = slot.material
            if material and material.name not in found and any(may_scatter(node) for _, node in shaders(material)):
                found[material.name] = material
    for material in found.values():
        for _, node in shaders(material):
            if node.type not in DIFFUSE_SHADERS + HOLES + NO_LIGHT:
                say(f"material {material.name}: node {node.name} ({node.bl_label}) is left out: no capture has such light")
        if output_node(material).inputs["Volume"].links:
            say(f"material {material.name}: its volume is left out; the surface's shaders say what is under it")
    return list(found.values())


class Measured:
    """What the camera sees of a material's values, over its pixels."""

    def __init__(self):
        self.weight, self.sums, self.low, self.high = 0.0, [0.0] * 14, [math.inf] * 14, [-math.inf] * 14

    def add(self, share, values):
        self.weight += share
        for i, value in enumerate(values):
            self.sums[i] += value
            self.low[i], self.high[i] = min(self.low[i], value / share), max(self.high[i], value / share)

    def mean(self, first, count=1):
        found = [total / self.weight for total in self.sums[first:first + count]]
        return found if count > 1 else found[0]

    def part(self):
        """Of all light the part that goes under the surface, of each channel; not 0, so that light is known there."""
        return [max(self.sums[UNDER + i] / self.sums[ALL + i], 1 / 1024) if self.sums[ALL + i] > 0 else 1.0 for i in range(3)]

    def varies(self, first, count=1):
        return any(high - low > 0.02 * max(abs(high), 1e-9)
                   for low, high in zip(self.low[first:first + count], self.high[first:first + count]))


# Of Measured: color under the surface, color in all, radius, anisotropy, index of refraction, color of the medium. Metal and
# glass take light before it enters, so that a medium does not darken by them.
UNDER, ALL, RADIUS, ANISOTROPY, IOR, MEDIUM = 0, 3, 6, 9, 10, 11


def measured(materials, folder):
    """By pass index: the values of each material's nodes as Cycles evaluates them, in the picture of the camera."""
    scene, found = bpy.context.scene, every_shader(materials)

    def picture(value):
        path = os.path.join(folder, "values.exr")
        with in_place_of(found, showing(value)), changed((scene.cycles, "samples", 1), (scene.cycles, "max_bounces", 0),
                                                         (scene.render.image_settings, "exr_codec", "NONE")):
            render(path)
        return read_exr(path, ("Emit.R", "Emit.G", "Emit.B", "IndexMA.X"), 2 ** 18)

    pictures = [picture(value) for value in (
        lambda b: b.times(b.medium(), b.share()), lambda b: b.times(b.color(), b.share()), lambda b: b.color(),
        lambda b: b.times(b.radius(), b.share()), lambda b: b.times(b.own_color(), b.share()))]
    result = {}
    for pixel in zip(*(channel for channels in pictures for channel in channels[:3]), pictures[0][3]):
        index, share = round(pixel[15]), pixel[0]
        if index > 0 and share > 1e-4:
            result.setdefault(index, Measured()).add(share, pixel[3:12] + pixel[1:3] + pixel[12:15])
    return result


def medium_of(material, seen, millimeters):
    """The manifest's material; says what it cannot hold."""
    methods = {method(node) for _, node in shaders(material) if may_scatter(node)}
    if len(methods) > 1:
        say(f"material {material.name}: several subsurface methods, of which {sorted(methods)[0]} is taken")
    for first, count, what in ((RADIUS, 3, "radius"), (ANISOTROPY, 1, "anisotropy"), (IOR, 1, "index of refraction")):
        if seen.varies(first, count):
            low, high = min(seen.low[first:first + count]), max(seen.high[first:first + count])
            say(f"material {material.name}: its {what} varies over the picture, from {low:.3g} to {high:.3g}: the medium "
                "has the mean")
    return medium(seen.mean(RADIUS, 3), seen.mean(MEDIUM, 3), min(max(seen.mean(ANISOTROPY), 0.0), 0.9),
                  min(max(seen.mean(IOR), 1.01), 3.8), sorted(methods)[0], millimeters)


# ---- The scene


def rendered_collections(layer_collection, into):
    if not layer_collection.exclude and not layer_collection.collection.hide_render:
        into.update(o.name for o in layer_collection.collection.objects)
        for child in layer_collection.children:
            rendered_collections(child, into)
    return into


def rendered_instances(depsgraph):
    """Instances of what a render shows, those of instanced collections too."""
    shown = rendered_collections(bpy.context.view_layer.layer_collection, set())
    for instance in depsgraph.object_instances:
        top = instance.parent.original if instance.is_instance else instance.object.original
        if top.name in shown and not top.hide_render and not instance.object.original.hide_render:
            yield instance


def boxes(depsgraph, names=None):
    """Corners of the box of each mesh that is rendered, in the world; names: only of meshes with one of these materials."""
    found = []
    for instance in rendered_instances(depsgraph):
        slots = {slot.material.name for slot in instance.object.original.material_slots if slot.material}
        if instance.object.type in ("MESH", "CURVE", "SURFACE", "META", "FONT") and (names is None or slots & names):
            found.append([instance.matrix_world @ Vector(corner) for corner in instance.object.bound_box])
    return found


def bounds(depsgraph):
    """Corners of the boxes of all meshes that are rendered, in the world."""
    corners = [corner for box in boxes(depsgraph) for corner in box]
    if not corners:
        raise Refused("the scene has nothing that a render shows")
    return corners


def source_of(socket):
    """(node, name of its output) that feeds a socket, through reroutes; None without a link."""
    while socket.links and not socket.links[0].is_muted:
        link = socket.links[0]
        if link.from_node.type != "REROUTE":
            return link.from_node, link.from_socket.name
        socket = link.from_node.inputs[0]
    return None


def constant(socket):
    """The number or color of a socket that is the same wherever light falls; raises Unread, which names the node."""
    found = source_of(socket)
    if not found:
        return socket.default_value
    node, _ = found
    if node.type == "BLACKBODY" and not node.mute and socket.type == "RGBA":
        return blackbody(constant(node.inputs["Temperature"]))
    if node.type not in ("RGB", "VALUE") or node.mute:
        raise Unread(node)
    return node.outputs[0].default_value


class Unread(Exception):
    """A node that a light's numbers cannot hold."""


def blackbody(kelvin):
    """Linear Rec. 709 of luminance 1: Planck's law and the CIE's observer in the lobes of Wyman, Sloan and Shirley (2013). Within
    2 % of Cycles' fit from 1500 to 12000 K, where that ends."""
    def lobe(x, height, center, left, right):
        return height * math.exp(-0.5 * ((x - center) / (left if x < center else right)) ** 2)

    x = y = z = 0.0
    for nm in range(380, 781, 5):
        power = nm ** -5.0 / math.expm1(1.4388e7 / (nm * min(max(kelvin, 800.0), 12000.0)))
        x += power * (lobe(nm, 1.056, 599.8, 37.9, 31.0) + lobe(nm, 0.362, 442.0, 16.0, 26.7) + lobe(nm, -0.065, 501.1, 20.4, 26.2))
        y += power * (lobe(nm, 0.821, 568.8, 46.9, 40.5) + lobe(nm, 0.286, 530.9, 16.3, 31.1))
        z += power * (lobe(nm, 1.217, 437.0, 11.8, 36.0) + lobe(nm, 0.681, 459.0, 26.0, 13.8))
    return [max((r * x + g * y + b * z) / y, 0.0) for r, g, b in (
        (3.2406, -1.5372, -0.4986), (-0.9689, 1.8758, 0.0415), (0.0557, -0.2040, 1.0570))]


# Powers of the distance by which the outputs of Light Falloff exceed 1 / distance^2.
FALLOFFS = {"Quadratic": 0, "Linear": 1, "Constant": 2}


def lamp_emission(data):
    """(color, power of the distance, smooth) of a lamp's nodes, which multiply its own color and strength."""
    if not data.use_nodes:
        return [1.0, 1.0, 1.0], 0, 0.0
    tree = data.node_tree
    output = tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
    found = output and source_of(output.inputs["Surface"])
    if not found:
        return [0.0, 0.0, 0.0], 0, 0.0
    node, power, smooth = found[0], 0, 0.0
    if node.type != "EMISSION" or node.mute:
        raise Unread(node)
    strength, fed = node.inputs["Strength"], source_of(node.inputs["Strength"])
    if fed and fed[0].type == "LIGHT_FALLOFF" and not fed[0].mute and data.type != "SUN":
        power, smooth = FALLOFFS[fed[1]], constant(fed[0].inputs["Smooth"])
        strength = fed[0].inputs["Strength"]
    scale = constant(strength)
    return [scale * value for value in list(constant(node.inputs["Color"]))[:3]], power, smooth


def is_visible(instance, kind):
    """Whether rays of a kind meet an instance, as Cycles has it."""
    return all(getattr(thing, "visible_" + kind, True)
               for thing in (instance.object.original, *((instance.parent.original,) if instance.is_instance else ())))


def casts_shadow(data):
    settings = getattr(data, "cycles", None)
    return getattr(settings, "cast_shadow", getattr(data, "use_shadow", True))


def lights(depsgraph):
    """(name, data, matrix) of the lights that a replay knows."""
    for instance in rendered_instances(depsgraph):
        if instance.object.type != "LIGHT":
            continue
        data = instance.object.original.data
        # A portal has no light of its own, and light without diffuse rays reaches no skin.
        if data.type == "AREA" and getattr(data.cycles, "is_portal", False) or not is_visible(instance, "diffuse"):
            continue
        if data.type not in LIGHT_KINDS:
            say(f"left out: light {instance.object.name} of type {data.type}")
            continue
        yield instance.object.name, data, instance.matrix_world.copy()


def light_record(name, data, matrix, corners):
    """The light of a manifest; None: a dark or a negative one."""
    # A sheet's radiant intensity ahead is a quarter of its power in Cycles.
    intensity = data.energy / {"SUN": 1, "AREA": 4}.get(data.type, 4 * math.pi)
    try:
        factors, power, smooth = lamp_emission(data)
    except Unread as unread:
        node, = unread.args
        say(f"lamp {name}: node {node.name} ({node.bl_label}) is left out of what comes through, which has the lamp's own "
            "color and strength; the irradiance has the node. Give Emission plain numbers, or Light Falloff")
        factors, power, smooth = [1.0, 1.0, 1.0], 0, 0.0
    color = [own * factor for own, factor in zip(data.color, factors)]
    if intensity * min(color) < 0:
        say(f"lamp {name}: its negative light is left out of what comes through; the irradiance has it")
    color = [max(intensity * value, 0.0) for value in color]
    if max(color) == 0:
        return None
    record = {"type": LIGHT_KINDS[data.type], "color": [value / max(color) for value in color], "intensity": max(color)}
    if data.type != "SUN":
        record["position"] = list(matrix.translation)
    if data.type != "POINT":
        record["direction"] = list(-matrix.col[2].to_3d().normalized())
    if data.type == "SPOT":
        outer = data.spot_size / 2
        record.update(outerConeAngle=outer, innerConeAngle=outer * (1 - max(data.spot_blend, 1e-3)))
    if data.type == "AREA":
        factors = sheet_factors(data.spread)
        record.update(angleTable=[factor / factors[0] for factor in factors], intensity=record["intensity"] * factors[0])
    if power > 0 or smooth > 0:
        reach = 1.1 * max((corner - matrix.translation).length for corner in corners)
        distances = [reach * i / 63 for i in range(64)]
        factors = [r ** power * (r * r / (smooth + r * r) if smooth > 0 else 1) for r in distances]
        record.update(range=reach, distanceTable=[factor / max(factors) for factor in factors],
                      intensity=record["intensity"] * max(factors))
    return record


def distance_to(box, place):
    near = [min(max(place[i], min(c[i] for c in box)), max(c[i] for c in box)) for i in range(3)]
    return (Vector(near) - place).length


def say_what_size_does(name, data, matrix, translucent):
    """Light that comes through has the place of a light's center, whatever its size. translucent: boxes()."""
    nearest = min(distance_to(box, matrix.translation) for box in translucent)
    if data.type == "SUN":
        angle = data.angle
    else:
        width = 2 * data.shadow_soft_size
        if data.type == "AREA":
            other = data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
            width = max(data.size * matrix.to_scale()[0], other * matrix.to_scale()[1])
        angle = 2 * math.atan2(width / 2, nearest)
    if math.degrees(angle) > 2:
        say(f"light {name} of type {data.type} is {math.degrees(angle):.3g} degrees wide: it is soft where the camera sees "
            "it, and in thin parts that of its center")
    if data.type == "AREA" and math.degrees(data.spread) < 35:
        say(f"light {name}: in thin parts its spread of {math.degrees(data.spread):.3g} degrees is a table of steps of 2.9 degrees")


def looking(position, direction):
    """Matrix of an object that looks along a direction from a position."""
    rotation = direction.to_track_quat("-Z", "Y").to_matrix().to_4x4()
    return Matrix.Translation(position) @ rotation


def light_views(data, matrix, corners):
    """(matrix of the camera, its orthographic width or else its angle) of each shadow map of a light."""
    position, axis = matrix.translation, -matrix.col[2].to_3d().normalized()
    center = sum(corners, Vector()) / len(corners)
    if data.type == "SUN":
        radius = max((corner - center).length for corner in corners)
        return [(looking(center - 2 * radius * axis, axis), {"width": 2.02 * radius})]
    if data.type in ("POINT", "AREA"):
        axis = center - position
    angle = math.pi
    if axis.length > 0:
        angle = 2.02 * max(axis.angle(corner - position, math.pi) for corner in corners)
    if data.type == "SPOT":
        angle = min(angle, 1.02 * data.spot_size)
    if angle < WIDEST_VIEW:
        return [(looking(position, axis), {"angle": angle})]
    # Neighbors overlap by a few texels, so that a receiver at a seam has a map around it.
    return [(looking(position, Vector(axis)), {"angle": math.radians(93)})
            for axis in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]


# ---- Rendering


@contextlib.contextmanager
def changed(*changes):
    """While it lasts, attributes have other values: (object, name, value)."""
    changes = [change for change in changes if hasattr(change[0], change[1])]  # versions of Blender differ
    before = [(thing, name, getattr(thing, name)) for thing, name, _ in changes]
    for thing, name, value in changes:
        setattr(thing, name, value)
    try:
        yield
    finally:
        for thing, name, value in before:  # in this order: a file format decides which depths there are
            setattr(thing, name, value)


def render(path):
    bpy.context.scene.render.filepath = os.path.abspath(path)
    bpy.ops.render.render(write_still=True)


@contextlib.contextmanager
def as_data(samples):
    """Settings of a render that is read as numbers: no filter, no exposure, nothing that blurs or denoises."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    settings = scene.render.image_settings
    camera = scene.camera.data
    # A box filter ignores its width.
    with changed((scene.render, "engine", "CYCLES"), (scene.cycles, "pixel_filter_type", "BLACKMAN_HARRIS"),
                 (scene.cycles, "filter_width", 0.01), (scene.cycles, "film_exposure", 1.0),
                 (scene.cycles, "samples", samples), (scene.cycles, "use_adaptive_sampling", False),
                 (scene.cycles, "use_denoising", False), (scene.cycles, "device", "CPU"), (scene.cycles, "seed", 0),
                 (scene.render, "use_motion_blur", False), (camera.dof, "use_dof", False),
                 (scene.render, "use_multiview", False), (layer, "samples", 0), (layer, "use", True),
                 *((other, "use", False) for other in scene.view_layers if other != layer),
                 (scene.cycles, "sample_clamp_direct", 0.0),
                 (scene.cycles, "light_sampling_threshold", 0.0),
                 (scene.render, "use_crop_to_border", scene.render.use_border),
                 (scene.render, "use_compositing", False), (scene.render, "use_sequencer", False),
                 (scene.render, "use_overwrite", True), (scene.render, "use_file_extension", False),
                 (settings, "file_format", "OPEN_EXR_MULTILAYER"), (settings, "color_depth", "32"),
                 (settings, "exr_codec", "ZIP"), (layer, "use_pass_emit", True),
                 (layer, "use_pass_z", True), (layer, "use_pass_diffuse_direct", True), (layer, "use_pass_diffuse_indirect", True),
                 (layer, "use_pass_diffuse_color", True), (layer, "use_pass_material_index", True),
                 (layer, "use_pass_combined", True)):
        yield


def back_faces(nodes, links):
    """Front faces are holes, so that a depth is that of the nearest back face."""
    mix = nodes.new("ShaderNodeMixShader")
    made = [nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeBsdfTransparent"), nodes.new("ShaderNodeBsdfDiffuse"), mix]
    links.new(made[0].outputs["Backfacing"], mix.inputs[0])
    links.new(made[1].outputs[0], mix.inputs[1])
    links.new(made[2].outputs[0], mix.inputs[2])
    return made


def hidden_faces(material):
    """For surface_of: camera rays see the light that arrives from outside at the nearest back face; all others see the material."""
    before = output_node(material).inputs["Surface"].links[0].from_socket

    def make(nodes, links):
        made = back_faces(nodes, links)
        translucent, ray, mix = [nodes.new("ShaderNode" + n) for n in ("BsdfTranslucent", "LightPath", "MixShader")]
        translucent.inputs["Color"].default_value = (1, 1, 1, 1)
        links.new(translucent.outputs[0], made[-1].inputs[2])
        links.new(ray.outputs["Is Camera Ray"], mix.inputs[0])
        links.new(before, mix.inputs[1])
        links.new(made[-1].outputs[0], mix.inputs[2])
        return made + [translucent, ray, mix]
    return make


def read_exr(path, passes, most=None):
    """Channels of an uncompressed EXR of 32-bit floats, by the ends of their names, and of at most so many pixels."""
    with open(path, "rb") as file:
        data = file.read()
    at, attributes = 8, {}
    while data[at]:
        name = data[at:data.index(b"\0", at)]
        start = data.index(b"\0", at + len(name) + 1) + 1
        size, = struct.unpack_from("<i", data, start)
        attributes[name] = data[start + 4:start + 4 + size]
        at = start + 4 + size
    names, rest = [], attributes[b"channels"]
    while rest[0]:
        name, rest = rest.split(b"\0", 1)
        names.append(name.decode())
        rest = rest[16:]
    left, top, right, bottom = struct.unpack("<4i", attributes[b"dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    step = math.ceil(width * height / most) if most else 1
    offsets = struct.unpack_from(f"<{height}Q", data, at + 1)[::step]
    result = []
    for name in layer_channels(*passes):
        values, index = array.array("f"), names.index(name)
        for offset in offsets:
            start = offset + 8 + 4 * width * index
            values.frombytes(data[start:start + 4 * width])
        result.append(little_endian(values))
    return result


def little_endian(values):
    if sys.byteorder == "big":
        values.byteswap()
    return values


def write_exr(path, channels):
    """Writes {name: numbers} of the picture's size as an uncompressed EXR of 32-bit floats."""
    names = sorted(channels)  # as the format wants them
    (_, _, width, height), _ = window(bpy.context.scene.render)
    listed = b"".join(name.encode() + struct.pack("<x4i", 2, 0, 1, 1) for name in names) + b"\0"
    whole = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<2i", 20000630, 2)
    for name, kind, value in (("channels", "chlist", listed), ("compression", "compression", b"\0"), ("dataWindow", "box2i", whole),
                              ("displayWindow", "box2i", whole), ("lineOrder", "lineOrder", b"\0"),
                              ("pixelAspectRatio", "float", struct.pack("<f", 1)),
                              ("screenWindowCenter", "v2f", bytes(8)), ("screenWindowWidth", "float", struct.pack("<f", 1))):
        head += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    size = 4 * width * len(names)
    first = len(head) + 1 + 8 * height
    with open(path, "wb") as file:
        file.write(head + b"\0" + struct.pack(f"<{height}Q", *(first + row * (8 + size) for row in range(height))))
        for row in range(height):
            cut = slice(row * width, (row + 1) * width)
            file.write(struct.pack("<2i", row, size) + b"".join(little_endian(channels[n][cut]).tobytes() for n in names))


# Of the light that diffuse surfaces reflect over their color: E / pi.
LIGHT_PASSES = tuple(f"{name}.{channel}" for name in ("DiffDir", "DiffInd") for channel in "RGB")


def each(operation, *images):
    """An image of the same channels, each of whose numbers an operation makes of those in its place."""
    return [array.array("f", map(operation, *channels)) for channels in zip(*images)]


def light_of(path):
    """Direct and indirect diffuse light of an uncompressed render: R, G, B."""
    channels = read_exr(path, LIGHT_PASSES)
    return each(operator.add, channels[:3], channels[3:])


def standard_error(*values):
    mean = sum(values) / len(values)
    return math.sqrt(sum((value - mean) ** 2 for value in values) / (len(values) - 1) / len(values)) if len(values) > 1 else 0.0


def averaged(scratch, samples, pictures):
    """Diffuse light of several renders that share the samples, and the standard error of their mean."""
    scene, found = bpy.context.scene, []
    path = os.path.join(scratch, "light.exr")
    pictures = max(min(pictures, samples), 1)
    for seed in range(pictures):
        with changed((scene.cycles, "samples", max(samples // pictures, 1)), (scene.cycles, "seed", seed),
                     (scene.render.image_settings, "exr_codec", "NONE")):
            render(path)
        found.append(light_of(path))
    return each(lambda *values: sum(values) / pictures, *found), each(standard_error, *found)


def save_color(path, rgb, **more):
    """Writes R, G, B, and others under names."""
    channels = dict(zip("RGB", rgb))
    for layer, image in more.items():
        channels.update({f"{layer}.{name}": numbers for name, numbers in zip("RGB", image)})
    write_exr(path, channels)


def window(render_settings):
    """(left, bottom, width, height) of the image that is written, and the size of the whole, in pixels."""
    width = int(render_settings.resolution_x * render_settings.resolution_percentage / 100)
    height = int(render_settings.resolution_y * render_settings.resolution_percentage / 100)
    if not render_settings.use_border:
        return (0, 0, width, height), (width, height)
    left, right = int(render_settings.border_min_x * width), int(render_settings.border_max_x * width)
    bottom, top = int(render_settings.border_min_y * height), int(render_settings.border_max_y * height)
    return (left, bottom, right - left, top - bottom), (width, height)


def projection(depsgraph, camera):
    """Vulkan's clip space of the window that is written."""
    settings = bpy.context.scene.render
    (left, bottom, width, height), (whole_width, whole_height) = window(settings)
    matrix = camera.calc_matrix_camera(depsgraph, x=whole_width, y=whole_height, scale_x=settings.pixel_aspect_x,
                                       scale_y=settings.pixel_aspect_y)
    crop = Matrix.Identity(4)
    crop[0][0], crop[1][1] = whole_width / width, whole_height / height
    crop[0][3] = (whole_width - 2 * left - width) / width
    crop[1][3] = (whole_height - 2 * bottom - height) / height
    return VULKAN_FROM_OPENGL @ crop @ matrix


def layer_channels(*passes):
    name = bpy.context.view_layer.name
    return [f"{name}.{channel}" for channel in passes]


def casting(depsgraph, materials, opaque_too):
    """Changes by which a camera sees what casts shadows, whatever a camera sees of it else."""
    names, changes = {material.name for material in materials}, {}
    for instance in rendered_instances(depsgraph):
        thing = instance.object.original
        casts = thing.visible_shadow and (opaque_too or any(s.material and s.material.name in names for s in thing.material_slots))
        for shown in (thing, instance.parent.original) if instance.is_instance else (thing,):
            changes[shown.name] = (shown, "visible_camera", casts and shown.visible_shadow)
    return list(changes.values())


def in_collections(layer_collection, name, value):
    """Changes of a property of all collections of a view layer."""
    for child in layer_collection.children:
        yield (child, name, value)
        yield from in_collections(child, name, value)


def without_holdouts(depsgraph):
    """Changes by which the camera sees holdouts and shadow catchers as the objects that they are."""
    things = {i.object.original.name: i.object.original for i in rendered_instances(depsgraph)}
    yield from in_collections(bpy.context.view_layer.layer_collection, "holdout", False)
    for thing in things.values():
        yield from ((thing, "is_holdout", False), (thing, "is_shadow_catcher", False))


def render_maps(name, data, matrix, corners, size, folder, stem, materials, material_map):
    """The shadow maps of one light: depths that a camera in its place sees, what casts, and where light leaves that again."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    shown = casting(bpy.context.evaluated_depsgraph_get(), materials, casts_shadow(data))
    shown += in_collections(layer.layer_collection, "indirect_only", False)
    if not casts_shadow(data):
        say(f"lamp {data.name} casts no shadow: opaque bodies are not in its map, and translucent ones still shadow each other")
    camera_data = bpy.data.cameras.new("pellucid light")
    camera = bpy.data.objects.new("pellucid light", camera_data)
    scene.collection.objects.link(camera)
    maps = []
    try:
        for index, (view, extent) in enumerate(light_views(data, matrix, corners)):
            view_from_world = rigid_inverse(view)
            distances = [-(view_from_world @ corner).z for corner in corners]
            if max(distances) <= 0:  # nothing is on this side
                continue
            camera.matrix_world = view
            camera_data.clip_start = max(0.5 * min(distances), 1e-3 * max(distances))
            camera_data.clip_end = 1.1 * max(distances)
            if "width" in extent:
                camera_data.type, camera_data.ortho_scale = "ORTHO", extent["width"]
            else:
                camera_data.type, camera_data.angle = "PERSP", extent["angle"]
            file = f"{stem}.{name}.{index}.exr" if index or data.type == "POINT" else f"{stem}.{name}.exr"
            with changed(*shown, (scene, "camera", camera), (scene.render, "resolution_x", size),
                         (scene.render, "resolution_y", size), (scene.render, "resolution_percentage", 100),
                         (scene.render, "use_border", False), (scene.render, "pixel_aspect_x", 1.0),
                         (scene.render, "pixel_aspect_y", 1.0), (scene.cycles, "samples", 1)):
                render(os.path.join(folder, file))
                depsgraph = bpy.context.evaluated_depsgraph_get()
                clip = projection(depsgraph, camera.evaluated_get(depsgraph)) @ view_from_world
                # Of translucent bodies the back faces, and all of what is opaque.
                exit_file = file.replace(".exr", ".exit.exr")
                with contextlib.ExitStack() as backs:
                    for material in materials:
                        backs.enter_context(surface_of(material, back_faces))
                    backs.enter_context(changed((scene.cycles, "transparent_max_bounces", 64)))
                    render(os.path.join(folder, exit_file))
            maps.append({"file": file, "channel": layer_channels("Depth.Z")[0], "encoding": "viewZ",
                         "clipFromWorld": column_major(clip), "viewFromWorld": column_major(view_from_world),
                         "exit": {"file": exit_file, "channel": layer_channels("Depth.Z")[0]},
                         "casterMaterial": {"file": file, "channel": layer_channels("IndexMA.X")[0], "map": material_map}})
    finally:
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(camera_data)
    return maps


def safe(name):
    return "".join(c if c.isalnum() else "_" for c in name)


def number_layers(lights_of_manifest):
    """A dispatch binds 8 images: more maps than two with what lies beside them are layers of arrays."""
    layers = 0
    for record in lights_of_manifest:
        if len(record.get("shadowMaps", ())) > 2:
            for shadow in record["shadowMaps"]:
                shadow["layer"] = layers
                layers += 1


# Renders that share a picture's samples: their differences are its noise.
PICTURES = 4


def choose_layer():
    """The view layer in use: the window's, or the first that is on for rendering."""
    layers = [layer for layer in bpy.context.scene.view_layers if layer.use]
    if not layers:
        raise Refused("no view layer is on for rendering: turn on View Layer > Use for Rendering")
    if bpy.context.view_layer.use:
        layers.remove(bpy.context.view_layer)
    else:
        if not bpy.context.window:
            raise Refused(f"view layer {bpy.context.view_layer.name} is off for rendering: turn on Use for Rendering")
        bpy.context.window.view_layer = layers.pop(0)
    if layers:
        say(f"view layer {bpy.context.view_layer.name} is captured, and these are left out: " +
            ", ".join(layer.name for layer in layers))


def check_camera(scene):
    if not scene.camera:
        raise Refused("the scene has no camera")
    if scene.camera.type != "CAMERA":
        raise Refused(f"{scene.camera.name}, the scene's camera, is a {scene.camera.type}: choose an object of type Camera")
    if scene.camera.data.type == "PANO":
        raise Refused(f"camera {scene.camera.name} is panoramic, which no matrix is: set its Type to Perspective or Orthographic")


def camera_record(depsgraph):
    """Both matrices. A mirrored camera's view is that of its image, which the projection mirrors."""
    camera = bpy.context.scene.camera.evaluated_get(depsgraph)
    world, clip = camera.matrix_world.normalized(), projection(depsgraph, camera)
    if world.determinant() < 0:
        mirror = Matrix.Diagonal((-1, 1, 1, 1))
        world, clip = world @ mirror, clip @ mirror
    return {"clipFromView": column_major(clip), "viewFromWorld": column_major(rigid_inverse(world))}


# Of each kind of data in use, properties that a capture follows, here or as Cycles renders its passes; that change neither
# light nor shape in Cycles; and that are left out, with a sentence. A last * stands for any ending. Any other property of
# other than its default value is named.
PROPERTIES = {
    "lamp": {
        "used": "type color energy angle spot_size spot_blend shape size size_y spread shadow_soft_size use_nodes "
                "cycles.cast_shadow cycles.is_portal cycles.use_multiple_importance_sampling",
        "without effect": "distance *_factor use_custom_distance cutoff_distance falloff_type *_attenuation *_coefficient "
                          "use_shadow shadow_* use_contact_shadow contact_shadow_* use_square show_cone cycles.is_caustics_light",
        "left out": {"cycles.max_bounces": "its limit of bounces holds for the irradiance alone"}},
    "camera": {
        "used": "type sensor_fit angle* lens lens_unit clip_* sensor_* ortho_scale shift_*",
        "without effect": "passepartout_alpha display_size show_* cycles.* dof.focus_* dof.aperture_* stereo.*",
        "left out": {"dof.use_dof": "its depth of field is left out: blur the picture in a compositor"}},
    "object": {
        "used": "parent* track_axis up_axis location rotation_* scale dimensions delta_* matrix_* use_camera_lock_parent hide_render "
                "show_instancer_for_render instance_* use_instance_* visible_camera visible_diffuse visible_shadow active_* "
                "add_rest_position_attribute show_only_shape_key cycles.use_adaptive_subdivision cycles.dicing_rate "
                "cycles.shadow_terminator_*",
        "without effect": "lock_* empty_* use_empty_* show_* pass_index color hide_* visible_glossy visible_transmission "
                          "visible_volume_scatter display_* use_shape_key_edit_mode use_mesh_mirror_* lightgroup "
                          "use_grease_pencil_lights cycles.use_motion_blur cycles.use_deform_motion cycles.motion_steps "
                          "cycles.is_caustics_* cycles.ao_distance",
        "left out": {"is_holdout": "it is a holdout, which a capture draws as what it is",
                     "is_shadow_catcher": "it is a shadow catcher, which a capture draws as what it is",
                     "cycles.use_camera_cull": "shadow maps cull it from the lamp's place, too",
                     "cycles.use_distance_cull": "shadow maps cull it from the lamp's place, too"}},
    "material": {
        "used": "use_nodes pass_index cycles.displacement_method cycles.sample_as_light",
        "without effect": "blend_method shadow_method alpha_threshold show_transparent_back use_* refraction_depth preview_* "
                          "paint_* diffuse_color specular_* roughness metallic line_* cycles.volume_* cycles.homogeneous_volume",
        "left out": {"cycles.use_transparent_shadow": "its holes are holes in shadow maps, too"}},
    "render": {
        "used": "resolution_* pixel_aspect_* use_border border_* use_crop_to_border hair_* use_simplify simplify_* engine",
        "without effect": "preview_* fps* frame_map_* dither_intensity filter_* film_transparent threads* use_high_quality_normals "
                          "use_placeholder use_overwrite use_file_extension use_lock_interface filepath use_render_cache bake_* "
                          "use_bake_* use_stamp* stamp_* metadata_input sequencer_* use_sequencer* use_single_layer views_format "
                          "use_persistent_data line_thickness* motion_blur_* use_compositing compositor_*",
        "left out": {"use_motion_blur": "motion blur is left out: the frame stands still",
                     "use_multiview": "stereoscopy is left out: the picture is that of the middle camera",
                     "use_freestyle": "Freestyle's lines are left out"}},
}
# Settings of a scene besides those of its render, which are of the same kind.
PROPERTIES["cycles"] = {
    "used": "*_bounces ao_* use_fast_gi fast_gi_method caustics_* blur_glossy volume_* dicing_rate max_subdivisions offscreen_* "
            "sample_clamp_indirect texture_limit_render use_*_cull *_cull_margin shading_system feature_set direct_light_sampling_type",
    "without effect": "device samples sample_offset preview_* use_preview_* denois* use_denoising seed use_animated_seed time_limit "
                      "sampling_pattern scrambling_distance auto_scrambling_distance use_layer_samples light_sampling_threshold "
                      "adaptive_* use_adaptive_sampling use_light_tree *guiding* film_transparent_* debug_* bake_type motion_blur_position "
                      "rolling_* texture_limit use_auto_tile tile_size",
    "left out": {"film_exposure": "the capture holds light before exposure: replay --exposure sets that of a PNG",
                 "sample_clamp_direct": "its clamp darkens Cycles' picture, and the capture's light is not clamped",
                 "pixel_filter_type": "the picture's filter is left out: pixels hold what is at their centers",
                 "filter_width": "the picture's filter is left out: pixels hold what is at their centers"}}
PROPERTIES["curves"] = {"used": "shape subdivisions", "without effect": "", "left out": {}}
PROPERTIES["world"] = {"used": "use_nodes color cycles.* cycles_visibility.*", "without effect": "", "left out": {}}
PROPERTIES["layer"] = {
    "used": "use_solid use_sky use_ao use_strand use_volumes",
    "without effect": "samples pass_* use use_pass_* use_freestyle use_motion_blur active_* cycles.*", "left out": {}}
PROPERTIES["view"] = {
    "used": "", "without effect": "view_transform look",
    "left out": {"exposure": "the view's exposure is left out: replay --exposure sets that of a PNG",
                 "gamma": "the view's gamma is left out: EXR files hold light",
                 "use_curve_mapping": "the view's curves are left out: EXR files hold light"}}
NESTED = ("cycles", "dof", "stereo", "light_linking", "cycles_visibility")


def is_listed(name, patterns):
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def is_default(thing, known):
    value = getattr(thing, known.identifier)
    if getattr(known, "is_array", False):
        return all(abs(a - b) < 1e-5 for row in value for a, b in zip(row if hasattr(row, "__len__") else [row], known.default_array))
    default = known.default_flag if getattr(known, "is_enum_flag", False) else known.default
    return abs(value - default) <= 1e-5 * max(abs(default), 1) if known.type == "FLOAT" else value == default


def unusual(thing, prefix=""):
    """Names and values of properties that are not at their defaults. A pointer counts only within NESTED."""
    for known in thing.bl_rna.properties:
        name = known.identifier
        if known.type == "POINTER":
            if name in NESTED and not prefix and getattr(thing, name):
                yield from unusual(getattr(thing, name), name + ".")
            elif prefix == "light_linking." and getattr(thing, name):
                yield prefix + name, getattr(thing, name).name
        elif known.type not in ("COLLECTION", "STRING") and not known.is_readonly and not is_default(thing, known):
            yield prefix + name, getattr(thing, name)


# Of every data-block: bookkeeping.
BOOKKEEPING = ("use_fake_user", "use_extra_user", "tag", "is_*")


def say_unusual(kind, name, thing):
    table = PROPERTIES[kind]
    known = " ".join((table["used"], table["without effect"])).split()
    for key, value in unusual(thing):
        if key in table["left out"]:
            say(f"{kind} {name}: {table['left out'][key]} ({key})")
        elif not is_listed(key, known) and not is_listed(key, BOOKKEEPING):
            say(f"{kind} {name}: its {key} is {value}, which no capture holds: set the default, or expect another picture")


def say_what_is_left_out(depsgraph):
    """Sentences for what is in use and not in the capture."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    if layer.material_override:
        raise Refused(f"view layer {layer.name} has the Material Override {layer.material_override.name}: clear it")
    say_unusual("render", "settings", scene.render)
    say_unusual("camera", scene.camera.name, scene.camera.data)
    for kind, thing in (("cycles", scene.cycles), ("curves", scene.cycles_curves), ("layer", layer), ("view", scene.view_settings)):
        say_unusual(kind, "settings", thing)
    if scene.world:
        say_unusual("world", scene.world.name, scene.world)
        say_volume("world", scene.world)
    if scene.background_set:
        say(f"scene {scene.background_set.name}, the background set: the irradiance has its lamps, and what comes through lacks them")
    if scene.use_nodes and scene.render.use_compositing:
        say("compositing nodes are left out: composite the replay's picture")
    for instance in rendered_instances(depsgraph):
        thing = instance.object.original
        if thing.type == "LIGHT":  # the properties of its object are those of meshes
            say_unusual("lamp", thing.name, thing.data)
            continue
        say_unusual("object", thing.name, thing)
        for slot in thing.material_slots:
            if slot.material:
                say_unusual("material", slot.material.name, slot.material)
                say_volume("material", slot.material)
                say_light_paths(slot.material)


def say_volume(kind, thing):
    if thing.use_nodes and output_node(thing) and output_node(thing).inputs["Volume"].links:
        say(f"{kind} {thing.name}: light that comes through passes its volume as if there were none; the irradiance has the volume")


def say_light_paths(material):
    """Shadow maps are pictures of a camera: what a material does for other rays is not in them."""
    for _, node in nodes_of(material.node_tree if material.use_nodes else None):
        if node.type == "LIGHT_PATH" and any(output.links for output in node.outputs):
            say(f"material {material.name}: node {node.name} ({node.bl_label}) is left out of shadow maps, which hold what camera "
                "rays see; the irradiance has the node")


def nodes_of(tree):
    """(tree, node) of a tree and of its groups."""
    for node in tree.nodes if tree else ():
        yield tree, node
        if node.type == "GROUP":
            yield from nodes_of(node.node_tree)


def say_near_plane(camera, translucent):
    """Behind a near plane that cuts a body the camera sees its inside. translucent: boxes()."""
    from_world = rigid_inverse(camera.matrix_world)
    for box in translucent:
        distances = [-(from_world @ corner).z for corner in box]
        if camera.data.type == "PERSP" and min(distances) < camera.data.clip_start < max(distances):
            say(f"camera {camera.name}: its near plane at {camera.data.clip_start:.3g} cuts a translucent body, whose inside is taken "
                "for its front: set a smaller Clip Start")


def may_emit(tree, node):
    """Whether a shader of a surface gives light of its own."""
    strength = first_input(node, "Strength" if node.type == "EMISSION" else "Emission Strength")
    color = first_input(node, "Color" if node.type == "EMISSION" else "Emission", "Emission Color")
    if node.type not in ("EMISSION", "BSDF_PRINCIPLED") or not color:
        return False
    return all(source_of(socket) or (max(socket.default_value[:3]) if hasattr(socket.default_value, "__len__")
                                     else socket.default_value) != 0 for socket in (strength, color) if socket)


def emitters(depsgraph):
    """Whether meshes emit light, each of which a sentence names."""
    names = {}
    for instance in rendered_instances(depsgraph):
        for slot in instance.object.original.material_slots:
            if slot.material and any(may_emit(*found) for found in shaders(slot.material)):
                names[instance.object.original.name] = slot.material.name
    for thing, material in names.items():
        say(f"object {thing} emits light (material {material}): it comes through by the irradiance of hidden faces, which "
            "knows no exit points; a lamp in its place has shadow maps")
    return bool(names)


def hidden_light(materials, glowing, scratch):
    """Light on the faces that translucent ones hide, without that of lamps, which comes through by their shadow maps."""
    scene, path = bpy.context.scene, os.path.join(scratch, "hidden.exr")
    lamps = [(thing, "hide_render", True) for thing in scene.objects if thing.type == "LIGHT"]
    with contextlib.ExitStack() as stack:
        for material in materials:
            stack.enter_context(surface_of(material, hidden_faces(material)))
        stack.enter_context(changed((scene.render.image_settings, "exr_codec", "NONE"),
                                    (scene.cycles, "transparent_max_bounces", 64)))
        render(path)
        light = read_exr(path, LIGHT_PASSES[3:])
        if glowing or scene.world:
            with changed(*lamps):
                render(path)
            light = each(operator.add, light, read_exr(path, LIGHT_PASSES[:3]))
    return light


def say_noise(light, error, samples):
    mean = sum(map(math.fsum, light)) / sum(map(len, light))
    noise = 100 * math.sqrt(sum(e * e for channel in error for e in channel) / sum(map(len, error))) / mean if mean > 0 else 0
    if noise > 1:
        say(f"irradiance of {samples} samples has a noise of {noise:.2g} % of its mean; --samples {4 * samples} halves it")


def truth(folder, stem, samples, scratch):
    """The manifest's truth: diffuse light with bounces, of the file's own materials, and its standard error."""
    light, error = averaged(scratch, samples, PICTURES)
    color = read_exr(os.path.join(scratch, "light.exr"), ("DiffCol.R", "DiffCol.G", "DiffCol.B"))
    file = f"{stem}.truth.exr"
    save_color(os.path.join(folder, file), light, color=color, error=each(lambda e, c: math.pi * e * c, error, color))
    named = {layer: {"file": file, "channels": [f"{layer}.{name}" for name in "RGB"]} for layer in ("color", "error")}
    return {"file": file, "channels": ["R", "G", "B"], "scale": math.pi, "times": named["color"], "standardError": named["error"]}


def capture(folder, stem, options):
    """Renders the current frame and writes its manifest."""
    choose_layer()
    scene, layer = bpy.context.scene, bpy.context.view_layer
    check_camera(scene)
    os.makedirs(folder, exist_ok=True)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    candidates = scattering_materials(depsgraph)
    if not candidates:
        raise Refused("no rendered material has subsurface scattering: raise Principled's Subsurface")
    corners = bounds(depsgraph)
    glowing = emitters(depsgraph)
    say_what_is_left_out(depsgraph)
    unit = scene.unit_settings.scale_length
    file, back = f"{stem}.exr", f"{stem}.back.exr"
    manifest = {"pellucid": 1, "metersPerUnit": unit}
    index_of = {material.name: i + 1 for i, material in enumerate(candidates)}
    every = [(m, "pass_index", index_of.get(m.name, 0)) for m in bpy.data.materials]
    with contextlib.ExitStack() as stack:
        scratch = stack.enter_context(tempfile.TemporaryDirectory())
        stack.enter_context(as_data(options.samples))
        stack.enter_context(changed(*every, *without_holdouts(depsgraph)))
        seen = measured(candidates, scratch)
        # Materials of one medium have one number, so that light crosses their border.
        media, material_map = [], {"0": 0}
        for material in candidates:
            index = index_of[material.name]
            if index not in seen:
                say(f"material {material.name}: no light goes under it where the camera sees it: it is opaque")
                material_map[str(index)] = 0
                continue
            record = medium_of(material, seen[index], 1000 * unit)
            if record not in media:
                media.append(record)
            material_map[str(index)] = media.index(record) + 1
        if not media:
            raise Refused("no material has subsurface scattering where the camera sees it: " + ", ".join(index_of))
        materials = [m for m in candidates if material_map[str(index_of[m.name])] > 0]
        # Of the light that a material reflects, the part that goes under it.
        parts = {index_of[m.name]: seen[index_of[m.name]].part() for m in materials}
        # The walk's reflectance over the color. All of the reflected light has it in the share that goes under.
        off = {key: walk_factor(media[material_map[str(key)] - 1], seen[key].mean(MEDIUM, 3)) for key in parts}
        walked = {key: [part * factor for part, factor in zip(parts[key], off[key])] for key in parts}
        reflected = {key: [more + 1 - part for more, part in zip(walked[key], parts[key])] for key in parts}
        if options.truth:
            manifest["truth"] = truth(folder, stem, options.truth, scratch)
        found = every_shader(materials)
        mixed = [m for m in materials if min(parts[index_of[m.name]]) < 0.999]
        for material in mixed:
            shares = " ".join(f"{100 * part:.3g}" for part in parts[index_of[material.name]])
            say(f"material {material.name}: {shares} % of its light goes under the surface: that much comes through, and "
                "all of what it reflects diffuses")
        fitted = all(factor == 1 for factors in off.values() for factor in factors)
        for material in materials:
            factors = off[index_of[material.name]]
            if max(factors) > 1.05 or min(factors) < 0.95:
                colors = " ".join(f"{factor:.3g}" for factor in factors)
                say(f"material {material.name}: Cycles' walk reflects {colors} times its color, and so does the capture")

        def colored(name, factors):
            with in_place_of(found, showing(lambda beside: beside.times_by_index(beside.color(), factors))), \
                    changed((scene.cycles, "samples", 1)):
                render(os.path.join(folder, name))
            return {"file": name, "channels": layer_channels("Emit.R", "Emit.G", "Emit.B")}
        albedo = colored(f"{stem}.albedo.exr", walked) if mixed or not fitted else None
        color = colored(f"{stem}.color.exr", reflected) if mixed and not fitted else None
        stack.enter_context(in_place_of(
            found, lambda beside: beside.diffuse() if beside.node.type in DIFFUSE_SHADERS else None))
        with changed((scene.cycles, "max_bounces", 0)):
            render(os.path.join(folder, file))
        light, error = averaged(scratch, options.samples, PICTURES)
        save_color(os.path.join(folder, f"{stem}.light.exr"), light)
        say_noise(light, error, options.samples)
        depsgraph = bpy.context.evaluated_depsgraph_get()
        manifest["camera"] = camera_record(depsgraph)
        save_color(os.path.join(folder, f"{stem}.hidden.exr"), hidden_light(materials, glowing, scratch))
        depsgraph = bpy.context.evaluated_depsgraph_get()
        manifest["lights"] = []
        translucent = boxes(depsgraph, {m.name for m in materials})
        say_near_plane(bpy.context.scene.camera, translucent)
        # All of them first: renders change the depsgraph.
        for i, (name, data, matrix) in enumerate(list(lights(depsgraph))):
            record = light_record(name, data, matrix, corners)
            if not record:
                continue
            say_what_size_does(name, data, matrix, translucent)
            maps = render_maps(f"light{i}_{safe(name)}", data, matrix, corners, options.shadow_size, folder, stem, materials,
                               material_map)
            if maps:
                record["shadowMaps"] = maps
            manifest["lights"].append(record)
        number_layers(manifest["lights"])
        override = bpy.data.materials.new("pellucid back faces")
        try:
            override.use_nodes = True
            with surface_of(override, back_faces), changed((layer, "material_override", override), (scene.cycles, "samples", 1),
                                                           (scene.cycles, "transparent_max_bounces", 64)):
                render(os.path.join(folder, back))
        finally:
            bpy.data.materials.remove(override)
    depth = layer_channels("Depth.Z")[0]
    color = color or {"file": file, "channels": layer_channels("DiffCol.R", "DiffCol.G", "DiffCol.B")}
    manifest["buffers"] = {
        "frontDepth": {"file": file, "channel": depth, "encoding": "viewZ"},
        "backDepth": {"file": back, "channel": depth, "encoding": "viewZ"},
        "irradiance": {"file": f"{stem}.light.exr", "channels": ["R", "G", "B"], "scale": math.pi},
        "hiddenIrradiance": {"file": f"{stem}.hidden.exr", "channels": ["R", "G", "B"], "scale": math.pi},
        "albedo": albedo or color,
        "material": {"file": file, "channel": layer_channels("IndexMA.X")[0], "map": material_map}}
    if mixed:
        # Light over the part of it that goes under the surface, so that the albedo has the part of what comes through.
        manifest["buffers"]["irradiance"].update(times=color, includesAlbedo=True)
    if albedo:
        manifest["buffers"]["material"]["file"] = albedo["file"]
    manifest["materials"] = media
    path = os.path.join(folder, f"{stem}.json")
    with open(path, "w", encoding="utf-8") as out:
        json.dump(manifest, out, indent=1)
    return path


# ---- The add-on


class PELLUCID_OT_capture(bpy.types.Operator):
    """Renders the current frame as a capture for pellucid replay"""
    bl_idname = "pellucid.capture"
    bl_label = "Capture"

    def execute(self, context):
        words = context.scene.pellucid
        SAID.clear()
        options = argparse.Namespace(shadow_size=words.shadow_size, samples=words.samples, truth=words.truth)
        try:
            path = capture(bpy.path.abspath(words.folder), "capture", options)
        except (Refused, RuntimeError) as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        self.report({"INFO"}, f"wrote {path}; next: pellucid replay {path} -o out.exr --png")
        return {"FINISHED"}


class PellucidWords(bpy.types.PropertyGroup):
    folder: bpy.props.StringProperty(name="Folder", subtype="DIR_PATH", default="//pellucid/")
    shadow_size: bpy.props.IntProperty(name="Shadow map", description="Texels across", default=1024, min=1, max=8192)
    samples: bpy.props.IntProperty(name="Samples", description="For soft and bounced light", default=16, min=1)
    truth: bpy.props.IntProperty(name="Truth", description="Samples of a random walk; 0: none", default=0, min=0)


class PELLUCID_PT_capture(bpy.types.Panel):
    bl_label = "Pellucid"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    def draw(self, context):
        for name in ("folder", "shadow_size", "samples", "truth"):
            self.layout.prop(context.scene.pellucid, name)
        self.layout.operator("pellucid.capture")


CLASSES = (PellucidWords, PELLUCID_OT_capture, PELLUCID_PT_capture)


def register():
    for thing in CLASSES:
        bpy.utils.register_class(thing)
    bpy.types.Scene.pellucid = bpy.props.PointerProperty(type=PellucidWords)


def unregister():
    del bpy.types.Scene.pellucid
    for thing in reversed(CLASSES):
        bpy.utils.unregister_class(thing)


# ---- The command


def frames_of(text):
    frames = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        frames += range(int(first), int(last or first) + 1)
    return frames


def main(arguments):
    parser = argparse.ArgumentParser(prog="blender_capture.py")
    parser.add_argument("-o", "--output", required=True, help="folder")
    parser.add_argument("--frames", help="FIRST-LAST or a list like 1-10,20 (default: the current frame)")
    parser.add_argument("--replay", metavar="PELLUCID", help="the command that also makes the pictures")
    parser.add_argument("--shadow-size", type=int, default=1024, help="texels across a shadow map")
    parser.add_argument("--samples", type=int, default=16, help="a pixel, for soft and bounced light")
    parser.add_argument("--truth", type=int, default=0, help="samples of a random walk to compare with")
    options = parser.parse_args(arguments)
    scene = bpy.context.scene
    frames = frames_of(options.frames) if options.frames else [None]
    for frame in frames:
        if frame is not None:
            scene.frame_set(frame)
        try:
            last = capture(options.output, "capture" if frame is None else f"capture.{frame:04d}", options)
        except Refused as refusal:
            raise SystemExit(f"pellucid: {refusal}") from None
        except Exception as error:  # Blender itself ends with status 0
            at = error.__traceback__
            while at.tb_next and at.tb_next.tb_frame.f_code.co_filename == at.tb_frame.f_code.co_filename:
                at = at.tb_next
            raise SystemExit(f"pellucid: {type(error).__name__} at line {at.tb_lineno} of blender_capture.py: {error}") from None
    number = "" if frames == [None] else ".####"
    pattern = os.path.join(options.output, f"capture{number}.json")
    print(f"pellucid: wrote {last}")
    words = ["replay", pattern, "-o", os.path.join(options.output, f"picture{number}.exr")]
    words += ["--frames", options.frames] if number else ["--png"]
    if options.replay:
        done = subprocess.run([options.replay, *words], check=False)
        if done.returncode != 0:
            raise SystemExit(f"pellucid: {options.replay} {' '.join(words)} ended with {done.returncode}")
    else:
        print("next: pellucid " + " ".join(words))


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
