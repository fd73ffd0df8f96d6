"""Renders a scene of Blender as captures: passes, back faces, shadow maps, and one whole manifest a frame.  docs/captures.md

    blender -b scene.blend -P blender_capture.py -- -o out/                   the current frame: out/capture.json
    blender -b scene.blend -P blender_capture.py -- -o out/ --frames 1-250    out/capture.0001.json and so on

Options: --replay build/bin/pellucid (also makes out/picture.exr and .png), --shadow-size 1024, --samples 16 (of lights that
have a size), --truth SAMPLES (diffuse light of the file's own materials).
The scene in the file stays as it is. Installed as an add-on, the script has a panel in the properties of the render.
"""
import argparse
import array
import contextlib
import json
import math
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
# Of a sheet that shines to one side, at equal steps of the angle.
COSINES = [max(math.cos(math.pi * i / 63), 0.0) for i in range(64)]
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


def say(sentence):
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

    def color(self):
        """Of the diffuse light, on and under the surface; Cycles, svm_node_closure_bsdf."""
        if self.node.type != "BSDF_PRINCIPLED":
            return self.node.inputs["Color"]
        color, below = self.node.inputs["Base Color"], first_input(self.node, "Subsurface Color")
        if below:
            weight = subsurface_weight(self.node)
            color = self.sum(self.times(color, self.math("SUBTRACT", 1, weight)), self.times(below, weight))
        diffuse = self.math("MULTIPLY", self.math("SUBTRACT", 1, self.node.inputs["Metallic"]),
                            self.math("SUBTRACT", 1, first_input(self.node, "Transmission Weight", "Transmission")))
        return self.times(color, diffuse)

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

    def diffuse(self):
        """A shader that reflects all of the diffuse light at the surface."""
        node = self.new("ShaderNodeBsdfDiffuse")
        self.feed(self.color(), node.inputs["Color"])
        normal = self.node.inputs.get("Normal")
        if normal and normal.links:
            self.feed(normal, node.inputs["Normal"])
        return node

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
        return node


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
        self.weight, self.sums, self.low, self.high = 0.0, [0.0] * 11, [math.inf] * 11, [-math.inf] * 11

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


# Of Measured: color under the surface, color in all, radius, anisotropy, index of refraction.
UNDER, ALL, RADIUS, ANISOTROPY, IOR = 0, 3, 6, 9, 10


