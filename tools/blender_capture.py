"""Renders a scene of Blender as captures: passes, back faces, shadow maps, and one whole manifest a frame.  docs/blender.md

    blender -b scene.blend -P blender_capture.py -- -o out/                   the current frame: out/capture.json
    blender -b scene.blend -P blender_capture.py -- -o out/ --frames 1-250    out/capture.0001.json and so on

Options: --replay build/bin/pellucid (also makes out/picture.exr and .png), --shadow-size 1024, --samples 16 (of lights that
have a size), --truth SAMPLES (Cycles' own random walk).
The scene in the file stays as it is. Installed as an add-on, the script has a panel in the properties of the render.
"""
import argparse
import contextlib
import json
import math
import os
import subprocess
import sys

import bpy
from mathutils import Matrix, Vector

bl_info = {"name": "Pellucid capture", "author": "Pellucid", "version": (0, 2, 0), "blender": (3, 4, 0),
           "location": "Properties > Render > Pellucid", "category": "Render",
           "description": "Renders the frame as a capture for pellucid replay"}

VULKAN_FROM_OPENGL = Matrix(((1, 0, 0, 0), (0, -1, 0, 0), (0, 0, 0.5, 0.5), (0, 0, 0, 1)))
LIGHT_KINDS = {"SUN": "directional", "POINT": "point", "SPOT": "spot"}
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


def medium(radius, color, g, ior, method, millimeters):
    """Scattering coefficients of Cycles' random walk, 1/mm, as a manifest has them."""
    # Fresnel's mean reflectance inside, as Cycles has it from Jensen.
    f_dr = (-1.440 / ior + 0.710) / ior + 0.668 + 0.0636 * ior
    boundary = 4 / 3 * (1 + f_dr) / (1 - f_dr)
    scattering, absorption = [], []
    for length, albedo in zip(radius, color):
        if method == "RANDOM_WALK":
            length *= math.sqrt(3 * (1 - dipole_alpha(albedo, boundary)))
        else:
            length *= 0.25 / math.pi
        sigma_t = 1 / max(length * millimeters, 1e-4) / (1 - g)
        alpha = walk_albedo(albedo, g)
        scattering.append(alpha * sigma_t)
        absorption.append((1 - alpha) * sigma_t)
    # Light enters a random walk diffusely, without refraction.
    return {"scattering": scattering, "absorption": absorption, "g": g, "ior": 1}


def socket_value(node, *names):
    for name in names:
        if name in node.inputs:
            value = node.inputs[name].default_value
            return list(value)[:3] if hasattr(value, "__len__") else value
    return None


def output_node(material):
    tree = material.node_tree
    return tree.get_output_node("CYCLES") or tree.get_output_node("ALL")


def surface_node(material):
    """The Principled or Subsurface node that feeds the output, looking through mixes."""
    if not material or not material.use_nodes:
        return None
    output = output_node(material)
    pending = [link.from_node for link in output.inputs["Surface"].links] if output else []
    seen = set()
    while pending:
        node = pending.pop(0)
        if node in seen:
            continue
        seen.add(node)
        if node.type in ("BSDF_PRINCIPLED", "SUBSURFACE_SCATTERING"):
            return node
        pending += [link.from_node for socket in node.inputs if socket.type == "SHADER" for link in socket.links]
    return None


def subsurface(material):
    """Reads a material's light under its surface; None: the material is not translucent."""
    node = surface_node(material)
    if node is None:
        return None
    g = min(max(socket_value(node, "Subsurface Anisotropy", "Anisotropy") or 0.0, 0.0), 0.9)
    if node.type == "SUBSURFACE_SCATTERING":
        # It has one color for both, and a scale of the radius.
        scale = socket_value(node, "Scale")
        return {"node": node, "color": "Color", "weight": 1.0, "radius": [scale * r for r in socket_value(node, "Radius")],
                "g": g, "ior": socket_value(node, "IOR") or 1.4, "method": node.falloff}
    weight = socket_value(node, "Subsurface Weight", "Subsurface") or 0.0
    if weight <= 0:
        return None
    radius = [r * (socket_value(node, "Subsurface Scale") if "Subsurface Scale" in node.inputs else weight)
              for r in socket_value(node, "Subsurface Radius")]
    color = "Subsurface Color" if "Subsurface Color" in node.inputs and weight > 0.5 else "Base Color"
    return {"node": node, "color": color, "weight": weight, "radius": radius, "g": g,
            "ior": socket_value(node, "Subsurface IOR", "IOR") or 1.4, "method": node.subsurface_method}


