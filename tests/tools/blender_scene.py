"""Makes the scene of blender_capture_test.py, in Blender: a lumpy blob of wax in two suns, and what a script may trip over.

    blender -b -P blender_scene.py -- FILE.blend
"""
import math
import sys

import bpy
from mathutils import Vector

RADIUS = 10


def add(name, data, collection):
    thing = bpy.data.objects.new(name, data)
    collection.objects.link(thing)
    return thing


def sun(name, direction, energy, collection):
    data = bpy.data.lights.new(name, "SUN")
    data.energy, data.angle = energy, 0
    thing = add(name, data, collection)
    thing.rotation_euler = Vector(direction).to_track_quat("-Z", "Y").to_euler()
    return thing


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.unit_settings.scale_length = 0.001

bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=RADIUS)
blob = bpy.context.object
for vertex in blob.data.vertices:
    n = vertex.co.normalized()
    vertex.co = n * RADIUS * (1 + 0.15 * math.sin(3 * n.x + 1) * math.cos(4 * n.y) + 0.1 * math.sin(5 * n.z))
bpy.ops.object.shade_smooth()
wax = bpy.data.materials.new("wax")
wax.use_nodes = True
wax.pass_index = 7  # as of another material below
principled = wax.node_tree.nodes["Principled BSDF"]
for name, value in (("Base Color", (0.8, 0.5, 0.3, 1)), ("Subsurface", 1), ("Subsurface Color", (0.8, 0.5, 0.3, 1)),
                    ("Subsurface Radius", (3, 1.5, 0.8)), ("Specular", 0)):
    principled.inputs[name].default_value = value
blob.data.materials.append(wax)

# A second material of the same index that is opaque, on a pebble at the side.
bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1.5, location=(12, -9, 0))
stone = bpy.data.materials.new("stone")
stone.use_nodes = True
stone.pass_index = 7
bpy.context.object.data.materials.append(stone)

sun("Key", (0.3, -0.2, 1), 3, scene.collection)
# One sun in an instanced collection, one that is hidden, and one in a collection that is.
rig = bpy.data.collections.new("rig")
sun("Rim", (-0.6, -0.3, -1), 1, rig)
instance = add("rig", None, scene.collection)
instance.instance_type, instance.instance_collection = "COLLECTION", rig
sun("Off", (0, 0, -1), 50, scene.collection).hide_render = True
hidden = bpy.data.collections.new("hidden")
scene.collection.children.link(hidden)
hidden.hide_render = True
sun("Hidden", (0, 0, -1), 50, hidden)

camera_data = bpy.data.cameras.new("Camera")
camera_data.angle, camera_data.clip_start, camera_data.clip_end = math.radians(35), 1, 200
camera = add("Camera", camera_data, scene.collection)
camera.location = (0, 0, 45)
scene.camera = camera
scene.render.resolution_x = scene.render.resolution_y = 192
scene.render.resolution_percentage = 50
scene.frame_end = 2
blob.keyframe_insert("location", frame=1)
blob.location.x = 1
blob.keyframe_insert("location", frame=2)
scene.frame_set(1)
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[sys.argv.index("--") + 1])
