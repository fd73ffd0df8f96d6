"""Writes the manifest of a multilayer EXR of Cycles: camera, lights, materials and the passes.  docs/captures.md has the
recipe.

    blender -b scene.blend -P blender_export.py -- render.json         the current frame, of render.exr
    blender -b scene.blend -P blender_export.py -- render.####.json    all frames of the scene
"""
import json
import math
import os
import re
import sys

KINDS = {"SUN": "directional", "POINT": "point", "SPOT": "spot"}


def column_major(matrix):
    return [matrix[row][column] for column in range(4) for row in range(4)]


def clip_from_view(projection):
    """OpenGL's clip space (y up, z from -w to w) to Vulkan's (y down, z from 0 to w)."""
    x, y, z, w = (list(row) for row in projection)
    return [x, [-value for value in y], [(a + b) / 2 for a, b in zip(z, w)], w]


def axes(world):
    """The unit axes of an object: its scale changes no length in view space."""
    columns = [[world[row][column] for row in range(3)] for column in range(3)]
    return [[value / math.hypot(*column) for value in column] for column in columns]


def view_from_world(world):
    place = [world[row][3] for row in range(3)]
    return [[*axis, -sum(a * b for a, b in zip(axis, place))] for axis in axes(world)] + [[0, 0, 0, 1]]


def light_record(light):
    data, world = light.data, light.matrix_world
    # A sun's strength is its irradiance. The energy of other lights is the power of a full sphere, also of spots.
    record = {"type": KINDS[data.type], "color": list(data.color),
              "intensity": data.energy / (1 if data.type == "SUN" else 4 * math.pi)}
    if data.type != "SUN":
        record["position"] = [world[row][3] for row in range(3)]
    if data.type != "POINT":
        record["direction"] = [-value for value in axes(world)[2]]
    if data.type == "SPOT":
        outer = data.spot_size / 2
        record.update(outerConeAngle=outer, innerConeAngle=outer * (1 - max(data.spot_blend, 1e-3)))
    return record


def buffers(layer, file, materials):
    def passed(name, components, **more):
        channels = [f"{layer}.{name}.{component}" for component in components]
        names = {"channel": channels[0]} if len(channels) == 1 else {"channels": channels}
        return {"file": file, **names, **more}

    indices = {"0": 0, **{str(m.pass_index): i + 1 for i, m in enumerate(materials)}}
    return {"frontDepth": passed("Depth", "Z", encoding="viewZ"),
            "irradiance": passed("DiffDir", "RGB", scale=math.pi),  # Diffuse Direct is E / pi
            "albedo": passed("DiffCol", "RGB"),
            "material": passed("IndexMA", "X", map=indices)}


def manifest(bpy, file):
    scene = bpy.context.scene
    depsgraph = bpy.context.evaluated_depsgraph_get()
    camera = scene.camera.evaluated_get(depsgraph)
    render = scene.render
    projection = camera.calc_matrix_camera(depsgraph, x=render.resolution_x, y=render.resolution_y,
                                           scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    lights = [o.evaluated_get(depsgraph) for o in scene.objects if o.type == "LIGHT" and not o.hide_render]
    for light in lights:
        if light.data.type not in KINDS:
            print(f"left out: light {light.name} of type {light.data.type}", file=sys.stderr)
    # A material takes part when it has a pass index; its custom property "pellucid" names the preset.
    materials = [m for m in bpy.data.materials if m.pass_index > 0]
    if not materials:
        print("no material has a pass index: nothing in the render is translucent", file=sys.stderr)
    return {"pellucid": 1, "metersPerUnit": scene.unit_settings.scale_length,
            "camera": {"clipFromView": column_major(clip_from_view(projection)),
                       "viewFromWorld": column_major(view_from_world(camera.matrix_world))},
            "buffers": buffers(bpy.context.view_layer.name, file, materials),
            "lights": [light_record(o) for o in lights if o.data.type in KINDS],
            "materials": [{"preset": m.get("pellucid", "skin1")} for m in materials]}


def export(bpy, path):
    frames = range(bpy.context.scene.frame_start, bpy.context.scene.frame_end + 1) if "#" in path else [None]
    for frame in frames:
        if frame is not None:
            bpy.context.scene.frame_set(frame)
        name = re.sub("#+", lambda run: str(frame).zfill(len(run.group())), path)
        image = os.path.splitext(os.path.basename(name))[0] + ".exr"
        with open(name, "w", encoding="utf-8") as file:
            json.dump(manifest(bpy, image), file, indent=1)


if __name__ == "__main__":
    import bpy as blender
    export(blender, sys.argv[sys.argv.index("--") + 1])