@contextlib.contextmanager
def surface_of(material, make):
    """While it lasts, the material's surface is the shader that make(nodes) returns."""
    tree, output = material.node_tree, output_node(material)
    before = [link.from_socket for link in output.inputs["Surface"].links]
    made = make(tree.nodes)
    tree.links.new(made.outputs[0], output.inputs["Surface"])
    try:
        yield
    finally:
        tree.nodes.remove(made)
        for socket in before:
            tree.links.new(socket, output.inputs["Surface"])


def like(kind, material, found):
    """A node with the color, and for a subsurface node the numbers, of the one that was found."""
    def make(nodes):
        node = nodes.new(kind)
        source = found["node"].inputs[found["color"]]
        node.inputs["Color"].default_value = source.default_value
        if source.links:
            material.node_tree.links.new(source.links[0].from_socket, node.inputs["Color"])
        normal = found["node"].inputs.get("Normal")
        if normal and normal.links:
            material.node_tree.links.new(normal.links[0].from_socket, node.inputs["Normal"])
        if kind == "ShaderNodeSubsurfaceScattering":
            node.falloff = found["method"]
            node.inputs["Scale"].default_value = 1
            node.inputs["Radius"].default_value = found["radius"]
            node.inputs["IOR"].default_value = found["ior"]
            node.inputs["Anisotropy"].default_value = found["g"]
        return node
    return make


def translucent_materials(depsgraph):
    """Materials of what is rendered that have light under their surface, each once, by name."""
    found = {}
    for instance in rendered_instances(depsgraph):
        for slot in instance.object.original.material_slots:
            if slot.material and slot.material.name not in found:
                said = subsurface(slot.material)
                if said:
                    found[slot.material.name] = (slot.material, said)
    return list(found.values())


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
    intensity = data.energy if data.type == "SUN" else data.energy / (4 * math.pi)
    record = {"type": LIGHT_KINDS[data.type], "color": list(data.color), "intensity": intensity}
    if data.type != "SUN":
        record["position"] = list(matrix.translation)
    if data.type != "POINT":
        record["direction"] = list(-matrix.col[2].to_3d().normalized())
    if data.type == "SPOT":
        outer = data.spot_size / 2
        record.update(outerConeAngle=outer, innerConeAngle=outer * (1 - max(data.spot_blend, 1e-3)))
    return record


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
    if data.type == "POINT":
        axis = center - position
    angle = math.pi
    if axis.length > 0:
        angle = 2.02 * max(axis.angle(corner - position, math.pi) for corner in corners)
    if data.type == "SPOT":
        angle = min(angle, 1.02 * data.spot_size)
    if angle < WIDEST_VIEW:
        return [(looking(position, axis), {"angle": angle})]
    if data.type == "SPOT":
        say("a spot wider than 150 degrees has no shadow map")
        return []
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
                 (layer, "use_pass_z", True), (layer, "use_pass_normal", True),
                 (layer, "use_pass_diffuse_direct", True), (layer, "use_pass_diffuse_color", True),
                 (layer, "use_pass_material_index", True), (layer, "use_pass_combined", True)):
        yield


