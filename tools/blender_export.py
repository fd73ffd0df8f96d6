"""Writes what a multilayer EXR of Cycles does not say: camera, lights and materials, for `pellucid --preset
blender`.  docs/captures.md has the recipe.

    blender -b scene.blend -P blender_export.py -- render.json         the current frame
    blender -b scene.blend -P blender_export.py -- render.####.json    all frames of the scene
"""
import json
import re
import sys


def rows(matrix):
    return [list(row) for row in matrix]


def light_record(light):
    data = light.data
    record = {"name": light.name, "type": data.type, "matrixWorld": rows(light.matrix_world),
              "color": list(data.color), "energy": data.energy}
    if data.type == "SPOT":
        record.update(spotSize=data.spot_size, spotBlend=data.spot_blend)
    return record


def scene_record(bpy):
    scene = bpy.context.scene
    depsgraph = bpy.context.evaluated_depsgraph_get()
    camera = scene.camera.evaluated_get(depsgraph)
    render = scene.render
    projection = camera.calc_matrix_camera(depsgraph, x=render.resolution_x, y=render.resolution_y,
                                           scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    lights = [o.evaluated_get(depsgraph) for o in scene.objects if o.type == "LIGHT" and not o.hide_render]
    for light in lights:
        if light.data.type not in ("SUN", "POINT", "SPOT"):
            print(f"left out: light {light.name} of type {light.data.type}", file=sys.stderr)
    # A material takes part when it has a pass index; its custom property "pellucid" names the preset.
    materials = [m for m in bpy.data.materials if m.pass_index > 0]
    return {"blender": 1, "viewLayer": bpy.context.view_layer.name,
            "metersPerUnit": scene.unit_settings.scale_length,
            "camera": {"matrixWorld": rows(camera.matrix_world), "projection": rows(projection)},
            "lights": [light_record(o) for o in lights if o.data.type in ("SUN", "POINT", "SPOT")],
            "materials": [{"passIndex": m.pass_index, "material": {"preset": m.get("pellucid", "skin1")}}
                          for m in materials]}


def export(bpy, path):
    frames = range(bpy.context.scene.frame_start, bpy.context.scene.frame_end + 1) if "#" in path else [None]
    for frame in frames:
        if frame is not None:
            bpy.context.scene.frame_set(frame)
        name = re.sub("#+", lambda run: str(frame).zfill(len(run.group())), path)
        with open(name, "w", encoding="utf-8") as file:
            json.dump(scene_record(bpy), file, indent=1)


if __name__ == "__main__":
    import bpy as blender
    export(blender, sys.argv[sys.argv.index("--") + 1])