def measured(materials, folder):
    """By pass index: the values of each material's nodes as Cycles evaluates them, in the picture of the camera."""
    scene, found = bpy.context.scene, every_shader(materials)

    def picture(value):
        path = os.path.join(folder, "values.exr")
        with in_place_of(found, showing(value)), changed((scene.cycles, "samples", 1), (scene.cycles, "max_bounces", 0),
                                                         (scene.render.image_settings, "exr_codec", "NONE")):
            render(path)
        return read_exr(path, ("Emit.R", "Emit.G", "Emit.B", "IndexMA.X"))

    pictures = [picture(value) for value in (
        lambda b: b.times(b.medium(), b.share()), lambda b: b.times(b.color(), b.share()), lambda b: b.color(),
        lambda b: b.times(b.radius(), b.share()))]
    result = {}
    for pixel in zip(*(channel for channels in pictures for channel in channels[:3]), pictures[0][3]):
        index, share = round(pixel[12]), pixel[0]
        if index > 0 and share > 1e-4:
            result.setdefault(index, Measured()).add(share, pixel[3:12] + pixel[1:3])
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
    return medium(seen.mean(RADIUS, 3), seen.mean(UNDER, 3), min(max(seen.mean(ANISOTROPY), 0.0), 0.9),
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


def bounds(depsgraph):
    """Corners of the boxes of all meshes that are rendered, in the world."""
    corners = []
    for instance in rendered_instances(depsgraph):
        if instance.object.type in ("MESH", "CURVE", "SURFACE", "META", "FONT"):
            corners += [instance.matrix_world @ Vector(corner) for corner in instance.object.bound_box]
    if not corners:
        raise Refused("the scene has nothing that a render shows")
    return corners


def lights(depsgraph):
    """(name, data, matrix) of the lights that a replay knows."""
    for instance in rendered_instances(depsgraph):
        if instance.object.type != "LIGHT":
            continue
        data = instance.object.original.data
        if data.type not in LIGHT_KINDS:
            say(f"left out: light {instance.object.name} of type {data.type}")
            continue
        yield instance.object.name, data, instance.matrix_world.copy()


def light_record(data, matrix):
    # A sheet's radiant intensity ahead is a quarter of its power in Cycles.
    intensity = data.energy / {"SUN": 1, "AREA": 4}.get(data.type, 4 * math.pi)
    record = {"type": LIGHT_KINDS[data.type], "color": list(data.color), "intensity": intensity}
    if data.type != "SUN":
        record["position"] = list(matrix.translation)
    if data.type != "POINT":
        record["direction"] = list(-matrix.col[2].to_3d().normalized())
    if data.type == "SPOT":
        outer = data.spot_size / 2
        record.update(outerConeAngle=outer, innerConeAngle=outer * (1 - max(data.spot_blend, 1e-3)))
    if data.type == "AREA":
        record["angleTable"] = COSINES
    return record


def say_what_size_does(name, data, matrix, corners):
    """Light that comes through has the place of a light's center, whatever its size."""
    near = [min(max(matrix.translation[i], min(c[i] for c in corners)), max(c[i] for c in corners)) for i in range(3)]
    nearest = (Vector(near) - matrix.translation).length
    if data.type == "SUN":
        angle = data.angle
    else:
        width = max(data.size, data.size_y) if data.type == "AREA" else 2 * data.shadow_soft_size
        angle = 2 * math.atan2(width / 2, nearest)
    if math.degrees(angle) > 2:
        say(f"light {name} of type {data.type} is {math.degrees(angle):.3g} degrees wide: it is soft where the camera sees "
            "it, and in thin parts that of its center")
    if data.type == "AREA" and data.spread < math.pi - 0.01:
        say(f"light {name}: its spread of {math.degrees(data.spread):.3g} degrees is left out in thin parts")


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
                 (scene.render, "use_crop_to_border", scene.render.use_border),
                 (scene.render, "use_compositing", False), (scene.render, "use_sequencer", False),
                 (scene.render, "use_overwrite", True), (scene.render, "use_file_extension", False),
                 (settings, "file_format", "OPEN_EXR_MULTILAYER"), (settings, "color_depth", "32"),
                 (settings, "exr_codec", "ZIP"), (layer, "use_pass_emit", True),
                 (layer, "use_pass_z", True), (layer, "use_pass_diffuse_direct", True),
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


def read_exr(path, passes):
    """Channels of an uncompressed EXR of 32-bit floats, by the ends of their names, and of all at most 2^18 pixels."""
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
    step = math.ceil(width * height / 2 ** 18)
    offsets = struct.unpack_from(f"<{height}Q", data, at + 1)
    result = []
    for wanted in passes:
        index = next(i for i, name in enumerate(names) if name == layer_channels(wanted)[0])
        values = array.array("f")
        for offset in offsets[::step]:
            start = offset + 8 + 4 * width * index
            values.frombytes(data[start:start + 4 * width])
        if sys.byteorder == "big":
            values.byteswap()
        result.append(values)
    return result


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


def render_maps(name, data, matrix, corners, size, folder, stem, materials, material_map):
    """The shadow maps of one light: depths that a camera in its place sees, what casts, and where light leaves that again."""
    scene = bpy.context.scene
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
            with changed((scene, "camera", camera), (scene.render, "resolution_x", size),
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


def capture(folder, stem, options):
    """Renders the current frame and writes its manifest."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    if not scene.camera:
        raise Refused("the scene has no camera")
    os.makedirs(folder, exist_ok=True)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    candidates = scattering_materials(depsgraph)
    if not candidates:
        raise Refused("no rendered material has subsurface scattering: raise Principled's Subsurface")
    corners = bounds(depsgraph)
    unit = scene.unit_settings.scale_length
    file, back = f"{stem}.exr", f"{stem}.back.exr"
    manifest = {"pellucid": 1, "metersPerUnit": unit}
    index_of = {material.name: i + 1 for i, material in enumerate(candidates)}
    every = [(m, "pass_index", index_of.get(m.name, 0)) for m in bpy.data.materials]
    with contextlib.ExitStack() as stack:
        stack.enter_context(as_data(options.samples))
        stack.enter_context(changed(*every))
        with tempfile.TemporaryDirectory() as scratch:
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
        off = {key: walk_factor(media[material_map[str(key)] - 1], seen[key].mean(UNDER, 3)) for key in parts}
        walked = {key: [part * factor for part, factor in zip(parts[key], off[key])] for key in parts}
        reflected = {key: [more + 1 - part for more, part in zip(walked[key], parts[key])] for key in parts}
        if options.truth:
            with changed((scene.cycles, "samples", options.truth), (scene.cycles, "diffuse_bounces", 0),
                         (scene.cycles, "max_bounces", 0)):
                render(os.path.join(folder, f"{stem}.truth.exr"))
            manifest["truth"] = {"file": f"{stem}.truth.exr", "scale": math.pi,
                                 "channels": layer_channels("DiffDir.R", "DiffDir.G", "DiffDir.B"),
                                 "times": {"file": f"{stem}.truth.exr",
                                           "channels": layer_channels("DiffCol.R", "DiffCol.G", "DiffCol.B")}}
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
        render(os.path.join(folder, file))
        depsgraph = bpy.context.evaluated_depsgraph_get()
        camera = scene.camera.evaluated_get(depsgraph)
        manifest["camera"] = {"clipFromView": column_major(projection(depsgraph, camera)),
                              "viewFromWorld": column_major(rigid_inverse(camera.matrix_world))}
        manifest["lights"] = []
        # All of them first: renders change the depsgraph.
        for i, (name, data, matrix) in enumerate(list(lights(depsgraph))):
            record = light_record(data, matrix)
            say_what_size_does(name, data, matrix, corners)
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
        "irradiance": {"file": file, "channels": layer_channels("DiffDir.R", "DiffDir.G", "DiffDir.B"),
                       "scale": math.pi},
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
        options = argparse.Namespace(shadow_size=words.shadow_size, samples=words.samples, truth=words.truth)
        try:
            path = capture(bpy.path.abspath(words.folder), "capture", options)
        except Refused as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        self.report({"INFO"}, f"wrote {path}; next: pellucid replay {path} -o out.exr --png")
        return {"FINISHED"}


class PellucidWords(bpy.types.PropertyGroup):
    folder: bpy.props.StringProperty(name="Folder", subtype="DIR_PATH", default="//pellucid/")
    shadow_size: bpy.props.IntProperty(name="Shadow map", description="Texels across", default=1024, min=1, max=8192)
    samples: bpy.props.IntProperty(name="Samples", description="For lamps that have a size", default=16, min=1)
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
    parser.add_argument("--samples", type=int, default=16, help="a pixel, for the light of lamps that have a size")
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