def back_face_material():
    """Front faces are holes, so that the depth is that of the nearest back face."""
    material = bpy.data.materials.new("pellucid back faces")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    mix, output = nodes.new("ShaderNodeMixShader"), nodes.new("ShaderNodeOutputMaterial")
    links.new(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], mix.inputs[0])
    links.new(nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
    links.new(nodes.new("ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], output.inputs["Surface"])
    return material


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


def render_maps(name, data, matrix, corners, size, folder, stem):
    """The shadow maps of one light: depths that a camera in its place sees."""
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
            maps.append({"file": file, "channel": layer_channels("Depth.Z")[0], "encoding": "viewZ",
                         "clipFromWorld": column_major(clip), "viewFromWorld": column_major(view_from_world)})
    finally:
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(camera_data)
    return maps


def safe(name):
    return "".join(c if c.isalnum() else "_" for c in name)


def capture(folder, stem, options):
    """Renders the current frame and writes its manifest."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    if not scene.camera:
        raise Refused("the scene has no camera")
    os.makedirs(folder, exist_ok=True)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    materials = translucent_materials(depsgraph)
    if not materials:
        raise Refused("no rendered material has subsurface scattering: raise Principled's Subsurface")
    corners = bounds(depsgraph)
    unit = scene.unit_settings.scale_length
    file, back = f"{stem}.exr", f"{stem}.back.exr"
    manifest = {"pellucid": 1, "metersPerUnit": unit}
    index_of = {material.name: i + 1 for i, (material, _) in enumerate(materials)}
    every = [(m, "pass_index", index_of.get(m.name, 0)) for m in bpy.data.materials]
    with contextlib.ExitStack() as stack:
        stack.enter_context(as_data(options.samples))
        stack.enter_context(changed(*every))
        if options.truth:
            with contextlib.ExitStack() as walk:
                for material, said in materials:
                    walk.enter_context(surface_of(material, like("ShaderNodeSubsurfaceScattering", material, said)))
                walk.enter_context(changed((scene.cycles, "samples", options.truth),
                                           (scene.cycles, "diffuse_bounces", 0), (scene.cycles, "max_bounces", 0)))
                render(os.path.join(folder, f"{stem}.truth.exr"))
            manifest["truth"] = {"file": f"{stem}.truth.exr", "scale": math.pi,
                                 "channels": layer_channels("Combined.R", "Combined.G", "Combined.B")}
        for material, said in materials:
            stack.enter_context(surface_of(material, like("ShaderNodeBsdfDiffuse", material, said)))
        render(os.path.join(folder, file))
        depsgraph = bpy.context.evaluated_depsgraph_get()
        camera = scene.camera.evaluated_get(depsgraph)
        manifest["camera"] = {"clipFromView": column_major(projection(depsgraph, camera)),
                              "viewFromWorld": column_major(rigid_inverse(camera.matrix_world))}
        manifest["lights"] = []
        # All of them first: renders change the depsgraph.
        for i, (name, data, matrix) in enumerate(list(lights(depsgraph))):
            record = light_record(data, matrix)
            maps = render_maps(f"light{i}_{safe(name)}", data, matrix, corners, options.shadow_size, folder, stem)
            if maps:
                record["shadowMaps"] = maps
            manifest["lights"].append(record)
        override = back_face_material()
        try:
            with changed((layer, "material_override", override), (scene.cycles, "samples", 1),
                         (scene.cycles, "transparent_max_bounces", 64)):
                render(os.path.join(folder, back))
        finally:
            bpy.data.materials.remove(override)
    depth = layer_channels("Depth.Z")[0]
    manifest["buffers"] = {
        "frontDepth": {"file": file, "channel": depth, "encoding": "viewZ"},
        "backDepth": {"file": back, "channel": depth, "encoding": "viewZ"},
        "irradiance": {"file": file, "channels": layer_channels("DiffDir.R", "DiffDir.G", "DiffDir.B"),
                       "scale": math.pi},
        "normal": {"file": file, "channels": layer_channels("Normal.X", "Normal.Y", "Normal.Z"), "space": "world"},
        "albedo": {"file": file, "channels": layer_channels("DiffCol.R", "DiffCol.G", "DiffCol.B")},
        "material": {"file": file, "channel": layer_channels("IndexMA.X")[0],
                     "map": {str(i): i for i in range(len(materials) + 1)}}}
    manifest["materials"] = [medium(said["radius"], socket_value(said["node"], said["color"]), said["g"], said["ior"],
                                    said["method"], 1000 * unit) for _, said in materials]
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
        subprocess.run([options.replay, *words], check=True)
    else:
        print("next: pellucid " + " ".join(words))


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
